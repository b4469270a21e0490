// Avoids layout shifts: reserves the height of a picture before its first frame and while its canvas is gone.

import type { Parts } from './parts';
import type { Heights } from './schema';
import { mostType } from './type-scale';

/** Those whose widgets are being set up. */
const waiting = new Set<ReservedHeight>();

/** Measures all before it changes any: the page is laid out once for all its widgets. */
function fitWaiting(): void {
  const changes = [...waiting].map((one) => one.measure());
  waiting.clear();
  for (const change of changes) change();
}

export class ReservedHeight {
  readonly #parts: Parts;
  readonly #stage: HTMLElement;
  #heights: Heights = [];
  #kept: { width: number; height: number } | undefined;

  constructor(parts: Parts) {
    this.#parts = parts;
    this.#stage = parts.stage;
  }

  /** Reserves the height at the default values, at the end of the present task. */
  reserve(heights: Heights): void {
    this.#heights = heights;
    this.#kept = undefined;
    this.fitSoon();
  }

  /** Updates the reservation in the page, at the end of the present task. */
  fitSoon(): void {
    if (waiting.size === 0) queueMicrotask(fitWaiting);
    waiting.add(this);
  }

  /** Keeps the present height for the picture that replaces the canvas. */
  keep(): void {
    const { clientWidth: width, clientHeight: height } = this.#stage;
    this.#kept = { width, height };
    this.fit();
  }

  /** Updates the reservation after a resize. */
  fit(): void {
    this.measure()();
  }

  /** Measures the widget; returns what then changes the page. */
  measure(): () => void {
    const width = this.#stage.clientWidth;
    if (width === 0) return () => {};
    const scale = mostType(this.#hostStyle);
    const natural = heightAt(this.#heights, width / scale);
    const height = this.#kept?.width === width ? this.#kept.height : natural && scale * natural;
    if (height === undefined) return () => this.free();
    const reserved = Math.min(height, this.room);
    return () => this.#stage.style.setProperty('--reserved-height', `${reserved}px`);
  }

  /** The height available to the picture: that of `max-height` or of `--room` without what is around it, else infinite. */
  get room(): number {
    const { frame, rest, controls } = this.#parts;
    const style = this.#hostStyle;
    const most = [style.maxHeight, style.getPropertyValue('--room')].find((length) => length.endsWith('px'));
    if (most === undefined) return Infinity;
    // In the gap of the canvas they are part of the stage.
    const inGap = controls.style.marginBottom === '' ? 0 : controls.offsetHeight;
    return parseFloat(most) - (frame.offsetHeight - this.#stage.offsetHeight - rest.offsetHeight) - inGap;
  }

  get #hostStyle(): CSSStyleDeclaration {
    return getComputedStyle((this.#stage.getRootNode() as ShadowRoot).host);
  }

  /** Removes the reservation: the picture gets its natural height. */
  free(): void {
    this.#stage.style.removeProperty('--reserved-height');
  }
}

/** Linear interpolation between the widths of the table; constant beyond its ends. */
function heightAt(heights: Heights, width: number): number | undefined {
  const next = heights.findIndex(([known]) => known >= width);
  const [below, above] = [heights.at(next - 1), heights.at(next)];
  if (next <= 0 || below === undefined || above === undefined) return heights.at(Math.min(next, 0))?.[1];
  const share = (width - below[0]) / (above[0] - below[0]);
  return Math.round(below[1] + share * (above[1] - below[1]));
}
