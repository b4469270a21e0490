// A strip plot of laps by one of their errors.

import type { Lap } from './protocol';
import { spreadOf } from './spread';

/** The estimate of a strip: with the front end alone, or with loops. */
export type Kind = 'frontEnd' | 'withLoops';

/** The axis of a strip. */
export interface Axis {
  /** Its end; larger values are clamped to it. */
  end: number;
  /** After a value, with a leading space. */
  unit: string;
  /** At its start, middle and end. */
  labels: readonly string[];
}

/** Intervals between the lines of a strip. */
const INTERVALS = 4;
const HEIGHT_PX = 76;
/** Height of the bottom row for laps with false loops; the front end has no loops. */
const FALSE_ROW_PX = 18;
const DOT_PX = 2.6;
/** Margin for half a dot at both ends. */
const EDGE_PX = 6;
/** Colours by the number of closed loops, by their names in the style sheets. */
const INKS = ['--laps-none', '--laps-one', '--laps-two', '--laps-more'];

export interface StripHost {
  /** The reader points at a lap, or moves to it by keys. */
  onPoint(lap: Lap): void;
  /** The reader opens a lap. */
  onChoose(lap: Lap): void;
}

export class Strip {
  readonly element = document.createElement('canvas');
  readonly #kind: Kind;
  readonly #axis: Axis;
  readonly #measure: (lap: Lap) => number;
  readonly #host: StripHost;
  /** Sorted by error if `#isSorted`. */
  #laps: Lap[] = [];
  #isSorted = true;
  #selected: Lap | undefined;
  /** The reader's guess of the median. */
  guess: () => number | undefined = () => undefined;
  #frame = 0;

  constructor(kind: Kind, label: string, axis: Axis, measure: (lap: Lap) => number, host: StripHost) {
    this.#kind = kind;
    this.#axis = axis;
    this.#measure = measure;
    this.#host = host;
    const { element } = this;
    element.tabIndex = 0;
    element.setAttribute('role', 'slider');
    element.setAttribute('aria-label', `Laps at ${label}, ${nameOf(kind)}`);
    for (const [name, value] of [['min', '0'], ['now', '0'], ['text', 'no lap is chosen']]) {
      element.setAttribute(`aria-value${name}`, value ?? '');
    }
    element.addEventListener('pointermove', (event) => this.#point(event));
    element.addEventListener('click', (event) => {
      const lap = this.#point(event);
      if (lap !== undefined) this.#host.onChoose(lap);
    });
    element.addEventListener('keydown', (event) => this.#key(event));
    new ResizeObserver(() => this.draw()).observe(element);
  }

  add(lap: Lap): void {
    this.#laps.push(lap);
    this.#isSorted = false;
    this.draw();
  }

  /** The median of the laps so far. */
  get median(): number | undefined {
    return spreadOf(this.#laps.map(this.#measure))?.median;
  }

  /** Highlights the lap of a seed. */
  select(lap: Lap): void {
    this.#selected = this.#laps.find(({ seed }) => seed === lap.seed);
    const sorted = this.#sorted();
    const rank = this.#selected === undefined ? 0 : sorted.indexOf(this.#selected) + 1;
    this.element.setAttribute('aria-valuemax', String(sorted.length));
    this.element.setAttribute('aria-valuenow', String(rank));
    const value = this.#selected && this.#measure(this.#selected).toFixed(2);
    this.element.setAttribute('aria-valuetext', value === undefined ? 'no lap is chosen' : `seed ${lap.seed}: ${value}${this.#axis.unit}`);
    this.draw();
  }

  /** Draws in the next frame, because many laps may arrive at once. */
  draw(): void {
    if (this.#frame !== 0) return;
    this.#frame = requestAnimationFrame(() => {
      this.#frame = 0;
      this.#paint();
    });
  }

  #hasFalseLoop({ wrong }: Lap): boolean {
    return this.#kind === 'withLoops' && wrong > 0;
  }

  #paint(): void {
    const { element } = this;
    const width = element.clientWidth;
    const context = element.getContext('2d');
    if (width === 0 || context === null) return;
    element.width = Math.round(width * devicePixelRatio);
    element.height = Math.round(HEIGHT_PX * devicePixelRatio);
    context.scale(devicePixelRatio, devicePixelRatio);
    const style = getComputedStyle(element);
    const ink = (name: string): string => style.getPropertyValue(name).trim();
    const colors = INKS.map(ink);
    context.strokeStyle = ink('--faint');
    for (let at = 0; at <= INTERVALS; at += 1) line(context, this.#x((at / INTERVALS) * this.#axis.end, width), 0, HEIGHT_PX, 1);
    const isFalse = (lap: Lap): boolean => this.#hasFalseLoop(lap);
    if (this.#kind === 'withLoops') {
      context.beginPath();
      context.moveTo(0, HEIGHT_PX - FALSE_ROW_PX);
      context.lineTo(width, HEIGHT_PX - FALSE_ROW_PX);
      context.stroke();
    }
    for (const lap of this.#laps.filter((one) => !isFalse(one))) {
      context.fillStyle = colors[Math.min(lap.closed, 3)] ?? '';
      const [x, y] = this.#place(lap, width);
      context.fillRect(x - DOT_PX / 2, y - DOT_PX / 2, DOT_PX, DOT_PX);
    }
    context.strokeStyle = ink('--laps-false');
    const wrong = this.#laps.filter(isFalse);
    for (const lap of wrong) cross(context, this.#place(lap, width));
    element.dataset['false'] = String(wrong.length);
    this.#paintSpread(context, width, ink('--ink'));
    const guess = this.guess();
    if (guess !== undefined) {
      context.strokeStyle = ink('--focus');
      context.setLineDash([4, 4]);
      line(context, this.#x(guess, width), 0, HEIGHT_PX, 2);
      context.setLineDash([]);
    }
    if (this.#selected === undefined) return;
    const [x, y] = this.#place(this.#selected, width);
    context.strokeStyle = ink('--focus');
    context.lineWidth = 2.5;
    context.beginPath();
    context.arc(x, y, 7, 0, 7);
    context.stroke();
  }

  /** The median as a long line, the 5 % and 95 % quantiles as short ones. */
  #paintSpread(context: CanvasRenderingContext2D, width: number, ink: string): void {
    const spread = spreadOf(this.#laps.map(this.#measure));
    if (spread === undefined) return;
    context.strokeStyle = ink;
    line(context, this.#x(spread.median, width), 0, HEIGHT_PX, 2.5);
    for (const tail of [spread.p05, spread.p95]) {
      line(context, this.#x(tail, width), 0, 10, 1.5);
      line(context, this.#x(tail, width), HEIGHT_PX - 10, HEIGHT_PX, 1.5);
    }
    this.element.dataset['median'] = spread.median.toFixed(2);
    this.element.dataset['laps'] = String(this.#laps.length);
  }

  #x(value: number, width: number): number {
    return EDGE_PX + (Math.min(value, this.#axis.end) / this.#axis.end) * (width - 2 * EDGE_PX);
  }

  /** The golden ratio spreads consecutive seeds evenly over the height. */
  #place(lap: Lap, width: number): [number, number] {
    const share = (lap.seed * 0.6180339887) % 1;
    const x = this.#x(this.#measure(lap), width);
    const row = HEIGHT_PX - FALSE_ROW_PX;
    return this.#hasFalseLoop(lap) ? [x, row + 5 + share * (FALSE_ROW_PX - 10)] : [x, EDGE_PX + share * (row - 2 * EDGE_PX)];
  }

  #point({ offsetX, offsetY }: MouseEvent): Lap | undefined {
    const width = this.element.clientWidth;
    const distance = (lap: Lap): number => {
      const [x, y] = this.#place(lap, width);
      return Math.hypot(x - offsetX, y - offsetY);
    };
    const [first, ...rest] = this.#laps;
    if (first === undefined) return undefined;
    const nearest = rest.reduce((near, lap) => (distance(lap) < distance(near) ? lap : near), first);
    if (nearest !== this.#selected) this.#host.onPoint(nearest);
    return nearest;
  }

  #key(event: KeyboardEvent): void {
    const sorted = this.#sorted();
    const at = this.#selected === undefined ? -1 : sorted.indexOf(this.#selected);
    const goal = {
      ArrowRight: at + 1, ArrowUp: at + 1, ArrowLeft: at - 1, ArrowDown: at - 1,
      PageUp: at + 50, PageDown: at - 50, Home: 0, End: sorted.length - 1,
    }[event.key];
    if (goal !== undefined) {
      const lap = sorted[Math.min(Math.max(goal, 0), sorted.length - 1)];
      if (lap !== undefined) this.#host.onPoint(lap);
    } else if (event.key === 'Enter' && this.#selected !== undefined) {
      this.#host.onChoose(this.#selected);
    } else {
      return;
    }
    event.preventDefault();
  }

  #sorted(): Lap[] {
    if (!this.#isSorted) this.#laps.sort((a, b) => this.#measure(a) - this.#measure(b));
    this.#isSorted = true;
    return this.#laps;
  }
}

export function nameOf(kind: Kind): string {
  return kind === 'frontEnd' ? 'front end alone' : 'with loops';
}

function line(context: CanvasRenderingContext2D, x: number, from: number, to: number, width: number): void {
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(x, from);
  context.lineTo(x, to);
  context.stroke();
}

function cross(context: CanvasRenderingContext2D, [x, y]: readonly [number, number]): void {
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(x - 3, y - 3);
  context.lineTo(x + 3, y + 3);
  context.moveTo(x + 3, y - 3);
  context.lineTo(x - 3, y + 3);
  context.stroke();
}
