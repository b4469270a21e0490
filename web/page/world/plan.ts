// Draws plans as a world: floors, walls with their thickness, robots seen from above, what a sensor sees. The widgets'
// plans have the same proportions: widgets/widget_kit/src/draw/plan.rs.

import type { Ink, Point, Pose, Surface } from './surfaces';

/** How metres become pixels. */
export interface View {
  to(metres: Point): Point;
  pxPerM: number;
  /** On a phone or a card lines are thinner. */
  isSmall: boolean;
}

/** Thickness of a wall. */
const WALL = { m: 0.12, leastPx: 3 };
/** Width of the line around all walls. */
const EDGE_PX = 1;
/** Shades of a wall, to the lower right, the farther one lighter. */
const SHADES: readonly [Ink, number][] = [['shade-far', 0.13], ['shade', 0.07]];
const SHADE_STEP_PX = 2;
/** Half the width of a robot. */
const ROBOT = { m: 0.18, leastPx: 11 };
/** Half the distance of its wheels. */
const TRACK_M = 0.165;
/** Neighbouring returns of a sweep that are farther apart, in angle and in distance, have no wall between them. */
const GAP = { rad: 0.2, m: 0.5 };
/** Side of a cell of a map. */
const CELL = { m: 0.025, leastPx: 1 };
/** How far the ring that says that a thing can be taken is from it. */
const GRIP_PX = 9;

/** Threads, from short to long. */
const THREADS: readonly Ink[] = ['thread-1', 'thread-2', 'thread-3', 'thread-4', 'thread-5'];

export type Segment = readonly [Point, Point];

/** A floor whose walls are unknown, within points around it. */
export function floor(surface: Surface, view: View, rim: readonly Point[]): void {
  surface.area(rim.map(view.to), 'floor');
}

/** The floor within the walls, and what the walls leave in the shade. */
export function ground(surface: Surface, view: View, segments: readonly Segment[]): void {
  const ends = segments.flat().map(view.to);
  const [xs, ys] = [ends.map(([x]) => x), ends.map(([, y]) => y)];
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  surface.area([[left, top], [right, top], [right, bottom], [left, bottom]], 'floor');
  for (const [ink, metres] of SHADES) {
    const count = Math.floor((metres * view.pxPerM) / SHADE_STEP_PX);
    const steps = Array.from({ length: count }, (_, k) => ((k + 1) / count) * metres);
    const moved = steps.flatMap((by) => segments.map((wall) => wall.map(([x, y]) => view.to([x + by, y - by]))));
    if (count > 0) surface.lines(moved, ink, wallPx(view), { isSquare: true });
  }
}

/** First a line around all walls, then all fills, so that joints vanish. */
export function walls(surface: Surface, view: View, segments: readonly Segment[]): void {
  const lines = segments.map((wall) => wall.map(view.to));
  surface.lines(lines, 'wall-edge', wallPx(view) + 2 * EDGE_PX, { isSquare: true });
  surface.lines(lines, 'wall', wallPx(view), { isSquare: true });
}

function wallPx({ pxPerM }: View): number {
  return Math.max(WALL.m * pxPerM, WALL.leastPx);
}

/** The area between a sensor and its returns, with its opacities at the sensor and at the range, m; beams without return end there. */
export function seen(surface: Surface, view: View, sensor: Point, returns: readonly Point[], ink: Ink, alphas: readonly [number, number], rangeM: number): void {
  const from = view.to(sensor);
  const rays = returns.map((metres) => {
    const at = view.to(metres);
    return { at, angle: Math.atan2(at[1] - from[1], at[0] - from[0]) };
  }).sort((a, b) => a.angle - b.angle);
  const range = rangeM * view.pxPerM;
  const end = (angle: number): Point => [from[0] + range * Math.cos(angle), from[1] + range * Math.sin(angle)];
  const rim = rays.flatMap(({ at, angle }, k) => {
    const next = rays[(k + 1) % rays.length] ?? { at, angle };
    const turn = (next.angle - angle + 2 * Math.PI) % (2 * Math.PI);
    const isGap = turn > GAP.rad && Math.hypot(next.at[0] - at[0], next.at[1] - at[1]) > GAP.m * view.pxPerM;
    return isGap ? [at, end(angle), end(next.angle)] : [at];
  });
  surface.fan(from, [...rim, ...rim.slice(0, 1)], ink, alphas, range);
}

/** The returns of a sweep. */
export function returns(surface: Surface, view: View, points: readonly Point[], ink: Ink): void {
  surface.discs(points.map(view.to), ink, view.isSmall ? 1.8 : 2.6);
}

/** A map, as ink that gathers where many returns lie. */
export function map(surface: Surface, view: View, points: readonly Point[], ink: Ink, alpha?: number): void {
  surface.mist(points.map(view.to), ink, Math.max(CELL.m * view.pxPerM, CELL.leastPx), alpha);
}

/** Correspondences: the longer a thread the wider and the warmer, the longest on top. */
export function threads(surface: Surface, view: View, pairs: readonly Segment[], reachM: number): void {
  for (const [k, ink] of THREADS.entries()) {
    const share = ([from, to]: Segment): number => Math.min(Math.hypot(to[0] - from[0], to[1] - from[1]) / reachM, 0.999);
    const alike = pairs.filter((pair) => Math.floor(share(pair) * THREADS.length) === k);
    if (alike.length > 0) surface.lines(alike.map((pair) => pair.map(view.to)), ink, 1.25 + (2 * (k + 0.5)) / THREADS.length);
  }
}

/** The two tracks of a robot's wheels. */
export function tracks(surface: Surface, view: View, poses: readonly Pose[], ink: Ink): void {
  const track = (side: number) => poses.map(([x, y, heading]) => view.to([x - side * Math.sin(heading), y + side * Math.cos(heading)]));
  surface.lines([track(TRACK_M), track(-TRACK_M)], ink, view.isSmall ? 1.75 : 2.5, { dash: view.isSmall ? [5, 4] : [8, 6] });
}

/** An estimated path, on a rim of paper. */
export function path(surface: Surface, view: View, points: readonly Point[], ink: Ink): void {
  const line = points.map(view.to);
  const width = view.isSmall ? 2.75 : 4;
  surface.lines([line], 'paper', width + 3, { alpha: 0.75 });
  surface.lines([line], ink, width);
}

function robotPx({ pxPerM }: View): number {
  return Math.max(ROBOT.m * pxPerM, ROBOT.leastPx);
}

/** The radius of the ring around a robot: words stand beyond it. */
export function gripPx(view: View): number {
  return robotPx(view) + GRIP_PX;
}

/** A robot from above: body, wheels, and a lidar whose tip points ahead. One that is only believed in is a ghost. */
export function robot(surface: Surface, view: View, [x, y, heading]: Pose, ink: Ink, isGhost = false): void {
  const [at, half] = [view.to([x, y]), robotPx(view)];
  const [cos, sin] = [Math.cos(heading), -Math.sin(heading)];
  const spot = ([ahead, left]: Point): Point => [at[0] + half * (ahead * cos + left * sin), at[1] + half * (ahead * sin - left * cos)];
  const body = Array.from({ length: 33 }, (_, k): Point => [Math.cos((k * Math.PI) / 16), Math.sin((k * Math.PI) / 16)]).map(([a, b]) => spot([0.86 * a, 0.86 * b]));
  if (!isGhost) surface.discs([at], 'paper', half + 2);
  for (const side of [-0.92, 0.92]) {
    const wheel: Point[] = [[-0.42, side - 0.14], [0.42, side - 0.14], [0.42, side + 0.14], [-0.42, side + 0.14]];
    surface.area(wheel.map(spot), isGhost ? ink : 'ink');
  }
  if (isGhost) {
    surface.area(body, 'paper', 0.7);
    surface.area(body, ink, 0.2);
    surface.lines([body], ink, 1.5);
  } else surface.area(body, ink);
  const lidar = isGhost ? ink : 'paper';
  surface.area(([[0.66, 0], [0, 0.34], [0, -0.34]] as const).map(spot), lidar);
  surface.discs([spot([-0.08, 0])], lidar, 0.34 * half);
}

/** The ring around a robot that can be dragged. */
export function grip(surface: Surface, view: View, [x, y]: Pose): void {
  const [at, radius] = [view.to([x, y]), gripPx(view)];
  const ring = Array.from({ length: 49 }, (_, k): Point => [at[0] + radius * Math.cos((k * Math.PI) / 24), at[1] + radius * Math.sin((k * Math.PI) / 24)]);
  surface.area(ring, 'accent', 0.16);
  surface.lines([ring], 'accent', 2.5);
}

/** A bar of one metre from a point to the right. */
export function scaleBar(surface: Surface, { pxPerM, isSmall }: View, [x, y]: Point): void {
  surface.lines([[[x, y], [x + pxPerM, y]]], 'ink', isSmall ? 3 : 4);
  surface.words('1 m', [x + pxPerM + 24, y], 'ink', 14);
}
