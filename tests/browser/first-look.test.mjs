// What a reader sees before and at the first act: a page that does not jump, the chosen colours, targets for a finger, a
// cursor that stays, challenges that tick themselves.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';
import { grabbingSpot, restingSpot } from './spots.mjs';

const visit = h.visitor();
const at = (path, test, options = {}) => visit('', test, { path, options });

/** The sum of the layout shifts of a page so far, and what moved. */
const shifts = (tab) => tab.evaluate(() => new Promise((told) => {
  const seen = [];
  const observer = new PerformanceObserver((list) => seen.push(...list.getEntries()));
  observer.observe({ type: 'layout-shift', buffered: true });
  requestAnimationFrame(() => requestAnimationFrame(() => {
    seen.push(...observer.takeRecords());
    const nodes = seen.flatMap(({ sources }) => sources.map(({ node }) => node?.className ?? ''));
    told({ sum: seen.reduce((sum, { value }) => sum + value, 0), nodes });
  }));
}));

/** Opens a page whose scripts arrive after its first paint, as over a slow connection. */
async function openSlowly(tab, url) {
  const scripts = /slam-widget-\w+\.js$/;
  let release;
  const painted = new Promise((done) => { release = done; });
  await tab.route(scripts, async (route) => {
    await painted;
    await route.continue();
  });
  try {
    await tab.goto(url, { waitUntil: 'commit' });
    await tab.waitForFunction(() => performance.getEntriesByName('first-contentful-paint').length > 0);
  } finally {
    release();
  }
  await tab.waitForLoadState();
  await tab.unroute(scripts);
}

describe('a page as it loads', () => {
  for (const [width, height] of [[1440, 900], [1280, 680], [768, 1024], [390, 844]]) {
    for (const page of h.PAGES) {
      it(`does not jump: ${page} at ${width}×${height}`, async () => {
        await visit('', async (tab, { url }) => {
          await openSlowly(tab, `${url}/${page}`);
          await tab.waitForSelector('.reading', { state: 'attached' });
          await h.quiet(tab);
          const { sum, nodes } = await shifts(tab);
          // A tenth is the limit of Core Web Vitals.
          assert.ok(sum < 0.05, `${sum}: ${nodes}`);
        }, { options: { viewport: { width, height } } });
      });
    }
  }

  it('has its head and its text in line on a wide screen', async () => {
    await at('/index.html', async (tab) => {
      const [head, text] = await tab.evaluate(() => ['.masthead h1', '.beside > section p'].map((css) =>
        document.querySelector(css).getBoundingClientRect().left));
      assert.ok(Math.abs(head - text) <= 1, `${head} and ${text}`);
    }, { viewport: { width: 1440, height: 900 } });
  });
});

describe('the colours that a reader chooses', () => {
  it('stay on the next page and after a reload, and are forgotten with Auto', async () => {
    await at('/index.html', async (tab, { url }) => {
      const theme = () => tab.evaluate(() => document.documentElement.dataset.theme ?? 'auto');
      const pressed = () => tab.locator('[data-theme-choice][aria-pressed="true"]').getAttribute('data-theme-choice');
      await tab.click('[data-theme-choice="dark"]');
      for (const go of [() => tab.goto(`${url}/robots.html`), () => tab.reload()]) {
        await go();
        assert.equal(await theme(), 'dark');
        await tab.waitForSelector('.reading', { state: 'attached' });
        assert.equal(await pressed(), 'dark');
      }
      await tab.click('[data-theme-choice="auto"]');
      assert.equal(await tab.evaluate(() => localStorage.length), 0);
      await tab.reload();
      assert.equal(await theme(), 'auto');
    });
  });
});

describe('what can be pressed', () => {
  for (const page of h.PAGES) {
    it(`is at least 24 pixels large: ${page}`, async () => {
      await at(`/${page}`, async (tab) => {
        await tab.waitForSelector('.reading', { state: 'attached' });
        for (const width of [1280, 390]) {
          await tab.setViewportSize({ width, height: 900 });
          const small = await tab.evaluate(() => [...document.querySelectorAll('a, button, input, summary')]
            .map((one) => [one, one.getBoundingClientRect()])
            .filter(([one, { width, height }]) => width > 0 && (width < 24 || height < 24) && !one.closest('.skip, label'))
            .map(([one, { width, height }]) => `${one.tagName} ${one.className} “${one.textContent.slice(0, 20)}” ${width.toFixed(0)}×${height.toFixed(0)}`));
          assert.deepEqual(small, [], `${width} px wide`);
        }
      });
    });
  }
});

describe('a handle under the pointer', () => {
  it('has its effect beside it, and the paper has nothing', async () => {
    await visit('<slam-widget name="w16.8"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const rest = await restingSpot(tab);
      const spots = await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        const { left, top, width, height } = widget.shadowRoot.querySelector('canvas').getBoundingClientRect();
        const grid = (length) => Array.from({ length: Math.floor(length / 12) }, (_, at) => 12 * at);
        return grid(height).flatMap((y) => grid(width).map((x) => [x, y]))
          .filter(([x, y]) => widget.dragsAt(x, y)).map(([x, y]) => [left + x, top + y]);
      });
      const titleAt = async (spot) => {
        await tab.mouse.move(...spot);
        await h.moreFrames(tab, 2);
        return tab.evaluate(() => document.querySelector('slam-widget').shadowRoot.querySelector('canvas').title);
      };
      // Where a finger grabs the box, some spots are too far from it for the mouse.
      let title = '';
      while (!title && spots.length > 0) title = await titleAt(spots.pop());
      assert.equal(title, 'drag the box');
      assert.equal(await titleAt(rest), '');
    });
  });
});

describe('a widget before the first act', () => {
  for (const { id, title, gesture, claim } of h.schema) {
    it(`asks in its title, keeps the cursor of a grab, and says a verdict only afterwards: ${id}`, async () => {
      await visit(`<slam-widget name="${id}"></slam-widget>`, async (tab) => {
        await h.ready(tab);
        await h.quiet(tab);
        const line = tab.locator('slam-widget .verdict');
        assert.equal(await tab.locator('slam-widget .title').textContent(), `${id.slice(1)}${title}`);
        assert.equal(await line.textContent(), gesture);
        // Without a log there is nothing to judge.
        if (id === 'w16.10') return;
        const cursor = () => tab.evaluate(() => document.querySelector('slam-widget').shadowRoot.querySelector('canvas').style.cursor);
        await tab.mouse.move(...await grabbingSpot(tab));
        await tab.mouse.down();
        for (let frame = 0; frame < 4; frame += 1) {
          await h.moreFrames(tab, 2);
          assert.equal(await cursor(), 'grabbing');
        }
        await tab.mouse.up();
        await h.moreFrames(tab, 2);
        assert.notEqual(await cursor(), 'grabbing');
        await tab.evaluate(() => document.querySelector('slam-widget').press('defaults'));
        await tab.evaluate(() => document.querySelector('slam-widget').press('play'));
        await h.quiet(tab);
        const { verdict } = await tab.evaluate(() => document.querySelector('slam-widget').outcome);
        assert.equal(await line.locator('strong').textContent().then((words) => words.slice(2)), verdict);
        assert.equal(await line.locator('.gesture').count(), 0);
        assert.equal(await line.locator('.claim').textContent(), claim);
      });
    });
  }

  it('asks while a run plays whose end is the answer, and shows its marks with the verdict', async () => {
    await visit('<slam-widget name="w16.6"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const seen = () => tab.evaluate(() => {
        const root = document.querySelector('slam-widget').shadowRoot;
        return [root.querySelector('.verdict .gesture') !== null, root.querySelectorAll('.marks i').length > 0];
      });
      for (const _ of [1, 2]) {
        assert.deepEqual(await seen(), [true, false]);
        await tab.evaluate(() => document.querySelector('slam-widget').press('play'));
        await h.moreFrames(tab, 3);
      }
      await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        widget.set('progress', widget.timeline.last);
      });
      await h.moreFrames(tab, 1);
      assert.deepEqual(await seen(), [false, true]);
    });
  });

  it('that waits for a log counts no keyframes', async () => {
    await visit('<slam-widget name="w16.10"></slam-widget>', async (tab) => {
      await h.ready(tab);
      await h.quiet(tab);
      const timeline = tab.locator('slam-widget .timeline');
      assert.equal(await timeline.isVisible(), false);
      await tab.evaluate(() => { document.querySelector('slam-widget').set('more', true); });
      await timeline.waitFor();
      for (const part of ['.unit', 'input[type="number"]']) assert.equal(await timeline.locator(part).isVisible(), false, part);
    });
  });
});

describe('a challenge', () => {
  const challenge = (tab, id) => tab.locator(`.challenge[data-widget="${id}"]`).first();
  const score = (tab) => tab.locator('.score output').textContent();

  it('ticks itself when it is met, counts, and is kept on request only', async () => {
    await at('/index.html', async (tab, { url }) => {
      const css = 'slam-widget[name="w16.5"]';
      await tab.locator(css).scrollIntoViewIfNeeded();
      await h.ready(tab, css);
      assert.equal(await tab.locator('.score').isVisible(), false);
      await tab.evaluate((name) => document.querySelector(name).set('turn3', 180), css);
      await tab.waitForSelector('.challenge.met');
      assert.equal(await challenge(tab, 'w16.5').locator('.challenge-says a').textContent(), 'Show it again');
      assert.match(await score(tab), /^1 of 1[0-9]$/);
      // It stays.
      await tab.evaluate((name) => document.querySelector(name).press('defaults'), css);
      await h.quiet(tab);
      assert.equal(await tab.locator('.challenge.met').count(), 1);
      assert.equal(await tab.evaluate(() => localStorage.length), 0, 'nothing is kept unasked');
      await tab.locator('.score input').check();
      await tab.goto(`${url}/robots.html`);
      await tab.waitForSelector('.reading', { state: 'attached' });
      assert.match(await score(tab), /^1 of/);
      await tab.locator('.score input').uncheck();
      assert.equal(await tab.evaluate(() => localStorage.length), 0);
    }, { viewport: { width: 1440, height: 900 } });
  });

  it('is not met by a link that shows its state', async () => {
    await at('/index.html', async (tab) => {
      const css = 'slam-widget[name="w16.11"]';
      await tab.locator(css).scrollIntoViewIfNeeded();
      await h.ready(tab, css);
      await tab.locator('a.slam-link', { hasText: 'a bare wall' }).first().evaluate((a) => a.click());
      await h.quiet(tab);
      assert.equal(await tab.locator('.challenge.met').count(), 0);
    }, { viewport: { width: 1440, height: 900 } });
  });
});
