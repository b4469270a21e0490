// Scrolling to a widget by link, and no layout shifts around it.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const chapter = (path, test, how) => visit('', test, { path, ...how });
const named = (id) => `slam-widget[name="${id}"]`;

/** Init script: records every height of a widget. */
function keepHeights() {
  window.heights = {};
  addEventListener('DOMContentLoaded', () => {
    const observer = new ResizeObserver((entries) => {
      for (const { target } of entries) (heights[target.getAttribute('name')] ??= []).push(target.offsetHeight);
    });
    // Before its definition it is a still picture.
    void customElements.whenDefined('slam-widget').then(() => {
      for (const widget of document.querySelectorAll('slam-widget')) observer.observe(widget);
    });
  });
}
const head = `<script>(${keepHeights})()</script>`;

describe('a link to a state', () => {
  for (const { id } of h.schema) {
    it(`scrolls the page to ${id}, despite layout shifts`, async () => {
      await chapter(`${h.pageOf(id)}?w=${id.slice(1)}`, async (tab) => {
        await h.ready(tab, named(id));
        // A widget taller than the screen is aligned to its top.
        await tab.waitForFunction((css) => {
          const { top } = document.querySelector(css).getBoundingClientRect();
          return top >= 0 && top < 100;
        }, named(id));
      });
    });
  }

  for (const [old, page] of [
    ['?w=16.10', '/own-robot.html'], ['#own-robot', '/own-robot.html'], ['?w=w16.6&heading=60', '/robots.html'],
    ['#production', '/robots.html'], ['#umeyama1991', '/reference.html'], ['#exercise-7', '/robots.html'],
    ['?theme=dark#differences', '/reference.html'],
  ]) {
    it(`redirects from the former single page: ${old}`, async () => {
      await chapter(`/index.html${old}`, async (tab) => {
        await tab.waitForURL((url) => url.pathname === page);
        assert.ok(tab.url().endsWith(`${page}${old}`), tab.url());
      });
    });
  }

  it('stays on a page that has its target, or if no page has it', async () => {
    for (const address of ['/index.html?w=16.2', '/index.html#exercises', '/robots.html?w=16.99', '/reference.html#nowhere']) {
      await chapter(address, async (tab) => {
        await tab.waitForFunction(() => document.documentElement.dataset.script === 'on');
        assert.ok(tab.url().includes(address), tab.url());
      }, { quiet: false });
    }
  });

  it('stops scrolling once the reader scrolls', async () => {
    await chapter('/index.html?w=16.3', async (tab) => {
      await h.ready(tab, named('w16.3'));
      await tab.mouse.move(5, 5);
      await tab.mouse.wheel(0, -600);
      const top = () => tab.evaluate((css) => document.querySelector(css).getBoundingClientRect().top, named('w16.3'));
      await tab.waitForFunction((css) => document.querySelector(css).getBoundingClientRect().top > 500, named('w16.3'));
      // The page grows above the viewport: the browser anchors the scroll position, and no script scrolls back.
      await tab.evaluate(() => document.querySelector('main').style.setProperty('padding-bottom', '900px'));
      await h.quiet(tab);
      assert.ok((await top()) > 500);
    });
  });
});

/** Line breaks depend slightly on the pixel ratio: this is the most common one. */
const deviceScaleFactor = 1;

describe('a widget', () => {
  for (const width of [1100, 390]) {
    it(`has the same height before it starts, while it draws, and while it rests, ${width} px wide`, async () => {
      // Far enough apart that one rests before the next one starts.
      const apart = '<div style="height: 30000px"></div>';
      const body = h.schema.map(({ id }) => `<slam-widget name="${id}"></slam-widget>${apart}`).join('');
      await visit(head + body, async (tab) => {
        for (const { id } of h.schema) {
          await tab.evaluate((css) => document.querySelector(css).scrollIntoView(), named(id));
          await h.ready(tab, named(id));
          await tab.evaluate((css) => scrollTo(0, document.querySelector(css).offsetTop + 15000), named(id));
          await tab.waitForFunction((css) => document.querySelector(css).state === 'resting', named(id));
          const heights = await tab.evaluate((name) => window.heights[name], id);
          const spread = Math.max(...heights) - Math.min(...heights);
          // Less than a line of text with its spacing.
          assert.ok(heights[0] > 400 && spread <= 17, `${id} was ${heights.join(', ')} px high`);
        }
      }, { options: { deviceScaleFactor, viewport: { width, height: 800 } } });
    });
  }
});

/** The first controls of a widget beside its text. */
const opening = ({ id, opening: first }) => (['w16.1', 'w16.2', 'w16.3', 'w16.4'].includes(id) ? first : []);

/** Screens with the widget beside the text. */
const WIDE = [{ width: 1440, height: 900 }, { width: 1100, height: 900 }, { width: 1280, height: 800 }];

describe('a widget beside its text', () => {
  for (const spec of h.schema.filter((spec) => opening(spec).length > 0)) {
    it(`shows scene, control and verdict together on wide screens: ${spec.id}`, async () => {
      const css = named(spec.id);
      await chapter(`${h.pageOf(spec.id)}?w=${spec.id.slice(1)}`, async (tab) => {
        await h.ready(tab, css);
        for (const viewport of WIDE) {
          await tab.setViewportSize(viewport);
          await tab.evaluate((name) => document.querySelector(name).scrollIntoView(), css);
          await h.quiet(tab);
          const seen = await tab.evaluate(([name, controls]) => {
            const element = document.querySelector(name);
            const { top } = element.shadowRoot.querySelector('canvas').getBoundingClientRect();
            const box = ([, y, , height]) => [top + y, top + y + height];
            return {
              position: getComputedStyle(element).position,
              hidden: element.scrollHeight - element.clientHeight,
              boxes: [box(element.sceneBox()), ...controls.map((control) => {
                const at = element.shadowRoot.querySelector(`.control:not([hidden]) [data-control="${control}"]`).getBoundingClientRect();
                return [at.top, at.bottom];
              })],
            };
          }, [css, opening(spec)]);
          const where = `at ${viewport.width}×${viewport.height}`;
          assert.equal(seen.position, 'sticky', where);
          assert.ok(seen.hidden <= 1, `${seen.hidden} px are hidden ${where}`);
          for (const [top, bottom] of seen.boxes) {
            assert.ok(top >= 0 && bottom <= viewport.height, `${JSON.stringify(seen.boxes)} ${where}`);
          }
          const [scene] = seen.boxes;
          // The maps of w16.3 are the smallest.
          assert.ok(scene[1] - scene[0] >= 0.1 * viewport.height, `the scene has ${scene[1] - scene[0]} px ${where}`);
        }
      }, { options: { deviceScaleFactor, viewport: WIDE[0] } });
    });
  }

  for (const [width, height] of [[1440, 900], [390, 844]]) {
    for (const page of h.PAGES.filter((file) => file !== 'break.html' && h.widgetsOf(file).length > 0)) {
      it(`leaves the controls in place when More opens: ${page}, ${width} px wide`, async () => {
        await chapter(h.addressOf(page), async (tab) => {
          await h.withoutLaps(tab);
          // On a phone the maps of w16.1 are a part of its picture, which enters with the second start or with More.
          for (const id of h.widgetsOf(page).filter((name) => name !== 'w16.1' || width > 500)) {
            const css = named(id);
            await h.unfold(tab, css);
            await tab.evaluate((name) => document.querySelector(name).scrollIntoView(), css);
            await h.ready(tab, css);
            await h.quiet(tab);
            const more = tab.locator(`${css} button[data-control="more"]`);
            if (await more.count() === 0) continue;
            const top = () => tab.evaluate((name) => {
              const { shadowRoot } = document.querySelector(name);
              const [control, frame] = ['#control-more', '.frame'].map((one) => shadowRoot.querySelector(one).getBoundingClientRect());
              return control.top - frame.top;
            }, css);
            const closed = await top();
            await more.click();
            await h.quiet(tab);
            // 1.5: the height of a canvas is a whole number of pixels.
            assert.ok(Math.abs((await top()) - closed) <= 1.5, `${id}: ${closed} and ${await top()}`);
          }
        }, { options: { deviceScaleFactor, viewport: { width, height } } });
      });
    }
  }

  it('opens More below the picture, without a move of the picture and without a scroller of its own', async () => {
    await chapter('/index.html?w=16.1', async (tab) => {
      const css = named('w16.1');
      await h.ready(tab, css);
      await h.quiet(tab);
      const seen = () => tab.evaluate((name) => {
        const element = document.querySelector(name);
        return { top: element.getBoundingClientRect().top, hidden: element.scrollHeight - element.clientHeight, high: element.offsetHeight };
      }, css);
      const closed = await seen();
      const more = tab.locator(`${css} button[data-control="more"]`);
      await more.click();
      await h.quiet(tab);
      const open = await seen();
      assert.ok(Math.abs(open.top - closed.top) <= 1, `${closed.top} and ${open.top}`);
      assert.ok(open.hidden <= 1 && open.high > closed.high + 300, JSON.stringify(open));
      await tab.evaluate(() => scrollBy(0, 300));
      assert.ok(Math.abs((await seen()).top - open.top + 300) <= 1, 'it scrolls with the page');
      await more.click();
      await h.quiet(tab);
      const again = await seen();
      assert.equal(again.high, closed.high);
    }, { options: { deviceScaleFactor, viewport: { width: 1440, height: 900 } } });
  });
});
