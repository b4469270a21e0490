// A building mapped by three estimates of the same drive: odometry, scan matching, loop closure.

import type { Surface } from '../lap/drawing';
import { type Point, type Pose, between } from '../lap/story';

/** The output of `cargo run --release -p ch16_lab --example building_story`. */
export interface Building {
  /** Poses of keyframes, `[cm, cm, mrad]`. */
  wheels: Pose[];
  walls: Pose[];
  loops: Pose[];
  /** Largest position error of a keyframe by each of the three. */
  worst_cm: [number, number, number];
  beams_mrad: [number, number];
  ranges_cm: number[][];
}

/** The last of the three estimates. */
export const LOOPS = 2;
/** Size of the view relative to the building. */
const MARGIN = 1.1;
/** Share of outliers, such as returns through glass, that the view ignores at each side. */
const STRAY = 0.004;

interface View {
  x: number;
  y: number;
  scale: number;
}

/** The building at `at`: 0 by the wheels, 1 by the walls, 2 with loops, and between them. */
export function draw(story: Building, at: number, surface: Surface, width: number, height: number): void {
  const poses = posesAt(story, at);
  const view = viewAt(story, at, width, height);
  const toPixels = ([x, y]: Point): Point => [width / 2 + view.scale * (x - view.x), height / 2 - view.scale * (y - view.y)];
  const unit = Math.min(Math.max(width / 900, 0.65), 1.3);
  const way = (of: readonly Pose[]): Point[] => of.map(([x, y]) => toPixels([x, y]));
  if (at > 0) surface.line(way(story.wheels), 'prediction', 1.5 * unit, { alpha: 0.55, dash: [6 * unit, 4 * unit] });
  surface.dots(onPicture(pointsOf(story, poses).map(toPixels), width, height), 'ink', 2 * unit);
  const ink = at === 0 ? 'prediction' : 'posterior';
  const path = way(poses);
  surface.line(path, ink, 2.5 * unit);
  const size = Math.max(14 * unit, 12);
  const end = path.at(-1);
  if (end === undefined) return;
  surface.dots([end], ink, 10 * unit);
  surface.words(at === 0 ? 'where the wheels put it' : 'the robot', [end[0], end[1] + 1.4 * size], ink, size);
  // The dashed path mostly ends outside the picture: its label is at its last visible point.
  const last = at > 0 ? way(story.wheels).findLast(([x, y]) => x > 5 * size && x < width - 5 * size && y > 2 * size && y < height - 2 * size) : undefined;
  if (last !== undefined) surface.words('from wheels', last, 'prediction', size);
}

/** The two estimates around `at`, and its share of the way between them. */
function spanAt<T>([wheels, walls, loops]: readonly [T, T, T], at: number): [from: T, to: T, share: number] {
  return at < 1 ? [wheels, walls, at] : [walls, loops, at - 1];
}

function posesAt({ wheels, walls, loops }: Building, at: number): Pose[] {
  const [from, to, share] = spanAt([wheels, walls, loops], at);
  const radians = ([x, y, heading]: Pose): Pose => [x, y, heading / 1000];
  return from.map((pose, k) => between(radians(pose), radians(to[k] ?? pose), share));
}

function pointsOf({ ranges_cm, beams_mrad: [first, step] }: Building, poses: readonly Pose[]): Point[] {
  return ranges_cm.flatMap((ranges, k) => {
    const [x, y, heading] = poses[k] ?? [0, 0, 0];
    return ranges.flatMap((range, beam): Point[] => {
      const angle = heading + (first + beam * step) / 1000;
      return range === 0 ? [] : [[x + range * Math.cos(angle), y + range * Math.sin(angle)]];
    });
  });
}

function onPicture(points: readonly Point[], width: number, height: number): Point[] {
  return points.filter(([x, y]) => x > 0 && x < width && y > 0 && y < height);
}

const views = new WeakMap<Building, { width: number; height: number; of: [View, View, View] }>();

function viewAt(story: Building, at: number, width: number, height: number): View {
  let known = views.get(story);
  if (known === undefined || known.width !== width || known.height !== height) {
    const fit = (state: number): View => {
      const points = pointsOf(story, posesAt(story, state));
      const [left, right] = spanOf(points.map(([x]) => x));
      const [low, high] = spanOf(points.map(([, y]) => y));
      const scale = Math.min(width / (right - left), height / (high - low)) / MARGIN;
      return { x: (left + right) / 2, y: (low + high) / 2, scale };
    };
    known = { width, height, of: [fit(0), fit(1), fit(LOOPS)] };
    views.set(story, known);
  }
  const [from, to, share] = spanAt(known.of, at);
  const mix = (a: number, b: number): number => a + share * (b - a);
  return { x: mix(from.x, to.x), y: mix(from.y, to.y), scale: mix(from.scale, to.scale) };
}

function spanOf(values: readonly number[]): [number, number] {
  const sorted = [...values].sort((a, b) => a - b);
  const skipped = Math.floor(STRAY * sorted.length);
  return [sorted[skipped] ?? 0, sorted.at(-1 - skipped) ?? 0];
}

/** An error in metres, or in centimetres below half a metre. */
export function formatError(cm: number): string {
  return cm < 50 ? `${cm} cm` : `${(cm / 100).toFixed(cm < 1000 ? 1 : 0)} m`;
}
