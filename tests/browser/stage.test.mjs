// One stage: the canvas holds the picture and its handles, the page everything else.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const named = (id) => `slam-widget[name="${id}"]`;

/** Least share of a widget's height that its picture has at rest. */
const LEAST_SHARE = 0.7;

/** The heights of picture and widget, and what stands over the picture. */
const measured = (tab, css) => tab.evaluate((name) => {
  const element = document.querySelector(name);
  const { shadowRoot } = element;
  const canvas = shadowRoot.querySelector('canvas');
  const { left, top, width, height } = canvas.getBoundingClientRect();
  const over = [...shadowRoot.querySelectorAll(':is(button, input, select, summary):not([aria-hidden])')]
    .filter((control) => control.checkVisibility())
    .filter((control) => {
      const box = control.getBoundingClientRect();
      return box.left < left + width && box.right > left && box.top < top + height && box.bottom > top;
    });
  return { share: height / element.offsetHeight, high: element.offsetHeight, over: over.map(({ textContent }) => textContent) };
}, css);

describe('the picture', () => {
  for (const [width, height] of [[1440, 900], [1280, 800], [1280, 680], [390, 844]]) {
    // Without a log own-robot.html shows no widget.
    for (const page of h.PAGES.filter((file) => h.widgetsOf(file).length > 0 && file !== 'own-robot.html')) {
      it(`has at least ${100 * LEAST_SHARE} % of the height of each widget at rest: ${page} at ${width}×${height}`, async () => {
        await visit('', async (tab) => {
          const low = [];
          for (const id of h.widgetsOf(page)) {
            await h.unfold(tab, named(id));
            await tab.locator(named(id)).scrollIntoViewIfNeeded();
            await h.ready(tab, named(id));
            await h.quiet(tab);
            const { share, high, over } = await measured(tab, named(id));
            assert.deepEqual(over, [], `${id}: controls on the picture`);
            if (share < LEAST_SHARE) low.push(`${id}: ${(100 * share).toFixed(0)} % of ${high} px`);
          }
          assert.deepEqual(low, []);
        }, { path: `/${page}`, options: { viewport: { width, height }, deviceScaleFactor: 1 } });
      });
    }
  }
});

describe('a frame of 800 × 600', () => {
  // The reliefs of w16.3 need more.
  for (const { id } of h.schema.filter(({ id }) => id !== 'w16.3')) {
    it(`shows picture, Play and verdict: ${id}`, async () => {
      await visit('', async (tab) => {
        await h.ready(tab);
        await h.quiet(tab);
        const bottom = await tab.evaluate(() =>
          document.querySelector('slam-widget').shadowRoot.querySelector('.verdict').getBoundingClientRect().bottom);
        assert.ok(bottom <= 600, `${bottom} px`);
      }, { path: `/embed.html?w=${id.slice(1)}`, options: { viewport: { width: 800, height: 600 }, deviceScaleFactor: 1 } });
    });
  }
});

describe('the controls', () => {
  for (const spec of h.schema) {
    it(`are native, each of them once, and stand below the picture: ${spec.id}`, async () => {
      await visit(`<slam-widget name="${spec.id}"></slam-widget>`, async (tab) => {
        await h.ready(tab);
        await h.quiet(tab);
        // The plots that More opens follow below the controls.
        const end = await tab.evaluate(() =>
          document.querySelector('slam-widget').shadowRoot.querySelector('canvas').getBoundingClientRect().bottom);
        await tab.evaluate(() => document.querySelector('slam-widget').set('more', true));
        await h.quiet(tab);
        const seen = await tab.evaluate((end) => {
          const { shadowRoot } = document.querySelector('slam-widget');
          const rows = [...shadowRoot.querySelectorAll('.control')].filter((row) => row.checkVisibility());
          return rows.map((row) => [row.querySelector('[data-control]').dataset.control, row.getBoundingClientRect().top >= end - 1]);
        }, end);
        const ids = seen.map(([id]) => id);
        assert.equal(new Set(ids).size, ids.length);
        assert.ok(spec.opening.every((id) => ids.includes(id)), String(ids));
        assert.ok(seen.every(([, isBelow]) => isBelow), JSON.stringify(seen));
      });
    });
  }

  it('show the last number of each timeline whole', async () => {
    for (const { id, params } of h.schema) {
      const timeline = params.find(({ kind }) => kind === 'timeline');
      if (timeline === undefined || id === 'w16.10') continue;
      await visit(`<slam-widget name="${id}"></slam-widget>`, async (tab) => {
        await h.ready(tab);
        await tab.evaluate((last) => document.querySelector('slam-widget').set(...last), [timeline.id, timeline.max]);
        await h.quiet(tab);
        const number = tab.locator('.transport input[type="number"]');
        const [value, hidden] = await number.evaluate((field) => [field.value, field.scrollWidth - field.clientWidth]);
        assert.ok(value.length > 0 && hidden <= 0, `${id}: ${hidden} px of ${value} are hidden`);
      });
    }
  });

  it('follow the size of the page’s text, and so does the picture', async () => {
    const heights = [];
    for (const px of [16, 24]) {
      await visit('<slam-widget name="w16.5"></slam-widget>', async (tab) => {
        await h.ready(tab);
        await h.quiet(tab);
        heights.push(await tab.evaluate(() => {
          const { shadowRoot } = document.querySelector('slam-widget');
          return parseFloat(getComputedStyle(shadowRoot.querySelector('.verdict')).fontSize);
        }));
        const [x, y] = await h.pointOf(tab, 'graph', 0, 0);
        await tab.mouse.move(x, y);
        assert.ok(Number.isFinite(x) && Number.isFinite(y));
      }, { head: `<style>html { font-size: ${px}px }</style>` });
    }
    assert.equal(heights[1] / heights[0], 1.5);
  });
});
