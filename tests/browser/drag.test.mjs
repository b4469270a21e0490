// During a drag every move recomputes everything, and the next frame shows the result of the last value.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';
import { cloudSpot, sliderRail } from './spots.mjs';

const visit = h.visitor();

function on(name, test, options) {
  return visit(`<slam-widget id="here" name="${name}" more="on"></slam-widget>`, async (tab) => {
    await h.ready(tab);
    await test(tab);
  }, { options });
}

/** The outcome of a new widget in the same state. */
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

/** Stores the widget's picture in the page, under a name. */
function keepPicture(tab, name) {
  return tab.evaluate(async (key) => {
    const picture = await document.querySelector('#here').snapshot();
    const copy = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
    copy.drawImage(picture, 0, 0);
    (window.kept ??= {})[key] = copy.getImageData(0, 0, picture.width, picture.height);
  }, name);
}

/** The share of colour values in which two stored pictures differ. */
function difference(tab, one, other) {
  return tab.evaluate(([a, b]) => {
    if (kept[a].width !== kept[b].width || kept[a].height !== kept[b].height) return 1;
    return kept[a].data.filter((value, at) => value !== kept[b].data[at]).length / kept[a].data.length;
  }, [one, other]);
}

for (const [name, parameter] of [['w16.2', 'noise'], ['w16.8', 'share'], ['w16.1', 'heading']]) {
  describe(`${name} while ${parameter} is dragged`, () => {
    it('has the result of the last value after every move', async () => {
      await on(name, async (tab) => {
        await tab.evaluate(() => {
          window.changes = [];
          document.addEventListener('slam-change', ({ detail }) => changes.push(detail));
        });
        const { x, y, width } = await sliderRail(tab, parameter);
        await tab.mouse.move(x + 0.1 * width, y);
        await tab.mouse.down();
        await h.moreFrames(tab, 2);
        for (const share of [0.2, 0.3, 0.4, 0.5]) {
          const before = await tab.evaluate(() => changes.length);
          await tab.mouse.move(x + share * width, y);
          await tab.waitForFunction((count) => changes.length > count, before);
          const { last, value, shown } = await tab.evaluate((id) => ({
            last: changes.at(-1),
            value: document.querySelector('#here').get(id),
            shown: document.querySelector('#here').outcome,
          }), parameter);
          const fresh = await freshOutcome(tab);
          assert.equal(last.parameter, parameter);
          assert.equal(last.value, value);
          // A lap takes several frames, and a change reports the picture so far.
          if (name !== 'w16.2') assert.deepEqual(last.outcome, fresh);
          assert.deepEqual(shown, fresh);
        }
        await tab.mouse.up();
      });
    });

    // Letting go of w16.1 plays, so its picture is another one than at a start.
    if (name !== 'w16.1') it('shows the same picture as a widget that starts with that value', async () => {
      await on(name, async (tab) => {
        const { x, y, width } = await sliderRail(tab, parameter);
        await h.quiet(tab);
        await keepPicture(tab, 'start');
        await tab.mouse.move(x + 0.1 * width, y);
        await tab.mouse.down();
        await tab.mouse.move(x + 0.5 * width, y, { steps: 5 });
        await tab.mouse.up();
        await tab.mouse.move(2, 2);
        await h.quiet(tab);
        await keepPicture(tab, 'dragged');
        await tab.evaluate(() => {
          const old = document.querySelector('#here');
          const fresh = old.cloneNode();
          fresh.value = old.value;
          old.replaceWith(fresh);
        });
        await h.ready(tab);
        await h.quiet(tab);
        await keepPicture(tab, 'fresh');
        const moved = await difference(tab, 'start', 'fresh');
        assert.ok(moved > 0.005, `only ${moved} of the picture depends on it`);
        assert.equal(await difference(tab, 'dragged', 'fresh'), 0);
      }, { sees: true });
    });
  });
}

describe('w16.1', () => {
  it('moves the cloud with the pointer, to scale', async () => {
    await on('w16.1', async (tab) => {
      const value = () => tab.evaluate(() => document.querySelector('#here').value);
      const [left, top] = await cloudSpot(tab);
      await tab.mouse.move(left, top);
      await tab.mouse.down();
      // Grabbing the cloud shows the registered pose: that is the new start.
      await h.moreFrames(tab, 3);
      const taken = await value();
      // The scale is fixed during the drag; afterwards the picture fits the whole sweep again.
      const [zero, east] = [await h.pointOf(tab, 'sweeps', 0, 0, '#here'), await h.pointOf(tab, 'sweeps', 1, 0, '#here')];
      const pxPerM = east[0] - zero[0];
      await tab.mouse.move(left + 25, top + 20, { steps: 4 });
      await tab.mouse.up();
      await h.moreFrames(tab, 3);
      const moved = await value();
      assert.ok(Math.abs(moved.dx - taken.dx - 25 / pxPerM) < 0.02, `${taken.dx} to ${moved.dx}`);
      assert.ok(Math.abs(moved.dy - taken.dy + 20 / pxPerM) < 0.02, `${taken.dy} to ${moved.dy}`);
      assert.equal(moved.heading, taken.heading);
      assert.deepEqual(await tab.evaluate(() => document.querySelector('#here').outcome), await freshOutcome(tab));
    });
  });
});
