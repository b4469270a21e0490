// What the plans of the page are painted on: here a canvas, in `svg.ts` an SVG. Positions and widths are in pixels from the
// upper left corner.

/** `[x, y, θ]` in the world frame, metres and radians. */
export type Pose = readonly [number, number, number];
/** `[x, y]` in metres, or in pixels. */
export type Point = readonly [number, number];

/** Colours by their names in the style sheets. */
const INKS = [
  'paper', 'floor', 'shade', 'shade-far', 'wall', 'wall-edge', 'ink', 'truth', 'prediction', 'posterior', 'measurement',
  'map-old', 'map-new', 'accent', 'bad', 'thread-1', 'thread-2', 'thread-3', 'thread-4', 'thread-5',
] as const;
export type Ink = (typeof INKS)[number];
export type Inks = Record<Ink, string>;

export interface Stroke {
  alpha?: number;
  dash?: readonly number[];
  /** Ends that reach half the width beyond, square and not round. */
  isSquare?: boolean;
}

export interface Surface {
  /** Lines of one kind: where they cross, their opacity does not add up. */
  lines(lines: readonly (readonly Point[])[], ink: Ink, width: number, stroke?: Stroke): void;
  area(points: readonly Point[], ink: Ink, alpha?: number): void;
  /** An area seen from a point, which fades from one opacity to another at the radius. */
  fan(center: Point, rim: readonly Point[], ink: Ink, alphas: readonly [number, number], radius: number): void;
  discs(points: readonly Point[], ink: Ink, radius: number): void;
  /** A map in cells of that side: its ink gathers where many points lie. */
  mist(points: readonly Point[], ink: Ink, side: number, alpha?: number): void;
  /** Lets the picture end in the page, within that many pixels of its sides and of its top and bottom. */
  fade(size: Point, within: Point): void;
  /** Text centred at a point, on a tab in the colour of the floor. */
  words(text: string, at: Point, ink: Ink, size: number): void;
}

export const FONT = '"Public Sans", system-ui, "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", sans-serif';
/** The tab under words: its opacity, and its padding and radius. */
export const TAB = { alpha: 0.94, px: 6 };
/** Opacity of a map where `n` returns lie: `most (1 − exp(−(n / full)^power))`, so that one alone is a breath. */
const MIST = { most: 0.92, full: 2, power: 1.7 };

/** A canvas in CSS pixels. */
export function canvasSurface(context: CanvasRenderingContext2D, inks: Inks): Surface {
  const trace = (points: readonly Point[]): void => {
    for (const [at, [x, y]] of points.entries()) {
      if (at === 0) context.moveTo(x, y);
      else context.lineTo(x, y);
    }
  };
  const fill = (style: string | CanvasGradient, alpha = 1): void => {
    context.globalAlpha = alpha;
    context.fillStyle = style;
    context.fill();
    context.globalAlpha = 1;
  };
  return {
    lines(lines, ink, width, { alpha = 1, dash = [], isSquare = false } = {}) {
      context.beginPath();
      for (const line of lines) trace(line);
      context.globalAlpha = alpha;
      context.strokeStyle = inks[ink];
      context.lineWidth = width;
      context.lineJoin = 'round';
      context.lineCap = isSquare ? 'square' : dash.length === 0 ? 'round' : 'butt';
      context.setLineDash([...dash]);
      context.stroke();
      context.globalAlpha = 1;
    },
    area(points, ink, alpha) {
      context.beginPath();
      trace(points);
      fill(inks[ink], alpha);
    },
    fan(center, rim, ink, [inner, outer], radius) {
      const gradient = context.createRadialGradient(...center, 0, ...center, radius);
      gradient.addColorStop(0, withAlpha(inks[ink], inner));
      gradient.addColorStop(1, withAlpha(inks[ink], outer));
      context.beginPath();
      trace([center, ...rim]);
      fill(gradient);
    },
    discs(points, ink, radius) {
      context.beginPath();
      for (const [x, y] of points) {
        context.moveTo(x + radius, y);
        context.arc(x, y, radius, 0, 2 * Math.PI);
      }
      fill(inks[ink]);
    },
    mist(points, ink, side, alpha = 1) {
      const { clientWidth: width, clientHeight: height } = context.canvas;
      const [columns, rows] = [Math.ceil(width / side), Math.ceil(height / side)];
      const image = new ImageData(columns, rows);
      const pixels = new Uint32Array(image.data.buffer);
      const [red = 0, green = 0, blue = 0] = channels(inks[ink]);
      gathered(points, side, columns, rows).forEach((count, at) => {
        if (count === 0) return;
        const share = MIST.most * (1 - Math.exp(-((count / MIST.full) ** MIST.power)));
        pixels[at] = (Math.round(255 * share) << 24) | (blue << 16) | (green << 8) | red;
      });
      cells ??= document.createElement('canvas');
      Object.assign(cells, { width: columns, height: rows });
      cells.getContext('2d')?.putImageData(image, 0, 0);
      context.globalAlpha = alpha;
      context.drawImage(cells, 0, 0, columns * side, rows * side);
      context.globalAlpha = 1;
    },
    fade([width, height], [aside, above]) {
      const side = (from: Point, to: Point, [left, top, wide, high]: readonly [number, number, number, number]): void => {
        const gradient = context.createLinearGradient(...from, ...to);
        gradient.addColorStop(0, inks.paper);
        gradient.addColorStop(1, withAlpha(inks.paper, 0));
        context.fillStyle = gradient;
        context.fillRect(left, top, wide, high);
      };
      // A canvas may be larger by a part of a pixel.
      side([0, 0], [0, above], [0, 0, width + 1, above]);
      side([0, height], [0, height - above], [0, height - above, width + 1, above + 1]);
      side([0, 0], [aside, 0], [0, 0, aside, height + 1]);
      side([width, 0], [width - aside, 0], [width - aside, 0, aside + 1, height + 1]);
    },
    words(text, at, ink, size) {
      context.font = `600 ${size}px ${FONT}`;
      context.textBaseline = 'middle';
      context.textAlign = 'center';
      const { px, alpha } = TAB;
      const [half, high] = [context.measureText(text).width / 2 + px, 0.62 * size + px / 2];
      // Keeps the text inside the canvas.
      const x = Math.min(Math.max(at[0], half), context.canvas.clientWidth - half);
      const y = Math.min(Math.max(at[1], high), context.canvas.clientHeight - high);
      context.beginPath();
      context.roundRect(x - half, y - high, 2 * half, 2 * high, px);
      fill(inks.floor, alpha);
      context.fillStyle = inkForWords(inks, ink);
      context.fillText(text, x, y + 0.04 * size);
    },
  };
}

/** The cells of a map, which one drawing smooths. */
let cells: HTMLCanvasElement | undefined;

/** The number of points near each cell, weighed by a bell of the width of a cell. */
function gathered(points: readonly Point[], side: number, columns: number, rows: number): Float32Array {
  const counts = new Float32Array(columns * rows);
  const bell = (offset: number): number => Math.exp(-0.5 * offset * offset);
  for (const [x, y] of points) {
    const [across, down] = [x / side - 0.5, y / side - 0.5];
    const [column, row] = [Math.round(across), Math.round(down)];
    if (column < 1 || row < 1 || column >= columns - 1 || row >= rows - 1) continue;
    const weights = [-1, 0, 1].map((by) => bell(column + by - across));
    for (const below of [-1, 0, 1]) {
      const weight = bell(row + below - down);
      const first = (row + below) * columns + column - 1;
      for (const [k, share] of weights.entries()) counts[first + k] = (counts[first + k] ?? 0) + share * weight;
    }
  }
  return counts;
}

function withAlpha(color: string, alpha: number): string {
  return color + Math.round(255 * alpha).toString(16).padStart(2, '0');
}

function channels(color: string): number[] {
  return [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
}

/** Mixes a line colour with the text colour: text needs a contrast of 4.5, more than lines. */
export function inkForWords(inks: Inks, ink: Ink): string {
  const text = channels(inks.ink);
  return `rgb(${channels(inks[ink]).map((channel, at) => Math.round(0.7 * channel + 0.3 * (text[at] ?? 0))).join(' ')})`;
}

/** Reads the colours of a figure from its style. */
export function readInks(figure: HTMLElement): Inks {
  const style = getComputedStyle(figure);
  return Object.fromEntries(INKS.map((ink) => [ink, style.getPropertyValue(`--${ink}`).trim()])) as Inks;
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
