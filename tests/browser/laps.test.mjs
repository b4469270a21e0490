// A thousand laps as a picture; the test uses some of them.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { wasm } from '../wasm/module.mjs';
import * as h from './harness.mjs';

const SEEDS = 3;
const LEVELS = [0.25, 1, 2, 4];
const pages = {
  '/index.html': readFileSync(join(h.DIST, 'index.html'), 'utf8').replaceAll('data-seeds="1000"', `data-seeds="${SEEDS}"`),
};
const visit = h.visitor();
const reading = (test, { options = {}, server = {}, path = '/index.html', quiet } = {}) =>
  visit('', test, { path, options, quiet, server: { ...server, pages: { ...pages, ...server.pages } } });

/** The same laps computed in Node: by level, front end and with loops. */
const laps = new wasm.LapOutcomes();
const errors = LEVELS.map((noise) => {
  const numbers = Array.from({ length: SEEDS }, (_, at) => laps.drive(at + 1, `noise=${noise}`));
  return [0, 4].map((column) => numbers.map((lap) => lap[column]).sort((a, b) => a - b));
});

const wrong = LEVELS.map((noise) => Array.from({ length: SEEDS }, (_, at) => laps.drive(at + 1, `noise=${noise}`)[9]).filter((many) => many > 0).length);

const lookAt = (tab, id) => tab.locator(id).scrollIntoViewIfNeeded();
const look = (tab) => tab.locator('#laps').scrollIntoViewIfNeeded();
const done = (tab, frame = tab) => frame.waitForFunction(() => /^(\d+) of \1 seeds/.test(
  document.querySelector('#laps .laps-count')?.textContent ?? ''));
const medians = (frame) => frame.evaluate(() => new Promise((resolve) => {
  const read = () => {
    const strips = [...document.querySelectorAll('#laps .laps-grid canvas')];
    if (strips.every(({ dataset }) => Number(dataset.laps) === Number(document.querySelector('#laps').dataset.seeds))) {
      resolve(strips.map(({ dataset }) => dataset.median));
    } else requestAnimationFrame(read);
  };
  read();
}));
const expected = errors.flat().map((sorted) => sorted[(SEEDS - 1) / 2].toFixed(2));

describe('the thousand laps', () => {
  it('run in workers while the figure is in view, with the same results as the core', async () => {
    await reading(async (tab) => {
      assert.equal(tab.workers().length, 0, 'nobody looks yet');
      const worker = tab.waitForEvent('worker');
      await look(tab);
      await worker;
      await done(tab);
      assert.deepEqual(await medians(tab), expected);
      const marked = await tab.locator('#laps .laps-grid canvas').evaluateAll((strips) => strips.map(({ dataset }) => Number(dataset.false)));
      assert.deepEqual(marked, wrong.flatMap((many) => [0, many]), 'the front end alone takes no loop');
    });
  });

  it('run between frames if workers are unavailable', async () => {
    const framed = '<!doctype html><title>Around</title><link rel="icon" href="data:,"><iframe sandbox="allow-scripts" '
      + 'src="/index.html#laps" style="width: 1000px; height: 800px"></iframe>';
    await reading(async (tab) => {
      const frame = tab.frames()[1];
      await frame.waitForSelector('#laps .laps-count');
      await done(tab, frame);
      assert.equal(tab.workers().length, 0);
      assert.deepEqual(await medians(frame), expected);
    }, { path: '/around.html', server: { pages: { '/around.html': framed } }, quiet: false });
  });

  it('are described in words by the arrow keys, and opened in w16.2 by a click', async () => {
    await reading(async (tab) => {
      await look(tab);
      await done(tab);
      const strip = tab.getByRole('slider', { name: 'Laps at wheel noise ×4, with loops' });
      await strip.focus();
      await tab.keyboard.press('End');
      const worst = errors[3][1].at(-1).toFixed(2);
      assert.match(await strip.getAttribute('aria-valuetext'), new RegExp(`^seed \\d: ${worst} m$`));
      assert.equal(await strip.getAttribute('aria-valuenow'), String(SEEDS));
      assert.match(await tab.locator('#laps .laps-chosen').textContent(), /^Seed \d at noise ×4: .* m with \d loops?/);
      const { x, y, width, height } = await strip.boundingBox();
      await tab.mouse.click(x + width / 2, y + height / 2);
      await tab.waitForFunction(() => {
        const lap = document.querySelector('slam-widget[name="w16.2"]');
        return lap.get('noise') === 4 && lap.get('t') === 129 && lap.get('seed') <= 3;
      });
      const seed = await tab.evaluate(() => document.querySelector('slam-widget[name="w16.2"]').get('seed'));
      assert.match(await tab.locator('#laps .laps-chosen').textContent(), new RegExp(`^Seed ${seed} `));
      await tab.goBack();
      await tab.waitForFunction(() => document.querySelector('slam-widget[name="w16.2"]').get('noise') === 1);
    });
  });
});

describe('the laps by each matcher', () => {
  const figure = '#matcher-laps';
  const finished = (tab) => tab.waitForFunction((id) => /^(\d+) of \1 seeds/.test(
    document.querySelector(`${id} .laps-count`)?.textContent ?? ''), figure);
  const shown = (tab) => tab.locator(`${figure} canvas`).evaluateAll((strips) => strips.map(({ dataset }) => dataset.median));
  const says = (tab) => tab.locator(`${figure} .laps-says li`).allTextContents();
  const guess = async (tab) => {
    for (const slider of await tab.locator(figure).getByLabel('Your guess').all()) await slider.press('ArrowRight');
    await tab.waitForFunction((id) => document.querySelectorAll(`${id} canvas[data-median]`).length === 6, figure);
  };

  it('hide what loops do until the reader has guessed', async () => {
    await reading(async (tab) => {
      await lookAt(tab, figure);
      await finished(tab);
      const [alone, hidden] = await shown(tab);
      assert.match(alone, /^0\.\d\d$/);
      assert.equal(hidden, undefined);
      assert.match((await says(tab)).join(), /^By how much .* Set a guess for each\.$/);
      await guess(tab);
      assert.match((await shown(tab))[1], /^0\.\d\d$/);
      assert.match((await says(tab))[0], /^Point-to-point: median /);
    });
  });

  it('are driven again with another radius, without the cap and in the ring, and shown by another measure at once', async () => {
    await reading(async (tab) => {
      await lookAt(tab, figure);
      await finished(tab);
      await guess(tab);
      const rms = (state) => {
        const of = Array.from({ length: SEEDS }, (_, at) => laps.drive(at + 1, state)[1]).sort((a, b) => a - b);
        return of[(SEEDS - 1) / 2].toFixed(2);
      };
      const medians = await shown(tab);
      assert.equal(medians.length, 6);
      assert.equal(medians[2], rms('matcher=p2l&normals=4.2'));
      await tab.locator(`${figure} select`).first().selectOption('that error ÷ the graph’s standard deviation');
      const capped = await says(tab);
      assert.match(capped[2], /^NDT: root mean square \d/);
      await tab.locator(figure).getByLabel('cap on the information').setChecked(false);
      await finished(tab);
      assert.notDeepEqual(await says(tab), capped);
      await tab.locator(`${figure} select`).first().selectOption('rms error');
      await tab.locator(figure).getByLabel('Radius of the normals').fill('2.5');
      await finished(tab);
      assert.equal((await shown(tab))[2], rms('matcher=p2l&normals=2.5'));
    });
  });
});

describe('the algorithm beside the lap', () => {
  it('lights the lines that ran in the tick on screen', async () => {
    await reading(async (tab) => {
      await tab.locator('[data-lines]').evaluate((list) => list.closest('details').setAttribute('open', ''));
      await lookAt(tab, 'slam-widget[name="w16.2"]');
      const lit = (count) => tab.waitForFunction((many) => document.querySelectorAll('[data-lines] > li.ran').length === many, count);
      await lit(6);
      await tab.evaluate(() => document.querySelector('slam-widget[name="w16.2"]').set('t', 91));
      await lit(2);
    });
  });
});
