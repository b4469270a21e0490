// Dragging recomputes everything on every move: what is shown belongs to the last value, and the
// whole chain from a finger to the result is on the reader's screen in the next frame.

import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import * as h from './harness.mjs';

let browser;
before(async () => (browser = await h.launch()));
after(() => browser.close());

async function on(name, test, attributes = '') {
  const body = `<slam-widget id="here" name="${name}" ${attributes}></slam-widget>`;
  const server = await h.serve({ pages: { '/t.html': h.bare(body) } });
  const tab = await h.open(browser, `${server.url}/t.html`);
  try {
    await h.ready(tab);
    await test(tab);
    assert.deepEqual(tab.troubles, []);
  } finally {
    await tab.context().close();
    await server.close();
  }
}

/** The first slider of the controls beside the picture: a point of its rail, and its length. */
async function firstSlider(tab) {
  const found = await tab.evaluate(() => {
    const widget = document.querySelector('#here');
    const box = widget.shadowRoot.querySelector('canvas').getBoundingClientRect();
    const left = box.width - 290;
    for (let y = 60; y < box.height; y += 4) {
      const along = [20, 80, 140, 200, 260].map((dx) => widget.dragsAt(left + dx, y));
      if (along.every(Boolean)) return { x: box.left + left, y: box.top + y + 6 };
    }
    return null;
  });
  assert.ok(found !== null, 'no slider beside the picture');
  return found;
}

/** What a widget that never ran before says in the same state. */
function freshOutcome(tab) {
  return tab.evaluate(async () => {
    const shown = document.querySelector('#here');
    const fresh = document.createElement('slam-widget');
    fresh.setAttribute('name', shown.getAttribute('name'));
    fresh.style.display = 'none';
    document.body.append(fresh);
    fresh.value = shown.value;
    await fresh.tables();
    const { outcome } = fresh;
    fresh.remove();
    return outcome;
  });
}

for (const [name, parameter] of [['w16.2', 'noise'], ['w16.3', 'tau'], ['w16.1', 'heading']]) {
  describe(`${name} while ${parameter} is dragged`, () => {
    it('shows the result of the last value, recomputed on every move', async () => {
      await on(name, async (tab) => {
        await tab.evaluate(() => {
          window.changes = [];
          document.addEventListener('slam-change', (event) => changes.push(event.detail.parameter));
        });
        const { x, y } = await firstSlider(tab);
        await tab.mouse.move(x + 60, y);
        await tab.mouse.down();
        const seen = new Set();
        for (let dx = 80; dx <= 240; dx += 40) {
          await tab.mouse.move(x + dx, y, { steps: 2 });
          await h.moreFrames(tab, 2);
          seen.add(await tab.evaluate((id) => document.querySelector('#here').get(id), parameter));
          const shown = await tab.evaluate(() => document.querySelector('#here').outcome);
          assert.deepEqual(shown, await freshOutcome(tab));
        }
        await tab.mouse.up();
        assert.ok(seen.size >= 4, `the slider took ${[...seen]}`);
        const changes = await tab.evaluate(() => changes);
        assert.ok(changes.length >= 4 && changes.every((id) => id === parameter), changes.join(', '));
      });
    });
  });
}

describe('w16.1', () => {
  it('moves the cloud that is dragged', async () => {
    await on('w16.1', async (tab) => {
      const { dx, dy } = await tab.evaluate(() => document.querySelector('#here').value);
      const at = await tab.evaluate(() => {
        const widget = document.querySelector('#here');
        const box = widget.shadowRoot.querySelector('canvas').getBoundingClientRect();
        // Over the picture, which lies left of the controls and right under the presets.
        for (let y = 120; y < 600; y += 5) {
          for (let x = 40; x < box.width * 0.35; x += 5) {
            // A finger reaches further than the mouse: take a spot from its middle.
            const around = [[0, 0], [12, 0], [-12, 0], [0, 12], [0, -12]];
            if (around.every(([dx, dy]) => widget.dragsAt(x + dx, y + dy))) return [box.left + x, box.top + y];
          }
        }
        return null;
      });
      assert.ok(at !== null, 'nothing in the picture drags');
      await tab.mouse.move(at[0], at[1]);
      await tab.mouse.down();
      await tab.mouse.move(at[0] + 25, at[1] + 20, { steps: 4 });
      await tab.mouse.up();
      await h.moreFrames(tab, 2);
      const moved = await tab.evaluate(() => document.querySelector('#here').value);
      assert.ok(moved.dx !== dx || moved.dy !== dy || moved.heading !== 25, JSON.stringify(moved));
      assert.deepEqual(await tab.evaluate(() => document.querySelector('#here').outcome), await freshOutcome(tab));
    });
  });
});

describe('the first frame', () => {
  it('comes within 1.5 seconds of the navigation, from a warm local server', async () => {
    const head = '<script>document.addEventListener("slam-ready", () => (window.readyMs ??= performance.now()));</script>';
    const server = await h.serve({ pages: { '/t.html': h.bare('<slam-widget name="w16.1"></slam-widget>', head) } });
    const times = [];
    // The fastest of five: other programs of the machine only ever make it slower.
    for (let i = 0; i < 5; i += 1) {
      const tab = await h.open(browser, `${server.url}/t.html`);
      await tab.waitForFunction(() => window.readyMs !== undefined);
      times.push(await tab.evaluate(() => readyMs));
      await tab.context().close();
    }
    await server.close();
    assert.ok(Math.min(...times) < 1500, times.map(Math.round).join(', '));
  });
});
