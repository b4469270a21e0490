// The small figures beside the text: a slider, and a picture and a sentence that follow it.

import assert from 'node:assert/strict';
import { before, describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const ON = {
  '/index.html': ['pull', 'slide', 'bells', 'ellipse', 'gate', 'attempts', 'agree', 'push', 'steps', 'rule'],
  '/reference.html': ['nearest', 'fill', 'start', 'ate', 'incremental'],
};
const reading = (test, options = {}, path = '/index.html') => visit('', test, { path, options });
/** Runs on each page with its figures. */
const onEach = async (test, options) => {
  for (const [path, names] of Object.entries(ON)) await reading((tab) => test(tab, names), options, path);
};
const figure = (tab, name) => tab.locator(`[data-sketch="${name}"]`);
/** Opens the fold of a figure, if it is in one. */
const unfold = (tab, name) => tab.evaluate(
  (id) => document.querySelector(`[data-sketch="${id}"]`).closest('details')?.setAttribute('open', ''), name);
/** The slider of a figure, once the core has loaded; it is fetched near the viewport. */
async function slider(tab, name) {
  await unfold(tab, name);
  await figure(tab, name).scrollIntoViewIfNeeded();
  await tab.waitForFunction((id) => document.querySelector(`[data-sketch="${id}"] input`).disabled === false, name);
  return figure(tab, name).locator('input');
}
/** The middle of the ring on a figure. */
const ring = (tab, name) => figure(tab, name).locator('.sketch-handle').evaluate((at) => {
  const { left, top, width, height } = at.getBoundingClientRect();
  return [left + width / 2, top + height / 2];
});
const shown = (tab, name) => tab.evaluate((id) => {
  const at = document.querySelector(`[data-sketch="${id}"]`);
  return {
    says: at.querySelector('.sketch-says').textContent,
    value: at.querySelector('output').textContent,
    spoken: at.querySelector('input').getAttribute('aria-valuetext'),
    picture: at.querySelector('.sketch-picture svg')?.outerHTML ?? null,
  };
}, name);
const drawn = (tab, name) => tab.waitForFunction(
  (id) => document.querySelector(`[data-sketch="${id}"] .sketch-picture svg`) !== null, name);
const changed = (tab, name, says) => tab.waitForFunction(
  ([id, old]) => document.querySelector(`[data-sketch="${id}"] .sketch-says`).textContent !== old, [name, says]);

describe('a small figure', () => {
  it('starts once it is near, and no other with it', async () => {
    await reading(async (tab) => {
      await slider(tab, 'pull');
      const off = (name) => tab.evaluate((id) => document.querySelector(`[data-sketch="${id}"] input`).disabled, name);
      assert.equal(await off('rule'), true);
      await slider(tab, 'rule');
      assert.equal(await off('gate'), true);
    });
  });

  for (const [path, names] of Object.entries(ON)) {
    describe(path, () => {
      const page = visit.once('', { path });
      for (const name of names) {
        it(`follows its slider by keyboard, in picture, value and sentence: ${name}`, async () => {
          const { tab } = page;
          const range = await slider(tab, name);
          await figure(tab, name).scrollIntoViewIfNeeded();
          const before = await shown(tab, name);
          assert.ok(before.says.length > 30);
          await range.press('End');
          await changed(tab, name, before.says);
          await drawn(tab, name);
          const after = await shown(tab, name);
          assert.notEqual(after.value, before.value);
          assert.equal(after.spoken, after.value);
          assert.match(after.picture, /<title>/);
          await range.press('Home');
          await changed(tab, name, after.says);
          assert.notEqual((await shown(tab, name)).picture, after.picture);
        });
      }
    });
  }

  for (const viewport of [{ width: 1440, height: 900 }, { width: 390, height: 844 }]) {
    it(`keeps its height when its slider first moves, and its value on one line beside it, ${viewport.width} px wide`, async () => {
      await onEach(async (tab, names) => {
        for (const name of names) {
          const range = await slider(tab, name);
          await range.scrollIntoViewIfNeeded();
          const [lines, isBeside] = await figure(tab, name).locator('output').evaluate((value) => {
            const range = document.createRange();
            range.selectNodeContents(value);
            const { top, bottom } = value.getBoundingClientRect();
            const rail = value.closest('figure').querySelector('input').getBoundingClientRect();
            const count = new Set([...range.getClientRects()].map((line) => Math.round(line.top))).size;
            return [count, top < rail.bottom && bottom > rail.top];
          });
          assert.equal(lines, 1, name);
          assert.ok(isBeside, `${name}: the value stands alone on its line`);
          const height = () => figure(tab, name).locator('.sketch-picture').evaluate((box) => box.offsetHeight);
          const before = await height();
          assert.ok(before > 100, `${name}: ${before}`);
          const { says } = await shown(tab, name);
          await range.press('ArrowRight');
          await drawn(tab, name);
          await changed(tab, name, says);
          assert.ok(Math.abs((await height()) - before) <= 2, `${name}: ${before} px, then ${await height()}`);
        }
        assert.ok(await tab.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      }, { viewport });
    });
  }

  it('is drawn in the theme that the reader chooses', async () => {
    await reading(async (tab) => {
      const range = await slider(tab, 'gate');
      await range.press('End');
      await drawn(tab, 'gate');
      const light = (await shown(tab, 'gate')).picture;
      await tab.getByRole('button', { name: 'Dark', exact: true }).click();
      await tab.waitForFunction((old) => document.querySelector('[data-sketch="gate"] svg').outerHTML !== old, light);
      await tab.getByRole('button', { name: 'Auto', exact: true }).click();
      await tab.waitForFunction((old) => document.querySelector('[data-sketch="gate"] svg').outerHTML === old, light);
    }, { colorScheme: 'light' });
  });

  it('is a still picture with its sentence without scripts', async () => {
    await onEach(async (tab, names) => {
      for (const name of names) {
        await unfold(tab, name);
        await figure(tab, name).scrollIntoViewIfNeeded();
        const picture = figure(tab, name).locator('img');
        assert.ok(await picture.evaluate((img) => img.decode().then(() => img.naturalWidth > 100)), name);
        assert.ok((await picture.getAttribute('alt')).length > 40);
        assert.equal(await figure(tab, name).locator('input').isVisible(), false);
      }
    }, { javaScriptEnabled: false });
  });
});

describe('the picture of a figure', () => {
  for (const [path, names] of Object.entries(ON)) {
    describe(path, () => {
      const page = visit.once('', { path, options: { viewport: { width: 1100, height: 900 } } });
      before(() => h.withoutLaps(page.tab));
      for (const name of names) {
        it(`is dragged by its handle, which follows the pointer: ${name}`, async () => {
          const { tab } = page;
          const input = await slider(tab, name);
          await figure(tab, name).evaluate((at) => at.scrollIntoView({ block: 'center', behavior: 'instant' }));
          // Where the handle is to go: its place at another value.
          const places = [];
          for (const share of [0.25, 0.75]) {
            await input.evaluate((range, part) => {
              range.value = String(Number(range.min) + part * (Number(range.max) - Number(range.min)));
              range.dispatchEvent(new Event('input', { bubbles: true }));
            }, share);
            await h.quiet(tab);
            places.push({ at: await ring(tab, name), value: Number(await input.inputValue()) });
          }
          const [to, from] = places;
          await tab.mouse.move(...from.at);
          await tab.mouse.down();
          // Along the way in between, as a reader does.
          const span = Number(await input.evaluate(({ min, max }) => max - min));
          await tab.mouse.move(...to.at, { steps: 12 });
          await h.quiet(tab);
          const value = Number(await input.inputValue());
          const [x, y] = await ring(tab, name);
          await tab.mouse.up();
          assert.notEqual(value, from.value);
          assert.ok(Math.hypot(x - to.at[0], y - to.at[1]) < 12, `${x}, ${y} is not at the pointer, ${to.at}`);
          assert.ok(span > 0);
        });
      }
    });
  }
});
