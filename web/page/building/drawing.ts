// A building mapped by three estimates of the same drive: odometry, scan matching, loop closure.

import { between } from '../lap/story';
import { map, path, robot, gripPx, type View } from '../world/plan';
import type { Point, Pose, Surface } from '../world/surfaces';

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
/** Lines are thinner in a picture narrower than that, and in a large building. */
const SMALL_PX = 480;
const SMALL_PX_PER_CM = 0.3;
/** Within that distance of its sides the picture ends in the page. */
const FADE_PX = 28;
/** Share of outliers, such as returns through glass, that the view ignores at each side. */
const STRAY = 0.004;

interface Fit {
  x: number;
  y: number;
  scale: number;
}

/** The building at `at`: 0 by the wheels, 1 by the walls, 2 with loops, and between them. */
export function draw(story: Building, at: number, surface: Surface, width: number, height: number): void {
  const poses = posesAt(story, at);
  const fit = fitAt(story, at, width, height);
  const to = ([x, y]: Point): Point => [width / 2 + fit.scale * (x - fit.x), height / 2 - fit.scale * (y - fit.y)];
  const view: View = { to, pxPerM: 100 * fit.scale, isSmall: width < SMALL_PX || fit.scale < SMALL_PX_PER_CM };
  const placeOf = ([x, y]: Pose): Point => [x, y];
  surface.lines([story.wheels.map((pose) => to(placeOf(pose)))], 'prediction', 1.75, { alpha: at === 0 ? 1 : 0.7, dash: [5, 4] });
  map(surface, view, onPicture(pointsOf(story, poses), to, width, height), 'map-old');
  const ink = at === 0 ? 'prediction' : 'posterior';
  if (at > 0) path(surface, view, poses.map(placeOf), ink);
  surface.fade([width, height], [FADE_PX, FADE_PX]);
  const last = poses.at(-1);
  if (last === undefined) return;
  robot(surface, view, last, ink, at === 0);
  const size = width < SMALL_PX ? 14 : 17;
  const [x, y] = to(placeOf(last));
  surface.words(at === 0 ? 'where the wheels put it' : 'the robot', [x, y + gripPx(view) + 0.5 * size], ink, size);
  // The dashed path mostly ends outside the picture: its label is at its last visible point.
  const isVisible = ([left, top]: Point): boolean => left > 5 * size && left < width - 5 * size && top > 2 * size && top < height - 2 * size;
  const end = at > 0 ? story.wheels.map((pose) => to(placeOf(pose))).findLast(isVisible) : undefined;
  if (end !== undefined) surface.words('from wheels', end, 'prediction', size);
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

function onPicture(points: readonly Point[], to: View['to'], width: number, height: number): Point[] {
  return points.filter((point) => {
    const [x, y] = to(point);
    return x > 0 && x < width && y > 0 && y < height;
  });
}

const fits = new WeakMap<Building, { width: number; height: number; of: [Fit, Fit, Fit] }>();

function fitAt(story: Building, at: number, width: number, height: number): Fit {
  let known = fits.get(story);
  if (known === undefined || known.width !== width || known.height !== height) {
    const fit = (state: number): Fit => {
      const points = pointsOf(story, posesAt(story, state));
      const [left, right] = spanOf(points.map(([x]) => x));
      const [low, high] = spanOf(points.map(([, y]) => y));
      const scale = Math.min(width / (right - left), height / (high - low)) / MARGIN;
      return { x: (left + right) / 2, y: (low + high) / 2, scale };
    };
    known = { width, height, of: [fit(0), fit(1), fit(LOOPS)] };
    fits.set(story, known);
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
