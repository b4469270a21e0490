// The small figures beside the text: a slider, and a picture and a sentence that follow it.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const reading = (test, options = {}) => visit('', test, { path: '/index.html', options });
const NAMES = ['nearest', 'slide', 'bells', 'ellipse', 'gate', 'push', 'incremental'];
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
  for (const name of NAMES) {
    it(`follows its slider by keyboard, in picture, value and sentence: ${name}`, async () => {
      await reading(async (tab) => {
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
    });
  }

  for (const viewport of [{ width: 1440, height: 900 }, { width: 390, height: 844 }]) {
    it(`keeps its height when its slider first moves, ${viewport.width} px wide`, async () => {
      await reading(async (tab) => {
        for (const name of NAMES) {
          const range = await slider(tab, name);
          await range.scrollIntoViewIfNeeded();
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
    await reading(async (tab) => {
      for (const name of NAMES) {
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
