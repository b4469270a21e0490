// Positions for the pointer: widgets report what is draggable, so tests need no fixed coordinates.

import assert from 'node:assert/strict';
import { moreFrames } from './harness.mjs';

/** The rectangle of the canvas on the screen. */
export function canvasBox(tab, css = 'slam-widget') {
  return tab.locator(`${css} canvas`).first().boundingBox();
}

/** A point of the canvas without anything draggable nearby. */
export function restingSpot(tab, css = 'slam-widget') {
  return spot(tab, css, false);
}

/** A draggable point of the canvas. */
export function draggingSpot(tab, css = 'slam-widget') {
  return spot(tab, css, true);
}

async function spot(tab, css, drags) {
  const at = await tab.evaluate(([name, wanted]) => {
    const widget = document.querySelector(name);
    const box = widget.shadowRoot.querySelector('canvas').getBoundingClientRect();
    const bottom = Math.min(box.height, innerHeight - box.top) - 60;
    for (let y = wanted ? 10 : bottom; y > 5 && y <= bottom; y += wanted ? 6 : -6) {
      for (let x = 100; x < box.width - 100; x += 6) {
        const around = [[0, 0], [8, 0], [-8, 0], [0, 8], [0, -8]].map(([dx, dy]) => widget.dragsAt(x + dx, y + dy));
        if (wanted ? around[0] : around.every((drag) => !drag)) return [box.left + x, box.top + y];
      }
    }
    return null;
  }, [css, drags]);
  assert.ok(at !== null, drags ? 'nothing drags' : 'everything drags');
  return at;
}

/** Half the width of the thumb of a slider, px. */
const THUMB_PX = 9;

/** The range of the middle of a slider's thumb on the screen; opens More if the slider is there. */
export async function sliderRail(tab, parameter, css = 'slam-widget') {
  const slider = tab.locator(`${css} #control-${parameter}`);
  if (await slider.isHidden()) await tab.locator(`${css} #control-more`).click();
  await slider.waitFor();
  await slider.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await slider.boundingBox();
  return { x: x + THUMB_PX, y: y + height / 2, width: width - 2 * THUMB_PX };
}

/** A point of the picture of w16.1 at which the mouse can grab the cloud, away from the other draggable things. */
export async function cloudSpot(tab, css = 'slam-widget') {
  const [left, bottom, right, top] = await tab.evaluate((name) => {
    const widget = document.querySelector(name);
    return [...widget.panelToScreen('sweeps', -2, -2), ...widget.panelToScreen('sweeps', 2, 2)];
  }, css);
  return grabbingSpot(tab, css, { left, bottom, right, top });
}

/** A point of the canvas at which the mouse can grab something, within a rectangle if one is given. */
export async function grabbingSpot(tab, css = 'slam-widget', within = null) {
  const spots = await tab.evaluate(([name, given]) => {
    const widget = document.querySelector(name);
    const box = widget.shadowRoot.querySelector('canvas').getBoundingClientRect();
    const { left, top, right, bottom } = given ?? { left: 0, top: 0, right: box.width, bottom: Math.min(box.height, innerHeight - box.top) };
    const found = [];
    for (let y = Math.ceil(top); y < bottom; y += 7) {
      for (let x = Math.ceil(left); x < right; x += 7) {
        if (widget.dragsAt(x, y)) found.push([box.left + x, box.top + y]);
      }
    }
    return found;
  }, [css, within]);
  // `dragsAt` has the larger reach of a finger: the cursor shows whether the mouse grabs.
  for (const [x, y] of spots) {
    await tab.mouse.move(x, y);
    await moreFrames(tab, 2, css);
    const cursor = await tab.evaluate((name) => document.querySelector(name).shadowRoot.querySelector('canvas').style.cursor, css);
    if (cursor === 'grab') return [x, y];
  }
  assert.fail('nothing in the picture drags');
}
