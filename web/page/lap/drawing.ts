// One moment of the lap as shapes, for a canvas and for a still picture alike.

import type { Moment, Point, Pose, Story } from './story';

/** Names of colours; the style of the page says which. */
export type Ink = 'truth' | 'prediction' | 'outbound' | 'return' | 'posterior' | 'prior' | 'measurement';

/** What is drawn on, in pixels from its upper left corner. */
export interface Surface {
  line(points: readonly Point[], ink: Ink, width: number, options?: { alpha?: number; dash?: number[] }): void;
  dots(points: readonly Point[], ink: Ink, size: number): void;
  area(points: readonly Point[], ink: Ink): void;
}

/** Width and height of the strip are in this proportion. */
export const ASPECT = 2.4;

/** Middle and width of what is seen, in metres: of the whole flat's corridor, and closer. */
const WHOLE = { x: 6, y: 4.55, width: 12.5 };
const CLOSE = { x: 4.9, y: 4.7, width: 9.3 };
/** At this width of the strip lines have their widths, and are thinner or thicker in proportion, within limits. */
const USUAL_WIDTH_PX = 900;

/** Draws a moment into a width. */
export function draw(story: Story, moment: Moment, surface: Surface, widthPx: number): void {
  const to = camera(moment.closeness, widthPx);
  const unit = Math.min(Math.max(widthPx / USUAL_WIDTH_PX, 0.65), 1.3);
  for (const [x0, y0, x1, y1] of story.walls) surface.line([to([x0, y0]), to([x1, y1])], 'truth', unit, { alpha: 0.55 });
  drawRays(story, moment, surface, to, unit);
  const [out, back] = mapOf(story, moment);
  surface.dots(out.map(to), 'outbound', 3 * unit);
  surface.dots(back.map(to), 'return', 3 * unit);
  drawMoved(moment, surface, to, unit);
  const way = moment.keyframes.map(([x, y]): Point => [x, y]);
  const [robotX, robotY] = moment.robot;
  surface.line([...way, [robotX, robotY] as Point].map(to), 'posterior', 2 * unit);
  for (const { from, to: old } of moment.closed) {
    const ends = [way[from], way[old]].filter((end) => end !== undefined);
    surface.line(ends.map(to), 'measurement', 4 * unit);
  }
  surface.line(moment.wheels.map(to), 'prediction', 2.5 * unit, { dash: [7 * unit, 4 * unit] });
  const [wheelsX, wheelsY] = moment.wheels.at(-1) ?? [robotX, robotY];
  drawRobot(surface, to, [wheelsX, wheelsY, wheelsHeading(moment)], 'prediction', 8 * unit);
  drawRobot(surface, to, moment.robot, 'posterior', 10 * unit);
}

type Camera = (point: Point) => Point;

function camera(closeness: number, widthPx: number): Camera {
  const mix = (key: keyof typeof WHOLE): number => WHOLE[key] + closeness * (CLOSE[key] - WHOLE[key]);
  const scale = widthPx / mix('width');
  const [middleX, middleY] = [mix('x'), mix('y')];
  return ([x, y]) => [widthPx / 2 + scale * (x - middleX), widthPx / ASPECT / 2 - scale * (y - middleY)];
}

/** The points of all sweeps at the keyframes' poses: those of the way out, those of the way back. */
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

/** What the laser sees just now. */
function drawRays(story: Story, moment: Moment, surface: Surface, to: Camera, unit: number): void {
  const [x, y] = moment.robot;
  const sweep = story.ticks[moment.tick]?.sweep ?? [];
  for (const point of placed(sweep, moment.robot)) {
    surface.line([to([x, y]), to(point)], 'measurement', 0.75 * unit, { alpha: 0.16 });
  }
}

/** An arrow from where a keyframe was to where it is. */
function drawMoved(moment: Moment, surface: Surface, to: Camera, unit: number): void {
  const { from, strength } = moment.moved;
  if (strength === 0) return;
  from.forEach((before, node) => {
    const after = moment.keyframes[node];
    if (after === undefined) return;
    const [start, end] = [to([before[0], before[1]]), to([after[0], after[1]])];
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

function drawRobot(surface: Surface, to: Camera, [x, y, heading]: Pose, ink: Ink, size: number): void {
  const [px, py] = to([x, y]);
  const corner = (turn: number, reach: number): Point => [
    px + reach * size * Math.cos(heading + turn),
    py - reach * size * Math.sin(heading + turn),
  ];
  surface.area([corner(0, 1.2), corner(2.5, 1), corner(-2.5, 1)], ink);
}
