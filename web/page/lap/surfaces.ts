// Drawing surfaces: a canvas in the page, an SVG in the build.

import type { Ink, Surface } from './drawing';
import type { Point } from './story';

export type Inks = Record<Ink, string>;

const FONT = 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", sans-serif';

/** A canvas in CSS pixels. */
export function canvasSurface(context: CanvasRenderingContext2D, inks: Inks): Surface {
  const trace = (points: readonly Point[]): void => {
    context.beginPath();
    for (const [x, y] of points) context.lineTo(x, y);
  };
  return {
    line(points, ink, width, { alpha = 1, dash = [] } = {}) {
      trace(points);
      context.globalAlpha = alpha;
      context.strokeStyle = inks[ink];
      context.lineWidth = width;
      context.lineJoin = 'round';
      context.lineCap = dash.length === 0 ? 'round' : 'butt';
      context.setLineDash(dash);
      context.stroke();
      context.globalAlpha = 1;
    },
    dots(points, ink, size, alpha = 1) {
      context.globalAlpha = alpha;
      context.fillStyle = inks[ink];
      for (const [x, y] of points) context.fillRect(x - size / 2, y - size / 2, size, size);
      context.globalAlpha = 1;
    },
    area(points, ink) {
      trace(points);
      context.fillStyle = inks[ink];
      context.fill();
    },
    words(text, at, ink, size) {
      context.font = `600 ${size}px ${FONT}`;
      context.textBaseline = 'middle';
      context.textAlign = 'center';
      // Keeps the text inside the canvas.
      const half = context.measureText(text).width / 2 + size / 3;
      const x = Math.min(Math.max(at[0], half), context.canvas.clientWidth - half);
      const y = Math.min(Math.max(at[1], size), context.canvas.clientHeight - size);
      context.lineWidth = size / 4;
      context.lineJoin = 'round';
      context.setLineDash([]);
      context.strokeStyle = inks.paper;
      context.strokeText(text, x, y);
      context.fillStyle = inkForWords(inks, ink);
      context.fillText(text, x, y);
    },
  };
}

/** Collects the elements of an SVG in `text`. */
export class SvgSurface implements Surface {
  readonly #inks: Inks;
  text = '';

  constructor(inks: Inks) {
    this.#inks = inks;
  }

  /** The complete SVG file. */
  file(width: number, height: number): string {
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}">${this.text}</svg>\n`;
  }

  line(points: readonly Point[], ink: Ink, width: number, { alpha = 1, dash = [] }: { alpha?: number; dash?: number[] } = {}): void {
    const dashes = dash.length === 0 ? ' stroke-linecap="round"' : ` stroke-dasharray="${dash.map(short).join(' ')}"`;
    const opacity = alpha === 1 ? '' : ` stroke-opacity="${alpha}"`;
    this.text += `<path d="${pathOf(points)}" fill="none" stroke="${this.#inks[ink]}" stroke-width="${short(width)}" stroke-linejoin="round"${dashes}${opacity}/>`;
  }

  /** One path of zero-length strokes, which is smaller than an element for each dot. */
  dots(points: readonly Point[], ink: Ink, size: number, alpha = 1): void {
    const opacity = alpha === 1 ? '' : ` stroke-opacity="${alpha}"`;
    const path = points.map(([x, y]) => `M${short(x)} ${short(y)}h0`).join('');
    this.text += `<path d="${path}" stroke="${this.#inks[ink]}" stroke-width="${short(size)}" stroke-linecap="square"${opacity}/>`;
  }

  area(points: readonly Point[], ink: Ink): void {
    this.text += `<path d="${pathOf(points)}Z" fill="${this.#inks[ink]}"/>`;
  }

  words(text: string, [x, y]: Point, ink: Ink, size: number): void {
    this.text += `<text x="${short(x)}" y="${short(y)}" font-family="${FONT.replaceAll('"', "'")}" font-size="${short(size)}" font-weight="600" text-anchor="middle" dominant-baseline="middle" fill="${inkForWords(this.#inks, ink)}" stroke="${this.#inks.paper}" stroke-width="${short(size / 4)}" stroke-linejoin="round" paint-order="stroke">${text}</text>`;
  }
}

/** Mixes a line colour with the text colour: text needs a contrast of 4.5, more than lines. */
function inkForWords(inks: Inks, ink: Ink): string {
  const channels = (color: string): number[] => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
  const text = channels(inks.ink);
  return `rgb(${channels(inks[ink]).map((channel, at) => Math.round(0.7 * channel + 0.3 * (text[at] ?? 0))).join(' ')})`;
}

/** Reads the colours of a figure from its style. */
export function readInks(figure: HTMLElement, names: readonly Ink[]): Inks {
  const style = getComputedStyle(figure);
  return Object.fromEntries(names.map((ink) => [ink, style.getPropertyValue(`--${ink}`).trim()])) as Inks;
}

/** Clears and sizes a canvas; returns its context in CSS pixels, or `undefined` while it has no width. */
export function contextOf(canvas: HTMLCanvasElement, height: number): CanvasRenderingContext2D | undefined {
  const width = canvas.clientWidth;
  const context = canvas.getContext('2d');
  if (width === 0 || context === null) return undefined;
  const [columns, rows] = [Math.round(width * devicePixelRatio), Math.round(height * devicePixelRatio)];
  if (canvas.width !== columns || canvas.height !== rows) Object.assign(canvas, { width: columns, height: rows });
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, columns, rows);
  context.scale(devicePixelRatio, devicePixelRatio);
  return context;
}

/** Calls back when the colours of the page change. */
export function watchColors(changed: () => void): void {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed);
  new MutationObserver(changed).observe(document.documentElement, { attributeFilter: ['data-theme'] });
}

function pathOf(points: readonly Point[]): string {
  return points.map(([x, y], at) => `${at === 0 ? 'M' : 'L'}${short(x)} ${short(y)}`).join('');
}

/** Tenths of a pixel: less is invisible. */
function short(value: number): string {
  return String(Math.round(value * 10) / 10);
}
