// A narrow screen has no room for both the picture and a slider far below it. While the reader moves such a control, a
// copy of the picture is pinned to the top of the screen.

import type { Box } from './box';
import { create } from './dom';

const NARROW = '(width < 1100px)';
/** Above this visible share of the picture no copy is needed. */
const SEEN_SHARE = 0.6;
/** Maximum height of the copy as a share of the screen; the rest is for the controls. */
const MAX_HEIGHT_SHARE = 0.45;
/** Space for the title above the scene and for the axis below it. */
const ABOVE_PX = 54;
const BELOW_PX = 34;

export interface PinnedHost {
  /** The part of the canvas with the picture; undefined before it is drawn. */
  sceneBox(): Box | undefined;
  /** Requests a frame. */
  wake(): void;
}

export class PinnedPicture {
  readonly #stage: HTMLElement;
  readonly #bar: HTMLElement;
  readonly #host: PinnedHost;
  readonly #frame: HTMLElement;
  #copy: HTMLCanvasElement | undefined;
  #isMoved = false;

  constructor({ frame, stage, bar }: { frame: HTMLElement; stage: HTMLElement; bar: HTMLElement }, host: PinnedHost) {
    this.#frame = frame;
    this.#stage = stage;
    this.#bar = bar;
    this.#host = host;
    bar.addEventListener('pointerdown', () => this.#set(true), { passive: true });
    bar.addEventListener('focusin', () => { if (this.#holdsControl()) this.#set(true); });
    bar.addEventListener('focusout', () => this.#set(false));
  }

  /** Adds listeners to the window; returns a function that removes them. */
  watch(): () => void {
    const end = (): void => this.#set(this.#holdsControl());
    const moves = ['pointerup', 'pointercancel', 'blur'];
    for (const type of moves) window.addEventListener(type, end, { passive: true });
    const follow = (): void => this.#host.wake();
    window.addEventListener('scroll', follow, { passive: true });
    return () => {
      for (const type of moves) window.removeEventListener(type, end);
      window.removeEventListener('scroll', follow);
      this.#set(false);
    };
  }

  /** Copies a frame that was just drawn. */
  drew(canvas: HTMLCanvasElement): void {
    const box = this.#isMoved && matchMedia(NARROW).matches ? this.#host.sceneBox() : undefined;
    if (box === undefined || this.#isSeen(canvas, box)) {
      this.#hide();
      return;
    }
    this.#show(canvas, box);
  }

  #set(isMoved: boolean): void {
    if (this.#isMoved === isMoved) return;
    this.#isMoved = isMoved;
    if (!isMoved) this.#hide();
    this.#host.wake();
  }

  #hide(): void {
    this.#copy?.remove();
    this.#copy = undefined;
  }

  /** Whether the keyboard is on a control; a press leaves the focus there, but ends with the release. */
  #holdsControl(): boolean {
    return this.#bar.querySelector('.control :focus-visible') !== null;
  }

  #isSeen(canvas: HTMLCanvasElement, [, top, , height]: Box): boolean {
    const above = canvas.getBoundingClientRect().top + top;
    const seen = Math.min(above + height, window.innerHeight) - Math.max(above, 0);
    return seen >= SEEN_SHARE * height;
  }

  #show(canvas: HTMLCanvasElement, [, top, , height]: Box): void {
    const { left, width } = this.#stage.getBoundingClientRect();
    const from = Math.max(top - ABOVE_PX, 0);
    const tall = Math.min(top + height + BELOW_PX, canvas.clientHeight) - from;
    const scale = Math.min(1, (MAX_HEIGHT_SHARE * window.innerHeight) / tall);
    const ratio = canvas.width / canvas.clientWidth;
    this.#copy ??= create('canvas', { class: 'pinned', 'aria-hidden': 'true' });
    const copy = this.#copy;
    if (!copy.isConnected) this.#frame.append(copy);
    Object.assign(copy.style, {
      left: `${left + ((1 - scale) * width) / 2}px`,
      width: `${scale * width}px`,
      height: `${scale * tall}px`,
    });
    copy.width = Math.round(canvas.width);
    copy.height = Math.round(tall * ratio);
    copy.getContext('2d')?.drawImage(canvas, 0, from * ratio, canvas.width, tall * ratio, 0, 0, copy.width, copy.height);
  }
}
