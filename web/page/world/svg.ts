// The surface of the still pictures, and of those that a style sheet colours.

import type { View } from './plan';
import { FONT, type Ink, type Inks, type Point, type Stroke, type Surface, TAB, inkForWords } from './surfaces';

/** Opacity of a cell of a map with at least that many returns. */
const MIST: readonly [number, number][] = [[1, 0.35], [2, 0.6], [4, 0.9]];

/** Colours that the style sheet around an SVG decides. */
export const STYLED = new Proxy({} as Inks, { get: (_, ink) => `var(--${String(ink)})` });

/** The properties that declare the colours of such an SVG in the theme 0, light, or 1, dark. */
export function declared(svg: string, palette: Readonly<Record<string, readonly string[]>>, theme: 0 | 1): string {
  const used = new Set([...svg.matchAll(/var\(--([a-z0-9-]+)\)/g)].map(([, ink = '']) => ink));
  return [...used].map((ink) => `--${ink}:${palette[ink]?.[theme]}`).join(';');
}

/** Pixels a metre of {@link inMetres}, as on a phone: nothing is smaller on a screen. */
const PX_PER_M = 50;
/** What {@link inMetres} draws: its metres point up in the groups around it. */
export const METRES: View = { to: ([x, y]) => [PX_PER_M * x, PX_PER_M * y], pxPerM: PX_PER_M, isSmall: false };

/** A part of an SVG in metres, in the colours of the style sheet. */
export function inMetres(draw: (surface: SvgSurface) => void): string {
  const surface = new SvgSurface(STYLED);
  draw(surface);
  return `<g transform="scale(${1 / PX_PER_M})">${surface.text}</g>`;
}

/** Collects the elements of an SVG in `text`. */
export class SvgSurface implements Surface {
  readonly #inks: Inks;
  /** Side of a cell of a map: small enough for a wall, large enough for a small file. */
  readonly #cellPx: number;
  #fills = 0;
  text = '';

  constructor(inks: Inks, cellPx = 2) {
    this.#inks = inks;
    this.#cellPx = cellPx;
  }

  /** The complete SVG file. */
  file(width: number, height: number): string {
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}">${this.text}</svg>\n`;
  }

  lines(lines: readonly (readonly Point[])[], ink: Ink, width: number, { alpha = 1, dash = [], isSquare = false }: Stroke = {}): void {
    const cap = isSquare ? ' stroke-linecap="square"' : dash.length === 0 ? ' stroke-linecap="round"' : ` stroke-dasharray="${dash.map(short).join(' ')}"`;
    this.text += `<path d="${lines.map(pathOf).join('')}" fill="none" stroke="${this.#inks[ink]}" stroke-width="${short(width)}" stroke-linejoin="round"${cap}${opacity('stroke', alpha)}/>`;
  }

  area(points: readonly Point[], ink: Ink, alpha = 1): void {
    this.text += `<path d="${pathOf(points)}Z" fill="${this.#inks[ink]}"${opacity('fill', alpha)}/>`;
  }

  fan(center: Point, rim: readonly Point[], ink: Ink, alphas: readonly [number, number], radius: number): void {
    const [cx, cy] = center.map(short);
    const fill = this.#gradient(`radialGradient`, `cx="${cx}" cy="${cy}" r="${short(radius)}"`, ink, alphas);
    this.text += `<path d="${pathOf([center, ...rim])}Z" fill="${fill}"/>`;
  }

  discs(points: readonly Point[], ink: Ink, radius: number): void {
    const path = points.map(([x, y]) => `M${short(x)} ${short(y)}h0`).join('');
    this.text += `<path d="${path}" fill="none" stroke="${this.#inks[ink]}" stroke-width="${short(2 * radius)}" stroke-linecap="round"/>`;
  }

  /** Every cell that a point falls into, once, as runs of its row: a tenth of the file of circles. */
  mist(points: readonly Point[], ink: Ink, _side: number, alpha = 1): void {
    const side = this.#cellPx;
    const counts = new Map<string, number>();
    for (const at of points) {
      const cell = at.map((pixels) => Math.round(pixels / side)).reverse().join();
      counts.set(cell, (counts.get(cell) ?? 0) + 1);
    }
    MIST.forEach(([least, share], level) => {
      const [below] = MIST[level + 1] ?? [Infinity];
      const cells = [...counts].filter(([, count]) => count >= least && count < below).map(([cell]) => cell.split(',').map(Number) as [number, number]);
      if (cells.length > 0) this.text += `<path transform="scale(${side})" d="${runs(cells)}" fill="none" stroke-width="1.5" stroke-linecap="round" stroke="${this.#inks[ink]}"${opacity('stroke', share * alpha)}/>`;
    });
  }

  fade([width, height]: Point, [aside, above]: Point): void {
    const sides = [[0, 0, 0, above], [0, height, 0, height - above], [0, 0, aside, 0], [width, 0, width - aside, 0]];
    for (const side of sides) {
      const [x1, y1, x2, y2] = side.map(short);
      const fill = this.#gradient('linearGradient', `x1="${x1}" y1="${y1}" x2="${x2}" y2="${y2}"`, 'paper', [1, 0]);
      this.text += `<path d="M0 0H${width}V${height}H0Z" fill="${fill}"/>`;
    }
  }

  words(text: string, [x, y]: Point, ink: Ink, size: number): void {
    // A letter is about half as wide as high.
    const [half, high] = [0.3 * size * text.length + TAB.px, 0.62 * size + TAB.px / 2];
    this.text += `<rect x="${short(x - half)}" y="${short(y - high)}" width="${short(2 * half)}" height="${short(2 * high)}" rx="${TAB.px}" fill="${this.#inks.floor}" fill-opacity="${TAB.alpha}"/>`
      + `<text x="${short(x)}" y="${short(y)}" font-family="${FONT.replaceAll('"', "'")}" font-size="${short(size)}" font-weight="600" text-anchor="middle" dominant-baseline="central" fill="${inkForWords(this.#inks, ink)}">${text}</text>`;
  }

  #gradient(kind: string, place: string, ink: Ink, alphas: readonly [number, number]): string {
    this.#fills += 1;
    const stops = alphas.map((alpha, at) => `<stop offset="${at}" stop-color="${this.#inks[ink]}" stop-opacity="${alpha}"/>`);
    this.text += `<${kind} id="fill-${this.#fills}" gradientUnits="userSpaceOnUse" ${place}>${stops.join('')}</${kind}>`;
    return `url(#fill-${this.#fills})`;
  }
}

/** Cells as runs of their rows, each from the end of the one before. */
function runs(cells: readonly [row: number, column: number][]): string {
  const sorted = [...cells].sort(([a, b], [c, d]) => a - c || b - d);
  let path = '';
  let end: readonly [number, number] = [0, 0];
  for (let at = 0; at < sorted.length;) {
    const [row, column] = sorted[at] ?? [0, 0];
    let length = 1;
    while (sorted[at + length]?.[0] === row && sorted[at + length]?.[1] === column + length) length += 1;
    path += `m${column - end[1]} ${row - end[0]}h${length - 1}`;
    end = [row, column + length - 1];
    at += length;
  }
  return path;
}

function opacity(what: string, alpha: number): string {
  return alpha === 1 ? '' : ` ${what}-opacity="${Number(alpha.toFixed(2))}"`;
}

function pathOf(points: readonly Point[]): string {
  return points.map(([x, y], at) => `${at === 0 ? 'M' : 'L'}${short(x)} ${short(y)}`).join('');
}

/** Tenths of a pixel: less is invisible. */
function short(value: number): string {
  return String(Math.round(value * 10) / 10);
}
