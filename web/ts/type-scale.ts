// The size of text: pictures follow the page's root, as all other text of a widget does.

import type { Widget } from '../pkg/glue.js';

/** The root's font size of browsers by default, px. */
const USUAL_ROOT_PX = 16;

/** The size of a picture's text where it fits, as a multiple of the usual one: the host's `--most-type`, or that of the page. */
export function mostType(host: CSSStyleDeclaration): number {
  const page = getComputedStyle(document.documentElement);
  return parseFloat(host.getPropertyValue('--most-type')) || parseFloat(page.fontSize) / USUAL_ROOT_PX;
}

/** Steps by which text shrinks. */
const STEP = 0.1;

/**
 * Sets the height that a picture may have, and the size of its text. If the picture does not fit, its text shrinks as far as
 * `--least-type` permits, a multiple of the usual size.
 *
 * @returns the size of the text, as a multiple of the usual one.
 */
export function fitPicture(widget: Widget, host: HTMLElement, widthPx: number, roomPx: number): number {
  const style = getComputedStyle(host);
  const most = mostType(style);
  const least = Math.min(most, parseFloat(style.getPropertyValue('--least-type')) || most);
  for (let scale = most; ; scale = Math.max(scale - STEP, least)) {
    widget.setTypeScale(scale);
    widget.setRoom(roomPx);
    if (scale === least || scale * widget.heightAt(widthPx / scale) <= roomPx) return scale;
  }
}
