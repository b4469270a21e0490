// The graph of w16.2: keyframes that are tapped, a loop that is dragged from one to another, and the same by keyboard,
// with the same texts for a screen reader.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const BODY = '<slam-widget name="w16.2" t="129"></slam-widget>';

/** Positions of the keyframes on the map, from the exported table. */
function keyframes(tab) {
  return tab.evaluate(async () => {
    const tables = await document.querySelector('slam-widget').tables();
    const [, ...rows] = tables.find(({ id }) => id === 'keyframes').csv.trim().split('\r\n');
    return rows.map((row) => row.split(',')).map(([, , , , x, y]) => [Number(x), Number(y)]);
  });
}

/** Waits until the widget has that value. */
function has(tab, id, value) {
  return tab.waitForFunction(([name, wanted]) => document.querySelector('slam-widget').get(name) === wanted, [id, value]);
}

async function screenOf(tab, node) {
  const places = await keyframes(tab);
  return h.pointOf(tab, 'map', ...places[node]);
}

describe('the graph of w16.2', () => {
  it('describes a clicked keyframe, and adds a loop to the keyframe that it is dragged to', async () => {
    await visit(BODY, async (tab) => {
      await h.ready(tab);
      await tab.mouse.click(...await screenOf(tab, 10));
      await has(tab, 'pick', 'keyframe');
      const number = await tab.evaluate(() => document.querySelector('slam-widget').get('number'));
      await h.moreFrames(tab, 1);
      await tab.mouse.move(...await screenOf(tab, number));
      await tab.mouse.down();
      const far = await screenOf(tab, 0);
      await tab.mouse.move(far[0] + 20, far[1]);
      await h.moreFrames(tab, 1);
      await tab.mouse.move(...far);
      await has(tab, 'own', 'registered');
      await tab.mouse.up();
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').get('own-from')), number);
      const box = await tab.locator('slam-widget canvas').boundingBox();
      const [, y] = await h.pointOf(tab, 'map', 3, 2);
      await tab.mouse.click(box.x + 200, y);
      await has(tab, 'pick', 'nothing');
    });
  });

  it('selects a keyframe by a tap, and deselects it by a tap beside it', async () => {
    await visit(BODY, async (tab) => {
      await h.ready(tab);
      await tab.touchscreen.tap(...await screenOf(tab, 10));
      await has(tab, 'pick', 'keyframe');
      await h.moreFrames(tab, 1);
      await tab.touchscreen.tap(...await h.pointOf(tab, 'map', 3, 2));
      await has(tab, 'pick', 'nothing');
    }, { options: { viewport: { width: 390, height: 844 }, hasTouch: true } });
  });

  it('is navigated by keyboard, with the same texts for a screen reader', async () => {
    await visit('<slam-widget name="w16.2" t="129" more="on"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const button = tab.locator('slam-widget button[data-control="one-on"]');
      for (const keyframe of [0, 1]) {
        await button.focus();
        await tab.keyboard.press('Enter');
        await tab.waitForFunction((number) => {
          const widget = document.querySelector('slam-widget');
          const live = widget.shadowRoot.querySelector('[aria-live]').textContent;
          return live.startsWith(`Keyframe ${number} of tick`) && live === widget.outcome.sentence;
        }, keyframe);
      }
      await tab.locator('slam-widget select[data-control="pick"]').selectOption('loop');
      await button.focus();
      await tab.keyboard.press('Enter');
      await tab.waitForFunction(() => document.querySelector('slam-widget').outcome.verdict === 'loop 29 to 7');
    });
  });
});
