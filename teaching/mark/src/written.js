"use strict";
(() => {
  // web/page/write/exercises.ts
  var DEGREES = 180 / Math.PI;
  function numbers(value, count) {
    if (typeof value !== "object" || value === null || !("length" in value)) return void 0;
    const found = Array.from(value);
    return found.length === count && found.every((one) => typeof one === "number") ? found : void 0;
  }
  function written([x, y, theta]) {
    return `(${x?.toFixed(4)} m, ${y?.toFixed(4)} m, ${((theta ?? 0) * DEGREES).toFixed(3)}\xB0)`;
  }
  function motion(expected, tolerance, meaning) {
    return (result) => {
      const found = numbers(result, 3);
      if (found === void 0) return `expected ${written(expected)} as an array [x, y, \u03B8], but got ${shown(result)}. Return three numbers.`;
      const turn = Math.abs(Math.atan2(Math.sin((found[2] ?? 0) - expected[2]), Math.cos((found[2] ?? 0) - expected[2])));
      const apart = Math.hypot((found[0] ?? 0) - expected[0], (found[1] ?? 0) - expected[1]) + turn;
      return apart <= tolerance ? void 0 : `expected ${written(expected)}, but got ${written(found)}. ${meaning}`;
    };
  }
  function shown(value) {
    if (value === void 0) return "nothing";
    const text2 = typeof value === "object" && value !== null && "length" in value ? `[${Array.from(value).slice(0, 6).join(", ")}]` : JSON.stringify(value);
    return String(text2).slice(0, 80);
  }
  function flat(points) {
    return Float64Array.from(points.flat());
  }
  function moved(points, [x, y, theta]) {
    const [cos, sin] = [Math.cos(theta), Math.sin(theta)];
    return points.map(([px = 0, py = 0]) => [x + cos * px - sin * py, y + sin * px + cos * py]);
  }
  var CIRCLE = [[1, 0], [0, 1], [-1, 0], [0, -1]];
  var ROOM = [[2, 0.1], [1.2, 1.5], [-0.4, 1.6], [-2.1, 0.3], [-1.5, -1.4], [0.7, -1.2]];
  var THIN = [[2, 0.1], [-2, -0.1], [0.3, 1], [-0.3, -1]];
  var THIN_TURN = Math.atan2(
    THIN.reduce((sum, [x = 0, y = 0]) => sum - 2 * x * y, 0),
    THIN.reduce((sum, [x = 0, y = 0]) => sum + x * x - y * y, 0)
  );
  var WALLS = [-2, -1, 0, 1, 2].flatMap((x) => [[x, 1], [x, -1]]);
  var ALIGN = {
    name: "svd_align",
    stub: `// The motion [x, y, \u03B8] that minimizes \u03A3 \u2016R(\u03B8) p\u2096 + t \u2212 q\u2096\u2016\xB2.
// src, dst: Float64Array x0, y0, x1, y1, \u2026; their k-th points match.
function svd_align(src, dst) {
  return [0, 0, 0];
}
`,
    trials: [
      {
        name: "A known motion",
        arguments: [flat(CIRCLE), flat(moved(CIRCLE, [2, 1, Math.atan2(0.6, 0.8)]))],
        fault: motion([2, 1, Math.atan2(0.6, 0.8)], 1e-9, "Four points on a circle were turned and shifted by this motion.")
      },
      {
        name: "A shift after a turn",
        arguments: [flat(ROOM), flat(moved(ROOM, [-3, 0.5, 2.5]))],
        fault: motion([-3, 0.5, 2.5], 1e-9, "The turn comes first: t = q\u0304 \u2212 R p\u0304.")
      },
      {
        name: "Mirrored points",
        arguments: [flat(THIN), flat(THIN.map(([x = 0, y = 0]) => [x, -y]))],
        fault: motion([0, 0, THIN_TURN], 1e-9, "No rotation fits; without the sign of the determinant the result is a reflection.")
      },
      {
        name: "A corridor",
        arguments: [flat(WALLS), flat(WALLS.map(([x = 0, y = 0]) => [x + 0.5, y]))],
        fault: motion([0.5, 0, 0], 1e-9, "Known pairs determine the shift along the walls; searching for pairs does not.")
      },
      {
        name: "No pairs",
        arguments: [new Float64Array(0), new Float64Array(0)],
        fault: motion([0, 0, 0], 0, "The mean of no points is NaN, so this case needs a rule.")
      }
    ],
    help: [
      "Subtract both means first. Then only a rotation is left to find, and t follows from the means.",
      "For centred pairs, sum c = \u03A3 (p\u2093 q_y \u2212 p_y q\u2093) and d = \u03A3 (p\u2093 q\u2093 + p_y q_y). The cost is one sinusoid in \u03B8.",
      "\u03B8 = Math.atan2(c, d); x and y are q\u0304 \u2212 R(\u03B8) p\u0304."
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
`
  };
  var CORNER = Array.from({ length: 20 }, (_, k) => 0.1 * (k + 1)).flatMap((along) => [
    { at: [along, 0], normal: [0, 1] },
    { at: [0, along], normal: [1, 0] },
    { at: [along, 3], normal: [0, -1] }
  ]);
  var CORNER_POINTS = CORNER.map(({ at }) => at);
  var CORNER_NORMALS = CORNER.map(({ normal }) => normal);
  var ACROSS = -0.3 / (3 + 5e-4 / 3 + 1e-12);
  var WALL = [[-1, 0.1], [0, 0.1], [1, 0.1]];
  function cornerSeen(off, at) {
    const shift = (points) => points.map(([x = 0, y = 0]) => [x + at[0], y + at[1]]);
    return [flat(shift(moved(CORNER_POINTS, off))), flat(shift(CORNER_POINTS)), flat(CORNER_NORMALS)];
  }
  function undoes(off, at, meaning) {
    return (result) => {
      const found = numbers(result, 3);
      if (found === void 0) return `expected an array [x, y, \u03B8], but got ${shown(result)}.`;
      const shifted = moved(CORNER_POINTS, off).map(([x = 0, y = 0]) => [x + at[0], y + at[1]]);
      const back = moved(shifted, found);
      const left = Math.max(...back.map(([x = 0, y = 0], k) => Math.hypot(x - (CORNER_POINTS[k]?.[0] ?? 0) - at[0], y - (CORNER_POINTS[k]?.[1] ?? 0) - at[1])));
      return left < 1e-3 ? void 0 : `after the step a point is still ${left.toPrecision(2)} m off, expected less than 0.001 m. ${meaning}`;
    };
  }
  var OFF = [0.02, -0.03, 0.01];
  var PLANE = {
    name: "point_to_plane_step",
    stub: `// One Gauss\u2013Newton step on \u03A3 (n\u2096 \xB7 (p\u2096 \u2212 q\u2096))\xB2: the motion [x, y, \u03B8] of the new pose step \u2218 pose.
// src: points moved by the present pose; dst: their matches; normals: their unit normals, NaN where there is none.
// All are Float64Array x0, y0, x1, y1, \u2026
function point_to_plane_step(src, dst, normals) {
  return [0, 0, 0];
}
`,
    trials: [
      {
        name: "A known motion",
        arguments: cornerSeen(OFF, [0, 0]),
        fault: undoes(OFF, [0, 0], "Two walls that meet determine all three numbers.")
      },
      {
        name: "Far from the origin",
        arguments: cornerSeen(OFF, [1e3, -2e3]),
        fault: undoes(OFF, [1e3, -2e3], "Rotate about the centroid; about the origin, each rotation would also be a shift.")
      },
      {
        name: "Mirrored normals",
        arguments: [flat(WALL), flat(WALL.map(([x = 0]) => [x, 0])), flat([[0, -1], [0, 1], [0, -1]])],
        fault: motion([0, ACROSS, 0], 1e-9, "The sign of a normal is arbitrary, and cancels in J\u1D40J and in J\u1D40e.")
      },
      {
        name: "A corridor",
        arguments: [flat(WALL), flat(WALL.map(([x = 0]) => [x + 0.5, 0])), flat([[0, 1], [0, 1], [0, 1]])],
        fault: motion([0, ACROSS, 0], 1e-9, "No normal points along the wall, so the ridge allows no step there.")
      },
      {
        name: "No pairs",
        arguments: [new Float64Array(0), new Float64Array(0), new Float64Array(0)],
        fault: motion([0, 0, 0], 0, "Fewer than three normals give the identity.")
      },
      {
        name: "Only two normals",
        arguments: [flat(ROOM), flat(ROOM.map(([x = 0, y = 0]) => [x + 0.1, y])), flat(ROOM.map((_, k) => k < 2 ? [1, 0] : [NaN, NaN]))],
        fault: motion([0, 0, 0], 0, "Pairs without a normal do not count, and fewer than three give the identity.")
      }
    ],
    help: [
      "Skip pairs whose normal is NaN. With c the centroid of the other p\u2096, row k is J = (n\u2093, n_y, (p \u2212 c) \xD7 n), a \xD7 b = a\u2093 b_y \u2212 a_y b\u2093.",
      "Sum H = \u03A3 J\u1D40J and g = \u03A3 J\u1D40e with e = n \xB7 (p \u2212 q). Add \u03BB = 1e-4 \xB7 tr(H)/3 + 1e-12 to the diagonal of H, and solve H x = \u2212g by Cramer\u2019s rule or elimination.",
      "The step turns by \u03B8 about c and then shifts by (t\u2093, t_y): [t\u2093 + c\u2093 \u2212 cos \u03B8 c\u2093 + sin \u03B8 c_y, t_y + c_y \u2212 sin \u03B8 c\u2093 \u2212 cos \u03B8 c_y, \u03B8]."
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
`
  };
  function kept(expected, meaning) {
    return (result) => {
      const found = numbers(result, expected.length);
      if (found?.every((one, k) => one === expected[k]) === true) return void 0;
      return `expected the indices [${expected.join(", ")}], but got ${shown(result)}. ${meaning}`;
    };
  }
  var REJECT = {
    name: "keep_pairs",
    stub: `// The indices of the pairs that ICP keeps: of n pairs, the max(1, \u2308(1 \u2212 trim) n\u2309) shortest, in order.
// lengths: Float64Array, m. trim: the share to drop, 0 to 1; 0 in the lap of w16.2.
function keep_pairs(lengths, trim) {
  return [];
}
`,
    trials: [
      {
        name: "A box that moved",
        arguments: [Float64Array.of(0.1, 0.5, 0.2, 0.4), 0.25],
        fault: kept([0, 2, 3], "The longest pair is on the box and is dropped.")
      },
      {
        name: "A share of three",
        arguments: [Float64Array.of(0.3, 0.1, 0.2), 0.5],
        fault: kept([1, 2], "Of 1.5 pairs, 2 are kept. Round up.")
      },
      {
        name: "Lengths are numbers",
        arguments: [Float64Array.of(10, 9, 2, 1), 0.5],
        fault: kept([2, 3], "An array sorts its elements as text unless told otherwise.")
      },
      {
        name: "A corridor without trimming",
        arguments: [Float64Array.of(0.2, 0.2, 0.2), 0],
        fault: kept([0, 1, 2], "All pairs stay if nothing is trimmed.")
      },
      { name: "All trimmed", arguments: [Float64Array.of(0.3, 0.1, 0.2), 1], fault: kept([1], "At least one stays, the shortest.") },
      { name: "No pairs", arguments: [new Float64Array(0), 0.25], fault: kept([], "There is nothing to keep.") }
    ],
    help: [
      "Sort a copy of the lengths to find the length of the last pair that stays, and keep all pairs up to it.",
      "k = Math.max(1, Math.ceil((1 \u2212 trim) * n)); without pairs there is no k-th one.",
      "const limit = Float64Array.from(lengths).sort()[k \u2212 1]; a typed array sorts numbers."
    ],
    solution: `function keep_pairs(lengths, trim) {
  const k = Math.max(1, Math.ceil((1 - trim) * lengths.length));
  const limit = Float64Array.from(lengths).sort()[k - 1];
  const kept = [];
  lengths.forEach((length, number) => { if (length <= limit) kept.push(number); });
  return kept;
}
`
  };
  function verdict(chi2, accepted, meaning) {
    return (result) => {
      const found = result;
      const isNear = typeof found?.chi2 === "number" && (Math.abs(found.chi2 - chi2) < 1e-9 || Number.isNaN(chi2) && Number.isNaN(found.chi2));
      if (isNear && found?.accepted === accepted) return void 0;
      const expected = `\u03C7\xB2 ${Number.isNaN(chi2) ? "NaN" : chi2.toFixed(3)} and accepted ${accepted}`;
      const came = typeof found?.chi2 === "number" ? `\u03C7\xB2 ${found.chi2.toFixed(3)} and accepted ${String(found.accepted)}` : shown(result);
      return `expected ${expected}, but got ${came}. ${meaning}`;
    };
  }
  var DRIFT = [0.045, 0.012];
  var GATE = 7.815;
  var LOOP_GATE = {
    name: "gate",
    stub: `// Whether a loop is within the drift of the odometry: {chi2, accepted}.
// innovation: [x, y, \u03B8], m, m, rad; gap: nodes between the two ends; drift: [\u03C3, \u03C3_\u03B8] per node, m, rad;
// limit: the largest \u03C7\xB2 that is accepted.
function gate(innovation, gap, drift, limit) {
  return { chi2: 0, accepted: true };
}
`,
    trials: [
      {
        name: "A known innovation",
        arguments: [Float64Array.of(0.045, 0, 0), 1, [...DRIFT], GATE],
        fault: verdict(1, true, "One standard deviation gives \u03C7\xB2 1.")
      },
      {
        name: "A longer path",
        arguments: [Float64Array.of(0.09, 0, 0.024), 4, [...DRIFT], GATE],
        fault: verdict(2, true, "The variance grows with the gap, the standard deviation with \u221Agap.")
      },
      {
        name: "Mirrored",
        arguments: [Float64Array.of(-0.045, 0.045, -0.012), 1, [...DRIFT], GATE],
        fault: verdict(3, true, "The sign of an innovation does not matter.")
      },
      {
        name: "Three sigma along a corridor",
        arguments: [Float64Array.of(3 * 0.045 * 5, 0, 0), 25, [...DRIFT], GATE],
        fault: verdict(9, false, "\u03C7\xB2 9 is above 7.815.")
      },
      {
        name: "Another limit",
        arguments: [Float64Array.of(3 * 0.045 * 5, 0, 0), 25, [...DRIFT], 11.345],
        fault: verdict(9, true, "The limit is an argument: 11.345 is the 99% quantile.")
      },
      { name: "At the limit", arguments: [Float64Array.of(0, 2, 0), 1, [1, 1], 4], fault: verdict(4, true, "\u2264, not <.") },
      {
        name: "No pairs",
        arguments: [Float64Array.of(NaN, 0, 0), 1, [...DRIFT], GATE],
        fault: verdict(NaN, false, "A registration without pairs has no innovation; NaN \u2264 limit is false, and so is NaN > limit.")
      }
    ],
    help: [
      "S = gap \xB7 diag(\u03C3\xB2, \u03C3\xB2, \u03C3_\u03B8\xB2), and \u03C7\xB2 = \u03BE\u1D40 S\u207B\xB9 \u03BE: S is diagonal, so it is a sum of three quotients.",
      "A loop is accepted if \u03C7\xB2 \u2264 limit; write it so that NaN is rejected.",
      "const chi2 = (x\xB2 + y\xB2) / (gap \u03C3\xB2) + \u03B8\xB2 / (gap \u03C3_\u03B8\xB2)."
    ],
    solution: `function gate(innovation, gap, drift, limit) {
  const [x, y, theta] = innovation;
  const [xy, turn] = drift;
  const chi2 = (x * x + y * y) / (gap * xy * xy) + (theta * theta) / (gap * turn * turn);
  return { chi2, accepted: chi2 <= limit };
}
`
  };
  var EXERCISES = new Map([ALIGN, PLANE, REJECT, LOOP_GATE].map((exercise) => [exercise.name, exercise]));

  // web/page/write/marking.ts
  function trial(name, test) {
    const found = EXERCISES.get(name)?.trials[test];
    if (found === void 0) throw new RangeError(`${name} has no test ${test}`);
    return found;
  }
  function text(value) {
    if (value instanceof Float64Array) return `Float64Array.of(${[...value].join(", ")})`;
    return Array.isArray(value) ? `[${value.map(text).join(", ")}]` : String(value);
  }
  globalThis.marking = {
    names: () => [...EXERCISES.keys()],
    count: (name) => EXERCISES.get(name)?.trials.length ?? 0,
    call: (name, test) => `${name}(${trial(name, test).arguments.map(text).join(", ")})`,
    fault: (name, test, result) => {
      const { name: what, fault } = trial(name, test);
      const sentence = fault(result);
      return sentence === void 0 ? "" : `${what}: ${sentence}`;
    }
  };
})();
