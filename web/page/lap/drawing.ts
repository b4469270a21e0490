// Draws one moment of the lap to a canvas or an SVG.

import type { Moment, Point, Pose, Story } from './story';

/** Colours by their names in the style sheets. */
export type Ink = 'truth' | 'prediction' | 'outbound' | 'return' | 'posterior' | 'prior' | 'measurement' | 'ink' | 'paper';

/** A canvas or an SVG; positions in pixels from the upper left corner. */
export interface Surface {
  line(points: readonly Point[], ink: Ink, width: number, options?: { alpha?: number; dash?: number[] }): void;
  dots(points: readonly Point[], ink: Ink, size: number, alpha?: number): void;
  area(points: readonly Point[], ink: Ink): void;
  /** Text centred at a point, with a halo in the colour of the paper. */
  words(text: string, at: Point, ink: Ink, size: number): void;
}

/** Aspect ratio of the strip; on a phone it is higher. `lap.css` has both, with the width. */
export const ASPECT = 2.4;
const PHONE_ASPECT = 1.6;
const PHONE_PX = 480;

export function aspectAt(widthPx: number): number {
  return widthPx < PHONE_PX ? PHONE_ASPECT : ASPECT;
}

/** Centre and width of the view, in metres: the corridor of the flat, and a close-up. */
const WHOLE = { x: 6, y: 4.55, width: 12.5 };
const CLOSE = { x: 4.9, y: 4.7, width: 9.3 };
/** Positions of the labels of the walls, in metres. */
const WALL_LABELS = { out: [2.1, 5.35], back: [7.6, 5.35] } as const;
/** At this width line widths are as given; at others they scale, within limits. */
const REFERENCE_WIDTH_PX = 900;

export function draw(story: Story, moment: Moment, surface: Surface, widthPx: number): void {
  const toPixels = camera(moment.closeness, widthPx);
  const unit = Math.min(Math.max(widthPx / REFERENCE_WIDTH_PX, 0.65), 1.3);
  for (const [x0, y0, x1, y1] of story.walls) surface.line([toPixels([x0, y0]), toPixels([x1, y1])], 'truth', unit, { alpha: 0.55 });
  drawRays(story, moment, surface, toPixels, unit);
  const [out, back] = mapOf(story, moment);
  surface.dots(out.map(toPixels), 'outbound', 3 * unit);
  surface.dots(back.map(toPixels), 'return', 3 * unit);
  drawBefore(story, moment, surface, toPixels, unit);
  drawMoved(moment, surface, toPixels, unit);
  const path = moment.keyframes.map(([x, y]): Point => [x, y]);
  const [robotX, robotY] = moment.robot;
  surface.line([...path, [robotX, robotY] as Point].map(toPixels), 'posterior', 2 * unit);
  for (const { from, to: old } of moment.closed) {
    const ends = [path[from], path[old]].filter((end) => end !== undefined);
    surface.line(ends.map(toPixels), 'measurement', 4 * unit);
  }
  surface.line(moment.wheels.map(toPixels), 'prediction', 2.5 * unit, { dash: [7 * unit, 4 * unit] });
  const [wheelsX, wheelsY] = moment.wheels.at(-1) ?? [robotX, robotY];
  drawRobot(surface, toPixels, [wheelsX, wheelsY, wheelsHeading(moment)], 'prediction', 8 * unit);
  drawRobot(surface, toPixels, moment.robot, 'posterior', 10 * unit);
  drawPathLabels(moment, surface, toPixels, unit);
  if (moment.closed.length > 0) drawCorrection(moment, surface, unit, widthPx);
  else drawWallLabels(moment, surface, toPixels, unit, widthPx);
}

/** As the doubled wall closes: how far the farthest keyframe has moved, below the map. */
function drawCorrection({ before, keyframes }: Moment, surface: Surface, unit: number, widthPx: number): void {
  const moved = keyframes.map(([x, y], node) => {
    const [oldX, oldY] = before.poses[node] ?? [x, y];
    return Math.hypot(x - oldX, y - oldY);
  });
  const size = 36 * unit;
  const words = `the past moved ${Math.round(100 * Math.max(...moved))} cm`;
  surface.words(words, [widthPx / 2, widthPx / aspectAt(widthPx) - 0.75 * size], 'ink', size);
}

const labelSize = (unit: number): number => Math.max(14 * unit, 11);

/** Labels each path at its end. */
function drawPathLabels(moment: Moment, surface: Surface, toPixels: Camera, unit: number): void {
  const size = labelSize(unit);
  const robot = toPixels([moment.robot[0], moment.robot[1]]);
  const wheels = toPixels(moment.wheels.at(-1) ?? [moment.robot[0], moment.robot[1]]);
  const side = wheels[1] > robot[1] ? 1 : -1;
  // There may be no room above the wheels' robot.
  const ofWheels = wheels[1] + side * 1.7 * size < size ? 1 : side;
  surface.words('from wheels', [wheels[0], wheels[1] + ofWheels * 1.7 * size], 'prediction', size);
  surface.words('from sweeps', [robot[0], robot[1] - side * 1.7 * size], 'posterior', size);
}

/** Labels the walls once the way back has some. */
function drawWallLabels(moment: Moment, surface: Surface, toPixels: Camera, unit: number, widthPx: number): void {
  // On a phone they would lie on each other: the caption has the words.
  if (moment.act === 0 || widthPx < PHONE_PX) return;
  const size = labelSize(unit);
  surface.words('walls, outbound', toPixels(WALL_LABELS.out), 'outbound', size);
  surface.words('walls, return', toPixels(WALL_LABELS.back), 'return', size);
}

/** At the end: the walls of the way back before the loops closed. */
function drawBefore(story: Story, { before: { poses, strength } }: Moment, surface: Surface, toPixels: Camera, unit: number): void {
  if (strength === 0) return;
  const doubled = poses.flatMap((pose, node) => (node <= story.turn ? [] : placed(story.ticks[story.keyframes[node] ?? 0]?.sweep ?? [], pose)));
  surface.dots(doubled.map(toPixels), 'prior', 3 * unit, 0.4 * strength);
}

type Camera = (point: Point) => Point;

function frame(closeness: number, widthPx: number): { scale: number; middleX: number; middleY: number } {
  const mix = (key: keyof typeof WHOLE): number => WHOLE[key] + closeness * (CLOSE[key] - WHOLE[key]);
  return { scale: widthPx / mix('width'), middleX: mix('x'), middleY: mix('y') };
}

/** Converts metres to pixels. */
export function camera(closeness: number, widthPx: number): Camera {
  const { scale, middleX, middleY } = frame(closeness, widthPx);
  return ([x, y]) => [widthPx / 2 + scale * (x - middleX), widthPx / aspectAt(widthPx) / 2 - scale * (y - middleY)];
}

/** Converts pixels to metres. */
export function worldAt([x, y]: Point, closeness: number, widthPx: number): Point {
  const { scale, middleX, middleY } = frame(closeness, widthPx);
  return [middleX + (x - widthPx / 2) / scale, middleY - (y - widthPx / aspectAt(widthPx) / 2) / scale];
}

/** The points of all sweeps at the poses of their keyframes, of the way out and of the way back. */
function mapOf(story: Story, { keyframes }: Moment): [Point[], Point[]] {
  const ways: [Point[], Point[]] = [[], []];
  keyframes.forEach((pose, node) => {
    const sweep = story.ticks[story.keyframes[node] ?? 0]?.sweep ?? [];
    ways[node <= story.turn ? 0 : 1].push(...placed(sweep, pose));
  });
  return ways;
}

function placed(sweep: readonly number[], [x, y, heading]: Pose): Point[] {
  const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
  const points: Point[] = [];
  for (let at = 0; at + 1 < sweep.length; at += 2) {
    const [px, py] = [sweep[at] ?? 0, sweep[at + 1] ?? 0];
    points.push([x + cos * px - sin * py, y + sin * px + cos * py]);
  }
  return points;
}

/** The beams of the current sweep. */
function drawRays(story: Story, moment: Moment, surface: Surface, toPixels: Camera, unit: number): void {
  const [x, y] = moment.robot;
  const sweep = story.ticks[moment.tick]?.sweep ?? [];
  for (const point of placed(sweep, moment.robot)) {
    surface.line([toPixels([x, y]), toPixels(point)], 'measurement', 0.75 * unit, { alpha: 0.16 });
  }
}

/** An arrow from the old to the new position of each corrected keyframe. */
function drawMoved(moment: Moment, surface: Surface, toPixels: Camera, unit: number): void {
  const { from, strength } = moment.moved;
  if (strength === 0) return;
  from.forEach((before, node) => {
    const after = moment.keyframes[node];
    if (after === undefined) return;
    const [start, end] = [toPixels([before[0], before[1]]), toPixels([after[0], after[1]])];
    const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
    const length = Math.hypot(dx, dy);
    if (length < 3 * unit) return;
    const head = Math.min(6 * unit, length / 2);
    const side = (sign: number): Point => [
      end[0] - (head * (dx - (sign * dy) / 1.6)) / length,
      end[1] - (head * (dy + (sign * dx) / 1.6)) / length,
    ];
    surface.line([start, end], 'prior', 2 * unit, { alpha: strength });
    surface.line([side(1), end, side(-1)], 'prior', 2 * unit, { alpha: strength });
  });
}

function wheelsHeading({ wheels, robot }: Moment): number {
  const [last, before] = [wheels.at(-1), wheels.findLast(([x, y]) => {
    const end = wheels.at(-1);
    return end !== undefined && Math.hypot(end[0] - x, end[1] - y) > 0.05;
  })];
  if (last === undefined || before === undefined) return robot[2];
  return Math.atan2(last[1] - before[1], last[0] - before[0]);
}

function drawRobot(surface: Surface, toPixels: Camera, [x, y, heading]: Pose, ink: Ink, size: number): void {
  const [px, py] = toPixels([x, y]);
  const corner = (turn: number, reach: number): Point => [
    px + reach * size * Math.cos(heading + turn),
    py - reach * size * Math.sin(heading + turn),
  ];
  surface.area([corner(0, 1.2), corner(2.5, 1), corner(-2.5, 1)], ink);
}
