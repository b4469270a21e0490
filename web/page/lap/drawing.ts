// Draws one moment of the lap to a canvas or an SVG.

import { grip, gripPx, ground, map, path, returns, robot, scaleBar, seen, tracks, type View, walls } from '../world/plan';
import type { Point, Pose, Surface } from '../world/surfaces';
import type { Moment, Story } from './story';

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
/** At this width the correction is as large as given; at others it scales, within limits. */
const REFERENCE_WIDTH_PX = 900;
/** At the start both robots stand at one place. */
const FIRST_LABELS_TICK = 5;
/** Opacity of a sweep's area at the sensor and at its range, m. */
const SEEN = { alphas: [0.3, 0.06], rangeM: 6 } as const;
/** Where the world ends in the page, as shares of the height: at all sides of a close-up, above and below the whole. */
const FADE = { above: 0.15, aside: 0.12 };

export function draw(story: Story, moment: Moment, surface: Surface, widthPx: number): void {
  const view = viewOf(moment, widthPx);
  const segments = story.walls.map(([x0, y0, x1, y1]) => [[x0, y0], [x1, y1]] as const);
  const [x, y] = moment.robot;
  const hits = placed(story.ticks[moment.tick]?.sweep ?? [], moment.robot);
  ground(surface, view, segments);
  seen(surface, view, [x, y], hits, 'measurement', SEEN.alphas, SEEN.rangeM);
  walls(surface, view, segments);
  drawBefore(story, moment, surface, view);
  const [out, back] = mapOf(story, moment);
  map(surface, view, out, 'map-old');
  map(surface, view, back, 'map-new');
  tracks(surface, view, moment.wheels, 'prediction');
  drawMoved(moment, surface, view);
  const nodes = moment.keyframes.map((pose): Point => [pose[0], pose[1]]);
  path(surface, view, [...nodes, [x, y]], 'posterior');
  for (const { from, to: old } of moment.closed) {
    const ends = [nodes[from], nodes[old]].filter((end) => end !== undefined);
    surface.lines([ends.map(view.to)], 'measurement', view.isSmall ? 3.5 : 5);
  }
  returns(surface, view, hits, 'measurement');
  robot(surface, view, moment.wheels.at(-1) ?? moment.robot, 'prediction', true);
  robot(surface, view, moment.robot, 'posterior');
  const heightPx = widthPx / aspectAt(widthPx);
  surface.fade([widthPx, heightPx], [0.01 * widthPx + moment.closeness * FADE.aside * heightPx, FADE.above * heightPx]);
  scaleBar(surface, view, [12, heightPx - 14]);
  drawPathLabels(moment, surface, view);
  if (moment.closed.length > 0) drawCorrection(moment, surface, view, widthPx);
  else drawWallLabels(moment, surface, view, widthPx);
}

/** That the robot can be dragged: a ring around it, and words until somebody has. */
export function drawGrip(moment: Moment, surface: Surface, widthPx: number, words: string): void {
  const view = viewOf(moment, widthPx);
  grip(surface, view, moment.robot);
  robot(surface, view, moment.robot, 'posterior');
  if (words === '') return;
  const size = labelSize(view);
  const [x, y] = view.to([moment.robot[0], moment.robot[1]]);
  const half = 0.3 * size * words.length;
  // Ahead of the robot, where it has no path yet, unless the picture ends there.
  const ahead = x + Math.sign(Math.cos(moment.robot[2])) * (gripPx(view) + 8 + half);
  const isInside = ahead > half && ahead < widthPx - half;
  surface.words(words, [isInside ? ahead : 2 * x - ahead, y], 'accent', size);
}

/** As the doubled wall closes: how far the farthest keyframe has moved, below the map. */
function drawCorrection({ before, keyframes }: Moment, surface: Surface, { isSmall }: View, widthPx: number): void {
  const unit = Math.min(Math.max(widthPx / REFERENCE_WIDTH_PX, 0.65), 1.3);
  const moved = keyframes.map(([x, y], node) => {
    const [oldX, oldY] = before.poses[node] ?? [x, y];
    return Math.hypot(x - oldX, y - oldY);
  });
  const size = 28 * unit;
  const words = `the past moved ${Math.round(100 * Math.max(...moved))} cm`;
  // On a phone beside the bar of a metre.
  surface.words(words, [(isSmall ? 0.65 : 0.5) * widthPx, widthPx / aspectAt(widthPx) - 0.9 * size], 'ink', size);
}

const labelSize = ({ isSmall }: View): number => (isSmall ? 14 : 17);

/** Labels each path at its end, once there is one. */
function drawPathLabels(moment: Moment, surface: Surface, view: View): void {
  if (moment.tick < FIRST_LABELS_TICK) return;
  const size = labelSize(view);
  const away = gripPx(view) + size;
  const ofRobot = view.to([moment.robot[0], moment.robot[1]]);
  const [x, y] = moment.wheels.at(-1) ?? moment.robot;
  const ofWheels = view.to([x, y]);
  const side = ofWheels[1] > ofRobot[1] ? 1 : -1;
  // There may be no room above the wheels' robot.
  const below = ofWheels[1] + side * away < size ? 1 : side;
  surface.words('from wheels', [ofWheels[0], ofWheels[1] + below * away], 'prediction', size);
  surface.words('from sweeps', [ofRobot[0], ofRobot[1] - side * away], 'posterior', size);
}

/** Labels the walls once the way back has some. */
function drawWallLabels(moment: Moment, surface: Surface, view: View, widthPx: number): void {
  // On a phone they would lie on each other: the caption has the words.
  if (moment.act === 0 || widthPx < PHONE_PX) return;
  const size = labelSize(view);
  surface.words('walls, outbound', view.to(WALL_LABELS.out), 'map-old', size);
  surface.words('walls, return', view.to(WALL_LABELS.back), 'map-new', size);
}

/** At the end: the walls of the way back before the loops closed. */
function drawBefore(story: Story, { before: { poses, strength } }: Moment, surface: Surface, view: View): void {
  if (strength === 0) return;
  const doubled = poses.flatMap((pose, node) => (node <= story.turn ? [] : placed(story.ticks[story.keyframes[node] ?? 0]?.sweep ?? [], pose)));
  map(surface, view, doubled, 'map-new', 0.35 * strength);
}

type Camera = (point: Point) => Point;

function frame(closeness: number, widthPx: number): { scale: number; middleX: number; middleY: number } {
  const mix = (key: keyof typeof WHOLE): number => WHOLE[key] + closeness * (CLOSE[key] - WHOLE[key]);
  return { scale: widthPx / mix('width'), middleX: mix('x'), middleY: mix('y') };
}

function viewOf({ closeness }: Moment, widthPx: number): View {
  return { to: camera(closeness, widthPx), pxPerM: frame(closeness, widthPx).scale, isSmall: widthPx < PHONE_PX };
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

/** The path before the last correction, dotted. */
function drawMoved({ moved: { from, strength } }: Moment, surface: Surface, view: View): void {
  if (strength > 0) surface.lines([from.map(([x, y]) => view.to([x, y]))], 'posterior', 2, { alpha: strength, dash: [2, 5] });
}
