// The appearance of a widget on its page: light or dark, animated or still, focus, print.

import type { Widget } from '../pkg/glue.js';
import type { Box } from './box';
import { listen, reveal } from './dom';
import type { Lifecycle } from './lifecycle';
import type { Parts } from './parts';
import { Pinned } from './pinned';
import type { Pictures } from './pictures';
import { themeOf, watchTheme, type Theme } from './theme';

const reducedMotion = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)');
/** Smallest width of a picture. */
const NARROWEST_PX = 320;

/** The element, as far as its appearance is concerned. */
export interface AppearanceHost extends HTMLElement {
  readonly summary: string;
  controlBox(id: string): Box | null;
  sceneBox(): Box | null;
}

export class Appearance {
  readonly #host: AppearanceHost;
  readonly #parts: Parts;
  readonly #lifecycle: Lifecycle;
  readonly #pictures: Pictures;
  readonly #pinned: Pinned;
  /** The widget whose picture replaces it while it rests. */
  #widget: string | undefined;

  constructor(host: AppearanceHost, parts: Parts, lifecycle: Lifecycle, pictures: Pictures) {
    this.#host = host;
    this.#parts = parts;
    this.#lifecycle = lifecycle;
    this.#pictures = pictures;
    this.#pinned = new Pinned(parts, {
      sceneBox: () => host.sceneBox() ?? undefined,
      wake: () => lifecycle.wake(),
    });
  }

  /** Follows the page until one of the returned functions is called. */
  watch(): (() => void)[] {
    const ends = [
      watchTheme(this.#host, () => this.showTheme()),
      listen(window, 'beforeprint', () => {
        // Paper shows every picture, also one that was not near the screen.
        this.#parts.picture.loading = 'eager';
        this.drawPicture('light');
      }),
      this.#pinned.watch(),
    ];
    if (reducedMotion === undefined) return ends;
    return [...ends, listen(reducedMotion, 'change', () => this.#lifecycle.ask(showMotion))];
  }

  /** Switches to another widget. */
  become(widget: string): void {
    this.#widget = widget;
    this.showTheme();
  }

  /** Sets the appearance in a new instance. */
  prepare(widget: Widget): void {
    widget.setTheme(themeOf(this.#host));
    showMotion(widget);
  }

  showTheme(): void {
    const theme = themeOf(this.#host);
    this.#parts.frame.classList.toggle('dark', theme === 'dark');
    this.#lifecycle.ask((widget) => widget.setTheme(theme));
    this.#lifecycle.wake();
    if (!this.#lifecycle.hasInstance && this.#widget !== undefined) this.#pictures.showStart(this.#widget, theme);
  }

  showFocus(id: string | undefined): void {
    this.#lifecycle.ask((widget) => widget.setFocus(id));
    this.#lifecycle.wake();
    const box = id === undefined ? null : this.#host.controlBox(id);
    const { stage, bar } = this.#parts;
    // The ring is on the canvas, not at the position of the focus.
    if (box !== null) reveal(stage, box, bar.offsetHeight);
  }

  /** A frame was drawn; the canvas holds it until the end of this task. */
  drew(canvas: HTMLCanvasElement): void {
    this.#pinned.drew(canvas);
  }

  /** The picture of the current state, drawn by the widget itself. */
  drawPicture(theme: Theme = themeOf(this.#host)): void {
    const width = Math.max(this.#host.clientWidth, NARROWEST_PX);
    const svg = this.#lifecycle.ask((widget) => widget.picture(width, theme));
    if (svg !== undefined) this.#pictures.showDrawn(svg, this.#host.summary);
  }
}

function showMotion(widget: Widget): void {
  widget.setReducedMotion(reducedMotion?.matches === true);
}
