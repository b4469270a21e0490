// The picture that replaces the canvas, and the pixels of frames.

import { assetUrl } from './assets';
import type { Theme } from './theme';

interface Wish {
  resolve(picture: ImageBitmap): void;
  reject(reason: Error): void;
}

export class Pictures {
  readonly #image: HTMLImageElement;
  #wishes: Wish[] = [];

  constructor(image: HTMLImageElement) {
    this.#image = image;
  }

  /** The picture of the initial state from the build; a picture of the reader's state is better. */
  showStart(widget: string, theme: Theme): void {
    if (this.#image.src.startsWith('data:')) return;
    const drawn = assetUrl(`pictures/${widget}-${theme}.svg`);
    if (drawn !== undefined) this.#image.src = drawn;
  }

  /** The picture of the present state, drawn by the widget itself. */
  showDrawn(svg: string, alt: string): void {
    this.#image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
    this.#image.alt = alt;
  }

  /** Switches to another widget. */
  clear(alt: string): void {
    this.#image.removeAttribute('src');
    this.#image.alt = alt;
  }

  /** The pixels of the next frame. */
  nextFrame(): Promise<ImageBitmap> {
    return new Promise((resolve, reject) => this.#wishes.push({ resolve, reject }));
  }

  /** A canvas holds its pixels until the end of the task that drew them. */
  handOut(canvas: HTMLCanvasElement): void {
    for (const { resolve, reject } of this.#wishes.splice(0)) {
      createImageBitmap(canvas).then(resolve, reject);
    }
  }

  /** Rejects, because no frame will come. */
  refuse(reason: Error): void {
    for (const { reject } of this.#wishes.splice(0)) reject(reason);
  }
}
