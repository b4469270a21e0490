// A lap on a card: the true walls, the map over them, where the robot went and where it believes that it went.
//
// The build draws the gallery by it, the page the reader's own flat. One file serves both themes: a picture follows
// the colour scheme of what holds it.

import palette from '../../../crates/robots/robot_io/palette.json';
import { ground, map, path, robot, type Segment, type View, walls } from '../world/plan';
import type { Point, Pose } from '../world/surfaces';
import { declared, STYLED, SvgSurface } from '../world/svg';

/** A table of the widget, as it exports it. */
export interface Csv {
  readonly id: string;
  readonly csv: string;
}

export type Facts = Readonly<Record<string, number | null | undefined>>;

export const WIDTH = 320;
export const HEIGHT = 240;
/** The strip under the drawing that holds the words. */
const WORDS_PX = 46;
const MARGIN_PX = 8;
/** Side of a square of the map in a card of the build: small enough for a wall, large enough for a file of a few kB. */
const CELL_PX = 2;
/** A map whose passes are farther apart is seen to be doubled, cm. */
const AGREES_CM = 15;
/** The two ends are joined by a line from this distance on. */
const FAR_PX = 8;
/** How far the robot is off at its end, or on the way if that is more, m. */
export function metresOff({ graph_error_m: end, keyframe_rms_m: way }: Facts): number {
  return Math.max(way ?? 0, end ?? 0);
}

/** Whether the error is larger on the way than at its end. */
export function isOffOnTheWay({ graph_error_m: end, keyframe_rms_m: way }: Facts): boolean {
  return (way ?? 0) > (end ?? 0);
}

/** How far off the robot ends, or is on the way if that is more, and how well the map agrees with itself. */
export function numbers(facts: Facts): { off: string; agrees: string } {
  const { map_disagreement_m: apart } = facts;
  const isWay = isOffOnTheWay(facts);
  const off = metresOff(facts);
  return {
    off: `${isWay ? 'typically' : 'ends'} ${off.toFixed(off < 1 ? 2 : 1)} m off`,
    agrees: typeof apart === 'number' ? agreement(Math.round(100 * apart)) : '',
  };
}

/** Whether the two passes of the map agree, so that nobody who looks at it alone would notice an error. */
export function isUnnoticed({ map_disagreement_m: apart }: Facts): boolean {
  return typeof apart === 'number' && agrees(Math.round(100 * apart));
}

function agrees(cm: number): boolean {
  return cm <= AGREES_CM;
}

function agreement(cm: number): string {
  return agrees(cm) ? `map agrees to ${cm} cm` : `map disagrees by ${cm} cm`;
}

/** The card's picture as an SVG, its map in squares of that side. */
export function drawing(tables: readonly Csv[], facts: Facts, cellPx = CELL_PX): string {
  const segments = rows(tables, 'walls').map(([x0 = 0, y0 = 0, x1 = 0, y1 = 0]): Segment => [[x0, y0], [x1, y1]]);
  const points = rows(tables, 'map').map(([, x = 0, y = 0]): Point => [x, y]);
  const keyframes = rows(tables, 'keyframes');
  const truth = keyframes.map(([, , x = 0, y = 0]): Point => [x, y]);
  const estimate = keyframes.map(([, , , , x = 0, y = 0]): Point => [x, y]);
  const view = fit([...segments.flat(), ...points, ...truth, ...estimate]);
  const [here, believed] = [endOf(truth), endOf(estimate)];
  const ends = [here, believed].map(([x, y]) => view.to([x, y])) as [Point, Point];
  const isFar = Math.hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]) > FAR_PX;
  const surface = new SvgSurface(STYLED, cellPx);
  ground(surface, view, segments);
  walls(surface, view, segments);
  map(surface, view, points, 'map-old');
  surface.lines([truth.map(view.to)], 'truth', 1.5, { dash: [4, 3] });
  path(surface, view, estimate, 'posterior');
  if (isFar) surface.lines([ends], 'bad', 2, { dash: [2, 2] });
  robot(surface, view, here, 'truth', true);
  robot(surface, view, believed, 'posterior');
  const { off, agrees } = numbers(facts);
  const picture = [
    `<path fill="var(--paper)" d="M0 0H${WIDTH}V${HEIGHT}H0Z"/>${surface.text}`,
    `<text fill="var(--bad)" x="${MARGIN_PX}" y="${HEIGHT - 29}">${off}</text>`,
    `<text fill="var(--ink)" x="${MARGIN_PX}" y="${HEIGHT - 9}">${agrees}</text>`,
  ].join('');
  const [light, dark] = ([0, 1] as const).map((theme) => `:root{${declared(picture, palette, theme)}}`);
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" width="${WIDTH}" height="${HEIGHT}">`,
    `<style>${light}@media(prefers-color-scheme:dark){${dark}}text{font:600 15px system-ui,sans-serif}</style>${picture}</svg>\n`,
  ].join('');
}

/** The end of a path, with the heading of its last piece. */
function endOf(points: readonly Point[]): Pose {
  const [x, y] = points.at(-1) ?? [0, 0];
  const [fromX, fromY] = points.findLast((at) => Math.hypot(x - at[0], y - at[1]) > 0.05) ?? [x - 1, y];
  return [x, y, Math.atan2(y - fromY, x - fromX)];
}

/** The numbers of a table, row by row. */
function rows(tables: readonly Csv[], id: string): number[][] {
  const lines = tables.find((table) => table.id === id)?.csv.trim().split(/\r?\n/).slice(1) ?? [];
  return lines.map((cells) => cells.split(',').map(Number));
}

/** Shows all points at one scale, in the middle. */
function fit(points: readonly Point[]): View {
  const range = (axis: 0 | 1): Point => points.reduce<Point>(
    ([low, high], at) => [Math.min(low, at[axis]), Math.max(high, at[axis])],
    [Infinity, -Infinity],
  );
  const [[west, east], [south, north]] = [range(0), range(1)];
  const room = [WIDTH - 2 * MARGIN_PX, HEIGHT - WORDS_PX - 2 * MARGIN_PX] as const;
  const pxPerM = Math.min(room[0] / Math.max(east - west, 1), room[1] / Math.max(north - south, 1));
  const to = ([x, y]: Point): Point => [
    WIDTH / 2 + pxPerM * (x - (west + east) / 2),
    (HEIGHT - WORDS_PX) / 2 - pxPerM * (y - (south + north) / 2),
  ];
  return { to, pxPerM, isSmall: true };
}
