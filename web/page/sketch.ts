// The small figures beside the text: a slider with a picture and a sentence that follow it. The build's picture, which
// shows the initial value, stays until the reader moves the slider.

import type { Glue } from '../pkg/glue.js';
import { themeOf, watchTheme } from '../ts/theme';

/** Widths of the picture, px: with panels side by side, and stacked. */
export const WIDTHS = { wide: 600, narrow: 360 } as const;
/** Screens with stacked panels, as in style/sketches.css and stills.mjs. */
export const NARROW = '(max-width: 40rem)';

/** Distance from the handle at which a press takes it, px. */
const GRAB_PX = 26;
/** A place farther along the way costs so much of the distance along it, where the way passes twice. */
const LOYALTY = 0.15;

/** A value, and the position of the handle on the picture, px. */
type Place = [value: number, x: number, y: number];

export interface SketchSchema {
  name: string;
  title: string;
  label: string;
  unit: string;
  min: number;
  max: number;
  step: number;
  default: number;
  decimals: number;
}

export interface Drawn {
  svg: string;
  sentence: string;
}

/** A value with its unit, `0.12 m`, and a typographic minus. */
export function formatValue({ unit, decimals }: SketchSchema, value: number): string {
  return `${value.toFixed(decimals).replace('-', '−')}${unit}`;
}

export class SketchFigure {
  readonly #figure: HTMLElement;
  readonly #schema: SketchSchema;
  readonly #glue: Glue;
  readonly #ring = document.createElement('span');
  readonly #narrow = matchMedia(NARROW);
  #frame = 0;
  /** The places of the handle on the picture, by the width of the picture. */
  readonly #ways = new Map<number, Place[]>();
  /** The pointer that drags the handle. */
  #pointer: number | undefined;

  constructor(figure: HTMLElement, schema: SketchSchema, glue: Glue) {
    this.#figure = figure;
    this.#schema = schema;
    this.#glue = glue;
    const slider = this.#slider;
    slider.disabled = false;
    slider.addEventListener('input', () => {
      figure.classList.add('touched');
      this.#wake();
    });
    this.#narrow.addEventListener('change', () => this.#wake());
    watchTheme(figure, () => this.#wake());
    // The build's picture follows the system's theme, and the browser may have restored another slider value.
    const isSystems = themeOf(figure) === (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
    if (!isSystems || Number(slider.value) !== schema.default) this.#wake();
    this.#ring.className = 'sketch-handle';
    this.#picture.append(this.#ring);
    this.#placeRing();
    this.#narrow.addEventListener('change', () => this.#placeRing());
    this.#listenToPointer();
  }

  /** A drag on the picture: the handle goes to its place nearest to the pointer. */
  #listenToPointer(): void {
    const picture = this.#picture;
    picture.addEventListener('pointerdown', (event) => {
      if (event.button !== 0 || !this.#isOnHandle(event)) return;
      event.preventDefault();
      this.#pointer = event.pointerId;
      picture.setPointerCapture(event.pointerId);
      this.#figure.classList.add('touched', 'held');
    });
    picture.addEventListener('touchstart', (event) => {
      const [touch] = event.changedTouches;
      if (touch !== undefined && this.#isOnHandle(touch)) event.preventDefault();
    }, { passive: false });
    picture.addEventListener('pointermove', (event) => {
      if (event.pointerId === this.#pointer) this.#dragTo(event);
    });
    for (const type of ['pointerup', 'pointercancel'] as const) {
      picture.addEventListener(type, (event) => {
        if (event.pointerId !== this.#pointer) return;
        this.#pointer = undefined;
        this.#figure.classList.remove('held');
      });
    }
  }

  #dragTo(event: PointerEvent): void {
    const at = this.#onPicture(event);
    const value = Number(this.#slider.value);
    const { min, max } = this.#schema;
    const way = this.#way;
    const length = way.reduce((sum, [, x, y], k) => sum + Math.hypot(x - (way[k - 1]?.[1] ?? x), y - (way[k - 1]?.[2] ?? y)), 0);
    // Where the way passes twice, it goes on where it is.
    const slack = (LOYALTY * length) / (max - min);
    const cost = ([to, x, y]: Place): number => Math.hypot(x - at[0], y - at[1]) + slack * Math.abs(to - value);
    const [nearest] = [...way].sort((a, b) => cost(a) - cost(b));
    if (nearest === undefined || nearest[0] === value) return;
    this.#slider.value = String(nearest[0]);
    this.#slider.dispatchEvent(new Event('input', { bubbles: true }));
  }

  #isOnHandle(at: { clientX: number; clientY: number }): boolean {
    const [x, y] = this.#onPicture(at);
    const [, atX, atY] = this.#place;
    return Math.hypot(x - atX, y - atY) <= GRAB_PX;
  }

  /** The pointer in the units of the picture. */
  #onPicture({ clientX, clientY }: { clientX: number; clientY: number }): [number, number] {
    const { left, top, width } = this.#picture.getBoundingClientRect();
    const scale = this.#width / width;
    return [(clientX - left) * scale, (clientY - top) * scale];
  }

  get #width(): number {
    return this.#narrow.matches ? WIDTHS.narrow : WIDTHS.wide;
  }

  get #way(): Place[] {
    const width = this.#width;
    const known = this.#ways.get(width);
    if (known !== undefined) return known;
    const way = JSON.parse(this.#glue.sketchWay(this.#schema.name, width)) as Place[];
    this.#ways.set(width, way);
    return way;
  }

  /** The place of the handle now. */
  get #place(): Place {
    const value = Number(this.#slider.value);
    const off = ([to]: Place): number => Math.abs(to - value);
    return this.#way.reduce((best, place) => (off(place) < off(best) ? place : best));
  }

  #placeRing(): void {
    const [, x, y] = this.#place;
    const width = this.#width;
    const { viewBox } = this.#picture.querySelector('svg') ?? {};
    const height = viewBox?.baseVal.height ?? (width * this.#picture.clientHeight) / Math.max(this.#picture.clientWidth, 1);
    this.#ring.style.left = `${(100 * x) / width}%`;
    this.#ring.style.top = `${(100 * y) / height}%`;
  }

  get #picture(): HTMLElement {
    return this.#figure.querySelector('.sketch-picture') as HTMLElement;
  }

  get #slider(): HTMLInputElement {
    return this.#figure.querySelector<HTMLInputElement>('input') as HTMLInputElement;
  }

  /** Draws at most once a frame. */
  #wake(): void {
    if (this.#frame === 0) this.#frame = requestAnimationFrame(() => this.#draw());
  }

  #draw(): void {
    this.#frame = 0;
    const figure = this.#figure;
    const value = Number(this.#slider.value);
    const width = this.#narrow.matches ? WIDTHS.narrow : WIDTHS.wide;
    const drawn = this.#glue.drawSketch(this.#schema.name, value, width, themeOf(figure));
    const { svg, sentence } = JSON.parse(drawn) as Drawn;
    const text = formatValue(this.#schema, value);
    this.#slider.setAttribute('aria-valuetext', text);
    (figure.querySelector('output') as HTMLElement).textContent = text;
    (figure.querySelector('.sketch-says') as HTMLElement).textContent = sentence;
    this.#picture.innerHTML = svg;
    this.#picture.append(this.#ring);
    this.#placeRing();
  }
}
