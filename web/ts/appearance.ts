// How a widget follows its page: theme, size of the text, reduced motion, print.

import type { Widget } from '../pkg/glue.js';
import type { Box } from './box';
import { listen } from './dom';
import type { Lifecycle } from './lifecycle';
import type { Parts } from './parts';
import { PinnedPicture } from './pinned';
import type { Pictures } from './pictures';
import { themeOf, watchTheme, type Theme } from './theme';

const reducedMotion = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)');
/** Minimum width of a picture. */
const MIN_WIDTH_PX = 320;

export interface AppearanceHost extends HTMLElement {
  readonly summary: string;
  sceneBox(): Box | null;
}

export class Appearance {
  readonly #host: AppearanceHost;
  readonly #parts: Parts;
  readonly #lifecycle: Lifecycle;
  readonly #pictures: Pictures;
  readonly #pinnedPicture: PinnedPicture;
  /** The widget whose picture is shown before its first start. */
  #widget: string | undefined;

  constructor(host: AppearanceHost, parts: Parts, lifecycle: Lifecycle, pictures: Pictures) {
    this.#host = host;
    this.#parts = parts;
    this.#lifecycle = lifecycle;
    this.#pictures = pictures;
    this.#pinnedPicture = new PinnedPicture(parts, {
      sceneBox: () => host.sceneBox() ?? undefined,
      wake: () => lifecycle.wake(),
    });
  }

  /** Adds listeners to the page; returns the functions that remove them. */
  watch(): (() => void)[] {
    const ends = [
      watchTheme(this.#host, () => this.showTheme()),
      listen(window, 'beforeprint', () => {
        // Lazy loading leaves pictures blank in print that were never near the viewport.
        this.#parts.picture.loading = 'eager';
        this.drawPicture('light');
      }),
      this.#pinnedPicture.watch(),
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

  /** Handles a frame that was just drawn. */
  drew(canvas: HTMLCanvasElement): void {
    this.#pinnedPicture.drew(canvas);
  }

  /** The picture of the current state, drawn by the widget itself. */
  drawPicture(theme: Theme = themeOf(this.#host)): void {
    const width = Math.max(this.#host.clientWidth, MIN_WIDTH_PX);
    const svg = this.#lifecycle.ask((widget) => widget.picture(width, theme));
    if (svg !== undefined) this.#pictures.showDrawn(svg, this.#host.summary);
  }
}

function showMotion(widget: Widget): void {
  widget.setReducedMotion(reducedMotion?.matches === true);
}
