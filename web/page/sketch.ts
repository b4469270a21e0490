// The small figures beside the text: a slider, and a picture and a sentence that follow it.
//
// The picture drawn by the build stays until the reader moves something: it shows the slider's initial value.

import type { Glue } from '../pkg/glue.js';
import { themeOf, watchTheme } from '../ts/theme';

/** Widths at which the kit draws, px: panels beside each other, and above each other. */
export const WIDTHS = { wide: 600, narrow: 360 } as const;
/** Where panels stand above each other. The page's style and the pictures of the build know it, too. */
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

/** A value as the page says it: `0.12 m`, with the minus of the text. */
export function sayValue({ unit, decimals }: SketchSchema, value: number): string {
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
    // The pictures of the build follow the system's theme, and a browser may restore a slider's place.
    const isSystems = themeOf(figure) === (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
    if (!isSystems || Number(slider.value) !== schema.default) this.#wake();
  }

  get #slider(): HTMLInputElement {
    return this.#figure.querySelector<HTMLInputElement>('input') as HTMLInputElement;
  }

  /** One picture a frame, of the newest value. */
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
    const text = sayValue(this.#schema, value);
    this.#slider.setAttribute('aria-valuetext', text);
    (figure.querySelector('output') as HTMLElement).textContent = text;
    (figure.querySelector('.sketch-says') as HTMLElement).textContent = sentence;
    (figure.querySelector('.sketch-picture') as HTMLElement).innerHTML = svg;
  }
}
