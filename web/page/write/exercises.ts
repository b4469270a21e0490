// The functions that a reader writes: signature, help, and tests whose results are sentences with numbers.
//
// Points are typed arrays x0, y0, x1, y1, …; a motion is [x, y, θ] in m, m, rad. The expected numbers are by hand, as in
// teaching/exercises/tests.

/** One call of the reader's function, and what to say of its result. */
export interface Trial {
  name: string;
  arguments: unknown[];
  /** The sentence of a failure, or undefined if the result is right. */
  fault(result: unknown): string | undefined;
}

export interface Exercise {
  /** The name of the function. */
  name: string;
  /** What the editor shows at first. */
  stub: string;
  trials: Trial[];
  /** Hints, from small to large. */
  help: [string, string, string];
  solution: string;
}

type Motion = [number, number, number];

const DEGREES = 180 / Math.PI;

function numbers(value: unknown, count: number): number[] | undefined {
  if (typeof value !== 'object' || value === null || !('length' in value)) return undefined;
  const found = Array.from(value as ArrayLike<unknown>);
  return found.length === count && found.every((one) => typeof one === 'number') ? (found as number[]) : undefined;
}

function written([x, y, theta]: number[]): string {
  return `(${x?.toFixed(4)} m, ${y?.toFixed(4)} m, ${((theta ?? 0) * DEGREES).toFixed(3)}°)`;
}

/** Compares with a motion; `meaning` says what a wrong result usually means. */
function motion(expected: Motion, tolerance: number, meaning: string): (result: unknown) => string | undefined {
  return (result) => {
    const found = numbers(result, 3);
    if (found === undefined) return `expected ${written(expected)} as an array [x, y, θ], but got ${shown(result)}. Return three numbers.`;
    const turn = Math.abs(Math.atan2(Math.sin((found[2] ?? 0) - expected[2]), Math.cos((found[2] ?? 0) - expected[2])));
    const apart = Math.hypot((found[0] ?? 0) - expected[0], (found[1] ?? 0) - expected[1]) + turn;
    return apart <= tolerance ? undefined : `expected ${written(expected)}, but got ${written(found)}. ${meaning}`;
  };
}

function shown(value: unknown): string {
  if (value === undefined) return 'nothing';
  const text = typeof value === 'object' && value !== null && 'length' in value
    ? `[${Array.from(value as ArrayLike<unknown>).slice(0, 6).join(', ')}]` : JSON.stringify(value);
  return String(text).slice(0, 80);
}

function flat(points: number[][]): Float64Array {
  return Float64Array.from(points.flat());
}

/** Points moved by a motion. */
function moved(points: number[][], [x, y, theta]: Motion): number[][] {
  const [cos, sin] = [Math.cos(theta), Math.sin(theta)];
  return points.map(([px = 0, py = 0]) => [x + cos * px - sin * py, y + sin * px + cos * py]);
}

const CIRCLE = [[1, 0], [0, 1], [-1, 0], [0, -1]];
/** Points of a room without symmetry. */
const ROOM = [[2, 0.1], [1.2, 1.5], [-0.4, 1.6], [-2.1, 0.3], [-1.5, -1.4], [0.7, -1.2]];
const THIN = [[2, 0.1], [-2, -0.1], [0.3, 1], [-0.3, -1]];
/** By hand, for points that are centred: Σ cross = −2 Σ x y, Σ dot = Σ (x² − y²). */
const THIN_TURN = Math.atan2(
  THIN.reduce((sum, [x = 0, y = 0]) => sum - 2 * x * y, 0), THIN.reduce((sum, [x = 0, y = 0]) => sum + x * x - y * y, 0));
const WALLS = [-2, -1, 0, 1, 2].flatMap((x) => [[x, 1], [x, -1]]);

const ALIGN: Exercise = {
  name: 'svd_align',
  stub: `// The motion [x, y, θ] that minimizes Σ ‖R(θ) pₖ + t − qₖ‖².
// src, dst: Float64Array x0, y0, x1, y1, …; their k-th points match.
function svd_align(src, dst) {
  return [0, 0, 0];
}
`,
  trials: [
    { name: 'A known motion', arguments: [flat(CIRCLE), flat(moved(CIRCLE, [2, 1, Math.atan2(0.6, 0.8)]))],
      fault: motion([2, 1, Math.atan2(0.6, 0.8)], 1e-9, 'Four points on a circle were turned and shifted by this motion.') },
    { name: 'A shift after a turn', arguments: [flat(ROOM), flat(moved(ROOM, [-3, 0.5, 2.5]))],
      fault: motion([-3, 0.5, 2.5], 1e-9, 'The turn comes first: t = q̄ − R p̄.') },
    { name: 'Mirrored points', arguments: [flat(THIN), flat(THIN.map(([x = 0, y = 0]) => [x, -y]))],
      fault: motion([0, 0, THIN_TURN], 1e-9, 'No rotation fits; without the sign of the determinant the result is a reflection.') },
    { name: 'A corridor', arguments: [flat(WALLS), flat(WALLS.map(([x = 0, y = 0]) => [x + 0.5, y]))],
      fault: motion([0.5, 0, 0], 1e-9, 'Known pairs determine the shift along the walls; searching for pairs does not.') },
    { name: 'No pairs', arguments: [new Float64Array(0), new Float64Array(0)],
      fault: motion([0, 0, 0], 0, 'The mean of no points is NaN, so this case needs a rule.') },
  ],
  help: [
    'Subtract both means first. Then only a rotation is left to find, and t follows from the means.',
    'For centred pairs, sum c = Σ (pₓ q_y − p_y qₓ) and d = Σ (pₓ qₓ + p_y q_y). The cost is one sinusoid in θ.',
    'θ = Math.atan2(c, d); x and y are q̄ − R(θ) p̄.',
  ],
  solution: `function svd_align(src, dst) {
  const n = src.length / 2;
  if (n === 0) return [0, 0, 0];
  let [px, py, qx, qy] = [0, 0, 0, 0];
  for (let k = 0; k < 2 * n; k += 2) {
    px += src[k] / n; py += src[k + 1] / n;
    qx += dst[k] / n; qy += dst[k + 1] / n;
  }
  let [cross, dot] = [0, 0];
  for (let k = 0; k < 2 * n; k += 2) {
    const [ax, ay, bx, by] = [src[k] - px, src[k + 1] - py, dst[k] - qx, dst[k + 1] - qy];
    cross += ax * by - ay * bx;
    dot += ax * bx + ay * by;
  }
  const theta = Math.atan2(cross, dot);
  const [cos, sin] = [Math.cos(theta), Math.sin(theta)];
  return [qx - cos * px + sin * py, qy - sin * px - cos * py, theta];
}
`,
};

/** Two walls that meet and one opposite: points, and their normals. */
const CORNER = Array.from({ length: 20 }, (_, k) => 0.1 * (k + 1)).flatMap((along) => [
  { at: [along, 0], normal: [0, 1] }, { at: [0, along], normal: [1, 0] }, { at: [along, 3], normal: [0, -1] }]);
const CORNER_POINTS = CORNER.map(({ at }) => at);
const CORNER_NORMALS = CORNER.map(({ normal }) => normal);
/** By hand: three points 0.1 m above a wall at x = −1, 0, 1 have H = diag(0, 3, 2). */
const ACROSS = -0.3 / (3 + 5e-4 / 3 + 1e-12);
const WALL = [[-1, 0.1], [0, 0.1], [1, 0.1]];

function cornerSeen(off: Motion, at: [number, number]): unknown[] {
  const shift = (points: number[][]): number[][] => points.map(([x = 0, y = 0]) => [x + at[0], y + at[1]]);
  return [flat(shift(moved(CORNER_POINTS, off))), flat(shift(CORNER_POINTS)), flat(CORNER_NORMALS)];
}

/** Undoes a small motion of the corner that stands at `at`, up to the ridge and the square of the turn. */
function undoes(off: Motion, at: [number, number], meaning: string): (result: unknown) => string | undefined {
  return (result) => {
    const found = numbers(result, 3) as Motion | undefined;
    if (found === undefined) return `expected an array [x, y, θ], but got ${shown(result)}.`;
    // The step acts in the frame of the map: it has to bring the moved corner back.
    const shifted = moved(CORNER_POINTS, off).map(([x = 0, y = 0]) => [x + at[0], y + at[1]]);
    const back = moved(shifted, found);
    const left = Math.max(...back.map(([x = 0, y = 0], k) => Math.hypot(x - (CORNER_POINTS[k]?.[0] ?? 0) - at[0], y - (CORNER_POINTS[k]?.[1] ?? 0) - at[1])));
    return left < 1e-3 ? undefined : `after the step a point is still ${left.toPrecision(2)} m off, expected less than 0.001 m. ${meaning}`;
  };
}

const OFF: Motion = [0.02, -0.03, 0.01];

const PLANE: Exercise = {
  name: 'point_to_plane_step',
  stub: `// One Gauss–Newton step on Σ (nₖ · (pₖ − qₖ))²: the motion [x, y, θ] of the new pose step ∘ pose.
// src: points moved by the present pose; dst: their matches; normals: their unit normals, NaN where there is none.
// All are Float64Array x0, y0, x1, y1, …
function point_to_plane_step(src, dst, normals) {
  return [0, 0, 0];
}
`,
  trials: [
    { name: 'A known motion', arguments: cornerSeen(OFF, [0, 0]),
      fault: undoes(OFF, [0, 0], 'Two walls that meet determine all three numbers.') },
    { name: 'Far from the origin', arguments: cornerSeen(OFF, [1000, -2000]),
      fault: undoes(OFF, [1000, -2000], 'Rotate about the centroid; about the origin, each rotation would also be a shift.') },
    { name: 'Mirrored normals', arguments: [flat(WALL), flat(WALL.map(([x = 0]) => [x, 0])), flat([[0, -1], [0, 1], [0, -1]])],
      fault: motion([0, ACROSS, 0], 1e-9, 'The sign of a normal is arbitrary, and cancels in JᵀJ and in Jᵀe.') },
    { name: 'A corridor', arguments: [flat(WALL), flat(WALL.map(([x = 0]) => [x + 0.5, 0])), flat([[0, 1], [0, 1], [0, 1]])],
      fault: motion([0, ACROSS, 0], 1e-9, 'No normal points along the wall, so the ridge allows no step there.') },
    { name: 'No pairs', arguments: [new Float64Array(0), new Float64Array(0), new Float64Array(0)],
      fault: motion([0, 0, 0], 0, 'Fewer than three normals give the identity.') },
    { name: 'Only two normals', arguments: [flat(ROOM), flat(ROOM.map(([x = 0, y = 0]) => [x + 0.1, y])), flat(ROOM.map((_, k) => (k < 2 ? [1, 0] : [NaN, NaN])))],
      fault: motion([0, 0, 0], 0, 'Pairs without a normal do not count, and fewer than three give the identity.') },
  ],
  help: [
    'Skip pairs whose normal is NaN. With c the centroid of the other pₖ, row k is J = (nₓ, n_y, (p − c) × n), a × b = aₓ b_y − a_y bₓ.',
    'Sum H = Σ JᵀJ and g = Σ Jᵀe with e = n · (p − q). Add λ = 1e-4 · tr(H)/3 + 1e-12 to the diagonal of H, and solve H x = −g by Cramer’s rule or elimination.',
    'The step turns by θ about c and then shifts by (tₓ, t_y): [tₓ + cₓ − cos θ cₓ + sin θ c_y, t_y + c_y − sin θ cₓ − cos θ c_y, θ].',
  ],
  solution: `function point_to_plane_step(src, dst, normals) {
  const pairs = [];
  for (let k = 0; k < src.length; k += 2) if (!Number.isNaN(normals[k])) pairs.push(k);
  if (pairs.length < 3) return [0, 0, 0];
  let [cx, cy] = [0, 0];
  for (const k of pairs) { cx += src[k] / pairs.length; cy += src[k + 1] / pairs.length; }
  const h = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  const g = [0, 0, 0];
  for (const k of pairs) {
    const [nx, ny] = [normals[k], normals[k + 1]];
    const row = [nx, ny, (src[k] - cx) * ny - (src[k + 1] - cy) * nx];
    const e = nx * (src[k] - dst[k]) + ny * (src[k + 1] - dst[k + 1]);
    for (let i = 0; i < 3; i += 1) {
      g[i] += row[i] * e;
      for (let j = 0; j < 3; j += 1) h[i][j] += row[i] * row[j];
    }
  }
  const ridge = 1e-4 * (h[0][0] + h[1][1] + h[2][2]) / 3 + 1e-12;
  for (let i = 0; i < 3; i += 1) h[i][i] += ridge;
  // Elimination: with the ridge H is positive definite, so no pivot is zero.
  const a = h.map((row, i) => [...row, -g[i]]);
  for (let i = 0; i < 3; i += 1) {
    for (let j = i + 1; j < 3; j += 1) {
      const factor = a[j][i] / a[i][i];
      for (let k = i; k < 4; k += 1) a[j][k] -= factor * a[i][k];
    }
  }
  const x = [0, 0, 0];
  for (let i = 2; i >= 0; i -= 1) {
    let rest = a[i][3];
    for (let j = i + 1; j < 3; j += 1) rest -= a[i][j] * x[j];
    x[i] = rest / a[i][i];
  }
  const [cos, sin] = [Math.cos(x[2]), Math.sin(x[2])];
  return [x[0] + cx - cos * cx + sin * cy, x[1] + cy - sin * cx - cos * cy, x[2]];
}
`,
};

function kept(expected: number[], meaning: string): (result: unknown) => string | undefined {
  return (result) => {
    const found = numbers(result, expected.length);
    if (found?.every((one, k) => one === expected[k]) === true) return undefined;
    return `expected the indices [${expected.join(', ')}], but got ${shown(result)}. ${meaning}`;
  };
}

const REJECT: Exercise = {
  name: 'keep_pairs',
  stub: `// The indices of the pairs that ICP keeps: of n pairs, the max(1, ⌈(1 − trim) n⌉) shortest, in order.
// lengths: Float64Array, m. trim: the share to drop, 0 to 1; 0 in the lap of w16.2.
function keep_pairs(lengths, trim) {
  return [];
}
`,
  trials: [
    { name: 'A box that moved', arguments: [Float64Array.of(0.1, 0.5, 0.2, 0.4), 0.25],
      fault: kept([0, 2, 3], 'The longest pair is on the box and is dropped.') },
    { name: 'A share of three', arguments: [Float64Array.of(0.3, 0.1, 0.2), 0.5],
      fault: kept([1, 2], 'Of 1.5 pairs, 2 are kept. Round up.') },
    { name: 'Lengths are numbers', arguments: [Float64Array.of(10, 9, 2, 1), 0.5],
      fault: kept([2, 3], 'An array sorts its elements as text unless told otherwise.') },
    { name: 'A corridor without trimming', arguments: [Float64Array.of(0.2, 0.2, 0.2), 0],
      fault: kept([0, 1, 2], 'All pairs stay if nothing is trimmed.') },
    { name: 'All trimmed', arguments: [Float64Array.of(0.3, 0.1, 0.2), 1], fault: kept([1], 'At least one stays, the shortest.') },
    { name: 'No pairs', arguments: [new Float64Array(0), 0.25], fault: kept([], 'There is nothing to keep.') },
  ],
  help: [
    'Sort a copy of the lengths to find the length of the last pair that stays, and keep all pairs up to it.',
    'k = Math.max(1, Math.ceil((1 − trim) * n)); without pairs there is no k-th one.',
    'const limit = Float64Array.from(lengths).sort()[k − 1]; a typed array sorts numbers.',
  ],
  solution: `function keep_pairs(lengths, trim) {
  const k = Math.max(1, Math.ceil((1 - trim) * lengths.length));
  const limit = Float64Array.from(lengths).sort()[k - 1];
  const kept = [];
  lengths.forEach((length, number) => { if (length <= limit) kept.push(number); });
  return kept;
}
`,
};

function verdict(chi2: number, accepted: boolean, meaning: string): (result: unknown) => string | undefined {
  return (result) => {
    const found = result as { chi2?: unknown; accepted?: unknown } | null | undefined;
    const isNear = typeof found?.chi2 === 'number' && (Math.abs(found.chi2 - chi2) < 1e-9 || (Number.isNaN(chi2) && Number.isNaN(found.chi2)));
    if (isNear && found?.accepted === accepted) return undefined;
    const expected = `χ² ${Number.isNaN(chi2) ? 'NaN' : chi2.toFixed(3)} and accepted ${accepted}`;
    const came = typeof found?.chi2 === 'number' ? `χ² ${found.chi2.toFixed(3)} and accepted ${String(found.accepted)}` : shown(result);
    return `expected ${expected}, but got ${came}. ${meaning}`;
  };
}

/** The chapter's drift in one node, and the 95 % quantile of χ² with three degrees of freedom. */
const DRIFT = [0.045, 0.012] as const;
const GATE = 7.815;

const LOOP_GATE: Exercise = {
  name: 'gate',
  stub: `// Whether a loop is within the drift of the odometry: {chi2, accepted}.
// innovation: [x, y, θ], m, m, rad; gap: nodes between the two ends; drift: [σ, σ_θ] per node, m, rad;
// limit: the largest χ² that is accepted.
function gate(innovation, gap, drift, limit) {
  return { chi2: 0, accepted: true };
}
`,
  trials: [
    { name: 'A known innovation', arguments: [Float64Array.of(0.045, 0, 0), 1, [...DRIFT], GATE],
      fault: verdict(1, true, 'One standard deviation gives χ² 1.') },
    { name: 'A longer path', arguments: [Float64Array.of(0.09, 0, 0.024), 4, [...DRIFT], GATE],
      fault: verdict(2, true, 'The variance grows with the gap, the standard deviation with √gap.') },
    { name: 'Mirrored', arguments: [Float64Array.of(-0.045, 0.045, -0.012), 1, [...DRIFT], GATE],
      fault: verdict(3, true, 'The sign of an innovation does not matter.') },
    { name: 'Three sigma along a corridor', arguments: [Float64Array.of(3 * 0.045 * 5, 0, 0), 25, [...DRIFT], GATE],
      fault: verdict(9, false, 'χ² 9 is above 7.815.') },
    { name: 'Another limit', arguments: [Float64Array.of(3 * 0.045 * 5, 0, 0), 25, [...DRIFT], 11.345],
      fault: verdict(9, true, 'The limit is an argument: 11.345 is the 99% quantile.') },
    { name: 'At the limit', arguments: [Float64Array.of(0, 2, 0), 1, [1, 1], 4], fault: verdict(4, true, '≤, not <.') },
    { name: 'No pairs', arguments: [Float64Array.of(NaN, 0, 0), 1, [...DRIFT], GATE],
      fault: verdict(NaN, false, 'A registration without pairs has no innovation; NaN ≤ limit is false, and so is NaN > limit.') },
  ],
  help: [
    'S = gap · diag(σ², σ², σ_θ²), and χ² = ξᵀ S⁻¹ ξ: S is diagonal, so it is a sum of three quotients.',
    'A loop is accepted if χ² ≤ limit; write it so that NaN is rejected.',
    'const chi2 = (x² + y²) / (gap σ²) + θ² / (gap σ_θ²).',
  ],
  solution: `function gate(innovation, gap, drift, limit) {
  const [x, y, theta] = innovation;
  const [xy, turn] = drift;
  const chi2 = (x * x + y * y) / (gap * xy * xy) + (theta * theta) / (gap * turn * turn);
  return { chi2, accepted: chi2 <= limit };
}
`,
};

/** The exercises by their names. */
export const EXERCISES = new Map([ALIGN, PLANE, REJECT, LOOP_GATE].map((exercise) => [exercise.name, exercise]));
