// A lap on a card: the true walls, the map over them, where the robot went and where it believes that it went.
//
// The build draws the gallery by it, the page the reader's own flat. One file serves both themes: a picture follows
// the colour scheme of what holds it.

import palette from '../../../crates/robots/robot_io/palette.json';

/** A table of the widget, as it exports it. */
export interface Csv {
  readonly id: string;
  readonly csv: string;
}

export type Facts = Readonly<Record<string, number | null | undefined>>;

type Point = readonly [number, number];

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
  const walls = rows(tables, 'walls').map(([x0 = 0, y0 = 0, x1 = 0, y1 = 0]) => [[x0, y0], [x1, y1]] as const);
  const map = rows(tables, 'map').map(([, x = 0, y = 0]): Point => [x, y]);
  const keyframes = rows(tables, 'keyframes');
  const truth = keyframes.map(([, , x = 0, y = 0]): Point => [x, y]);
  const estimate = keyframes.map(([, , , , x = 0, y = 0]): Point => [x, y]);
  const to = fit([...walls.flat(), ...map, ...truth, ...estimate]);
  const [here, believed] = [truth, estimate].map((path) => to(path.at(-1) ?? [0, 0])) as [Point, Point];
  const isFar = Math.hypot(here[0] - believed[0], here[1] - believed[1]) > FAR_PX;
  const { off, agrees } = numbers(facts);
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" width="${WIDTH}" height="${HEIGHT}">`,
    `<style>${style(0)}@media(prefers-color-scheme:dark){${style(1)}}path{fill:none}text{font:600 15px system-ui,sans-serif}</style>`,
    `<rect class="g" width="100%" height="100%"/>`,
    `<path class="w" stroke-width="3" d="${walls.map(([from, end]) => line([to(from), to(end)])).join('')}"/>`,
    `<path class="m" transform="scale(${cellPx})" d="${cells(map.map(to), cellPx)}"/>`,
    `<path class="t" stroke-width="1.5" stroke-dasharray="4 3" d="${line(truth.map(to))}"/>`,
    `<path class="p" stroke-width="2" stroke-linejoin="round" d="${line(estimate.map(to))}"/>`,
    isFar ? `<path class="b" stroke-width="2" stroke-dasharray="2 2" d="${line([here, believed])}"/>` : '',
    `<path class="t" stroke-width="2.5" d="M${pair([here[0] - 5, here[1]])}h10m-5-5v10"/>`,
    `<path class="p" stroke-width="7" d="M${pair([believed[0] - 3.5, believed[1]])}h7"/>`,
    `<text class="o" x="${MARGIN_PX}" y="${HEIGHT - 29}">${off}</text>`,
    `<text class="i" x="${MARGIN_PX}" y="${HEIGHT - 9}">${agrees}</text>`,
    '</svg>\n',
  ].join('');
}

function style(theme: 0 | 1): string {
  const { truth, measurement, posterior, bad, ink, faint, paper } = palette;
  const strokes = { w: faint, m: measurement, t: truth, p: posterior, b: bad };
  const fills = { o: bad, i: ink, g: paper };
  const rule = (what: string) => ([name, pair]: [string, string[]]): string => `.${name}{${what}:${pair[theme]}}`;
  return [...Object.entries(strokes).map(rule('stroke')), ...Object.entries(fills).map(rule('fill'))].join('');
}

/** The numbers of a table, row by row. */
function rows(tables: readonly Csv[], id: string): number[][] {
  const lines = tables.find((table) => table.id === id)?.csv.trim().split(/\r?\n/).slice(1) ?? [];
  return lines.map((cells) => cells.split(',').map(Number));
}

/** From metres to pixels, at one scale, the whole in the middle. */
function fit(points: readonly Point[]): (at: Point) => Point {
  const range = (axis: 0 | 1): Point => points.reduce<Point>(
    ([low, high], at) => [Math.min(low, at[axis]), Math.max(high, at[axis])],
    [Infinity, -Infinity],
  );
  const [[west, east], [south, north]] = [range(0), range(1)];
  const room = [WIDTH - 2 * MARGIN_PX, HEIGHT - WORDS_PX - 2 * MARGIN_PX] as const;
  const scale = Math.min(room[0] / Math.max(east - west, 1), room[1] / Math.max(north - south, 1));
  return ([x, y]) => [
    WIDTH / 2 + scale * (x - (west + east) / 2),
    (HEIGHT - WORDS_PX) / 2 - scale * (y - (south + north) / 2),
  ];
}

function line(points: readonly Point[]): string {
  return points.length === 0 ? '' : `M${points.map(pair).join(' ')}`;
}

function pair([x, y]: Point): string {
  return `${Number(x.toFixed(1))} ${Number(y.toFixed(1))}`;
}

/** Every cell that a point falls into, once, as runs of its row: a tenth of the file of circles. */
function cells(points: readonly Point[], cellPx: number): string {
  const byRow = new Map<number, Set<number>>();
  for (const [x, y] of points) {
    const [column, at] = [x, y].map((pixels) => Math.round(pixels / cellPx)) as [number, number];
    byRow.set(at, (byRow.get(at) ?? new Set()).add(column));
  }
  let path = '';
  for (const [y, row] of [...byRow].sort(([a], [b]) => a - b)) {
    const columns = [...row].sort((a, b) => a - b);
    for (let at = 0; at < columns.length;) {
      let end = at + 1;
      while (columns[end] === (columns[at] ?? 0) + end - at) end += 1;
      path += `M${columns[at]} ${y}h${end - at}`;
      at = end;
    }
  }
  return path;
}
