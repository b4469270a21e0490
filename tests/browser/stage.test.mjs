// One stage: the canvas holds the picture and its handles, the page everything else.

import assert from 'node:assert/strict';
import { before, describe, it } from 'node:test';
import * as h from './harness.mjs';
import { grabbingSpot } from './spots.mjs';

const visit = h.visitor();
const named = (id) => `slam-widget[name="${id}"]`;

/** A wide screen, a low one, a phone. */
const SCREENS = [{ width: 1440, height: 900 }, { width: 1280, height: 680 }, { width: 390, height: 844 }];

/** The low screen, on which picture and Play have to fit together, and the phone, on which the whole widget has. */
const [, LOW, PHONE] = SCREENS;
const plays = new Set(h.schema.filter(({ buttons }) => buttons.some(({ id }) => id === 'play')).map(({ id }) => id));

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

/** From the top of the picture to the bottom of Play, once the widget is scrolled into view. */
const span = (tab, css) => tab.evaluate((name) => {
  const element = document.querySelector(name);
  element.scrollIntoView();
  const { top } = element.shadowRoot.querySelector('canvas').getBoundingClientRect();
  const play = element.shadowRoot.querySelector('[data-control="play"]').getBoundingClientRect();
  return [top + element.sceneBox()[1], play.bottom];
}, css);

describe('the picture', () => {
  // Without a log own-robot.html shows no widget.
  for (const page of h.PAGES.filter((file) => h.widgetsOf(file).length > 0 && file !== 'own-robot.html')) {
    it(`has at least ${100 * LEAST_SHARE} % of the height of each widget at rest: ${page}`, async () => {
      await visit('', async (tab) => {
        const low = [];
        await h.withoutLaps(tab);
        for (const viewport of SCREENS) {
          await tab.setViewportSize(viewport);
          for (const id of h.widgetsOf(page)) {
            await h.unfold(tab, named(id));
            await tab.locator(named(id)).scrollIntoViewIfNeeded();
            await h.ready(tab, named(id));
            await h.quiet(tab);
            const { share, high, over } = await measured(tab, named(id));
            const where = `${id} at ${viewport.width}×${viewport.height}`;
            assert.deepEqual(over, [], `${where}: controls on the picture`);
            // The game's own Drive is its Play.
            if (viewport === LOW && plays.has(id) && page !== 'break.html') {
              const [top, bottom] = await span(tab, named(id));
              assert.ok(top >= 0 && bottom <= LOW.height, `${where}: picture and Play from ${top} to ${bottom}`);
            }
            if (viewport === PHONE && page !== 'break.html') assert.ok(high < PHONE.height, `${where}: ${high} px`);
            if (share < LEAST_SHARE) low.push(`${where}: ${(100 * share).toFixed(0)} % of ${high} px`);
          }
        }
        assert.deepEqual(low, []);
      }, { path: `/${page}`, options: { viewport: SCREENS[0], deviceScaleFactor: 1 } });
    });
  }
});

it('a timeline beside other buttons fits its frame on narrow screens', async () => {
  const body = ['w16.5', 'w16.6', 'w16.8'].map((id) => `<slam-widget name="${id}"></slam-widget>`).join('');
  await visit(body, async (tab) => {
    for (const width of [390, 450, 500, 540, 560, 620]) {
      await tab.setViewportSize({ width, height: 900 });
      const wide = await tab.evaluate(() => [...document.querySelectorAll('slam-widget')].flatMap(({ name, shadowRoot }) => {
        const frame = shadowRoot.querySelector('.frame').getBoundingClientRect();
        return [...shadowRoot.querySelectorAll('.transport *')].filter((one) => one.closest('.hidden') === null
          && one.getClientRects().length > 0 && one.getBoundingClientRect().right > frame.right + 0.5).map((one) => `${name}: ${one.className}`);
      }));
      assert.deepEqual(wide, [], `${width} px`);
    }
  });
});

describe('the verdict', () => {
  /** The widths that each widget has on the pages, by screen. */
  const widths = new Map(h.schema.map(({ id }) => [id, []]));

  before(async () => {
    for (const page of h.PAGES.filter((file) => h.widgetsOf(file).length > 0)) {
      await visit('', async (tab) => {
        await tab.evaluate(() => {
          for (const fold of document.querySelectorAll('details')) fold.open = true;
        });
        for (const viewport of SCREENS) {
          await tab.setViewportSize(viewport);
          for (const id of h.widgetsOf(page)) {
            const width = await tab.evaluate((name) => document.querySelector(name).offsetWidth, named(id));
            assert.ok(width > 300, `${id} is ${width} px wide`);
            const places = widths.get(id);
            // Pages that give it the same place count once.
            if (!places.some((place) => place.viewport === viewport && place.width === width)) places.push({ viewport, width });
          }
        }
      }, { path: h.addressOf(page), options: { viewport: SCREENS[0], deviceScaleFactor: 1 } });
    }
  });

  for (const { id } of h.schema) {
    it(`is cut in no place that it has, neither at the end of a run nor after a drag: ${id}`, async () => {
      await visit(`<div><slam-widget name="${id}"></slam-widget></div>`, async (tab) => {
        const cut = [];
        const keep = async (when) => {
          assert.ok(widths.get(id).length >= SCREENS.length);
          for (const { viewport, width } of widths.get(id)) {
            await tab.setViewportSize(viewport);
            await tab.evaluate((px) => { document.querySelector('div').style.width = `${px}px`; }, width);
            await h.quiet(tab);
            const [words, hidden] = await tab.evaluate(() => {
              const line = document.querySelector('slam-widget').shadowRoot.querySelector('.verdict p');
              return [line.textContent, line.scrollHeight - line.clientHeight];
            });
            if (hidden > 1) cut.push(`${when} at ${viewport.width}×${viewport.height}, ${width} px wide: ${hidden} px of “${words}”`);
          }
        };
        const press = async (button) => {
          await tab.evaluate((name) => document.querySelector('slam-widget').press(name), button);
          await h.quiet(tab);
        };
        await h.ready(tab);
        await keep('at rest');
        if (id === 'w16.10') {
          await press('sample');
          await tab.waitForFunction(() => document.querySelector('slam-widget').outcome.facts.done_percent === 100);
          await keep('with a log');
        } else {
          await press('play');
          await keep('after its run');
          await press('defaults');
          await tab.setViewportSize(SCREENS[0]);
          const [x, y] = await grabbingSpot(tab, 'slam-widget');
          await tab.mouse.move(x, y);
          await tab.mouse.down();
          await tab.mouse.move(x + 40, y + 25, { steps: 4 });
          await tab.mouse.up();
          await keep('after a drag');
        }
        assert.deepEqual(cut, []);
      }, { options: { viewport: SCREENS[0], deviceScaleFactor: 1 } });
    });
  }
});

describe('a frame of 800 × 600', () => {
  for (const { id } of h.schema) {
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
        const timeline = spec.params.find(({ kind }) => kind === 'timeline');
        if (timeline === undefined || spec.id === 'w16.10') return;
        await tab.evaluate((last) => document.querySelector('slam-widget').set(...last), [timeline.id, timeline.max]);
        await h.quiet(tab);
        const number = tab.locator('.transport input[type="number"]');
        const [value, hidden] = await number.evaluate((field) => [field.value, field.scrollWidth - field.clientWidth]);
        assert.ok(value.length > 0 && hidden <= 0, `${hidden} px of ${value}, the last number of the timeline, are hidden`);
      });
    });
  }

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
