// The picture that replaces the canvas, and the pixels of frames.

import { assetUrl } from './assets';
import type { Theme } from './theme';

interface PendingSnapshot {
  resolve(picture: ImageBitmap): void;
  reject(reason: Error): void;
}

export class Pictures {
  readonly #image: HTMLImageElement;
  #pending: PendingSnapshot[] = [];

  constructor(image: HTMLImageElement) {
    this.#image = image;
  }

  /** Shows the build's picture of the initial state, unless there is one of the reader's state. */
  showStart(widget: string, theme: Theme): void {
    if (this.#image.src.startsWith('data:')) return;
    const drawn = assetUrl(`pictures/${widget}-${theme}.svg`);
    if (drawn !== undefined) this.#image.src = drawn;
  }

  /** Shows a picture of the present state, drawn by the widget. */
  showDrawn(svg: string, alt: string): void {
    this.#image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
    this.#image.alt = alt;
  }

  clear(alt: string): void {
    this.#image.removeAttribute('src');
    this.#image.alt = alt;
  }

  /** The pixels of the next frame. */
  nextFrame(): Promise<ImageBitmap> {
    return new Promise((resolve, reject) => this.#pending.push({ resolve, reject }));
  }

  /** Resolves pending snapshots. Has to run in the task that drew the frame: later the canvas is empty. */
  resolveSnapshots(canvas: HTMLCanvasElement): void {
    for (const { resolve, reject } of this.#pending.splice(0)) {
      createImageBitmap(canvas).then(resolve, reject);
    }
  }

  /** Rejects pending snapshots, because no frame will come. */
  rejectSnapshots(reason: Error): void {
    for (const { reject } of this.#pending.splice(0)) reject(reason);
  }
}
