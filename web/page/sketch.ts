// The small figures beside the text: a slider with a picture and a sentence that follow it. The build's picture, which
// shows the initial value, stays until the reader moves the slider.

import type { Glue } from '../pkg/glue.js';
import { themeOf, watchTheme } from '../ts/theme';

/** Widths of the picture, px: with panels side by side, and stacked. */
export const WIDTHS = { wide: 600, narrow: 360 } as const;
/** Screens with stacked panels, as in style/sketches.css and stills.mjs. */
export const NARROW = '(max-width: 40rem)';

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
  readonly #narrow = matchMedia(NARROW);
  #frame = 0;

  constructor(figure: HTMLElement, schema: SketchSchema, glue: Glue) {
    this.#figure = figure;
    this.#schema = schema;
    this.#glue = glue;
    const slider = this.#slider;
    slider.disabled = false;
    slider.addEventListener('input', () => this.#wake());
    this.#narrow.addEventListener('change', () => this.#wake());
    watchTheme(figure, () => this.#wake());
    // The build's picture follows the system's theme, and the browser may have restored another slider value.
    const isSystems = themeOf(figure) === (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
    if (!isSystems || Number(slider.value) !== schema.default) this.#wake();
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
    (figure.querySelector('.sketch-picture') as HTMLElement).innerHTML = svg;
  }
}
