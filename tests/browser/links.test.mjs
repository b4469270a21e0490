// Links in the text: the scene beside them, the browser's history, and Back.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const reading = (test, options = {}) => visit('', test, { path: '/index.html', options });
const widget = (id) => `slam-widget[name="${id}"]`;
const get = (tab, id, param) => tab.evaluate(([css, name]) => document.querySelector(css).get(name), [widget(id), param]);
const has = (tab, id, param, value) => tab.waitForFunction(
  ([css, name, wanted]) => document.querySelector(css).get(name) === wanted, [widget(id), param, value]);
const link = (tab, words) => tab.locator('main a.slam-link', { hasText: words }).first();
const wayBack = (tab) => tab.locator('.slam-way-back button', { hasText: 'Back to' });
const scrolled = (tab) => tab.evaluate(() => Math.round(scrollY));

describe('a link in the text', () => {
  it('changes the scene beside it without a jump, on a wide screen', async () => {
    await reading(async (tab) => {
      for (const [id, words] of [['w16.1', '75°'], ['w16.1', 'Turn the sweep by 180°'], ['w16.3', 'large ones'], ['w16.2', 'last']]) {
        await link(tab, words).scrollIntoViewIfNeeded();
        await tab.evaluate((css) => document.querySelector(css).scrollIntoView({ block: 'nearest' }), widget(id));
        await link(tab, words).evaluate((a) => a.scrollIntoView({ block: 'center' }));
        const before = await scrolled(tab);
        const query = await tab.evaluate((css) => document.querySelector(css).query, widget(id));
        const { top, bottom } = await tab.evaluate((css) => document.querySelector(css).getBoundingClientRect(), widget(id));
        assert.ok(top >= 0 && top < 200 && bottom > 450, `${id} stands at ${top} to ${bottom}`);
        await link(tab, words).click();
        await tab.waitForFunction(([css, old]) => document.querySelector(css).query !== old, [widget(id), query]);
        await h.quiet(tab);
        assert.equal(await scrolled(tab), before, words);
        assert.equal(await wayBack(tab).count(), 0);
      }
    }, { viewport: { width: 1100, height: 900 } });
  });

  it('plays to its state if it names no moment: 75° runs its iterations', async () => {
    await reading(async (tab) => {
      await link(tab, '75°').scrollIntoViewIfNeeded();
      await h.ready(tab, widget('w16.1'));
      await link(tab, '75°').click();
      const run = () => tab.evaluate((css) => document.querySelector(css).timeline, widget('w16.1'));
      await tab.waitForFunction((css) => document.querySelector(css).timeline.playing, widget('w16.1'));
      await tab.waitForFunction((css) => !document.querySelector(css).timeline.playing, widget('w16.1'));
      assert.equal(await get(tab, 'w16.1', 'iteration'), (await run()).last);
      assert.equal(await tab.evaluate((css) => document.querySelector(css).outcome.verdict, widget('w16.1')), 'quarter turn');
      // One that names a moment shows that.
      await link(tab, 'last').click();
      await has(tab, 'w16.2', 't', 119);
      await h.quiet(tab);
      assert.equal(await get(tab, 'w16.2', 't'), 119);
    });
  });

  it('is a history entry: Back restores the state before it, and stays on the page', async () => {
    await reading(async (tab) => {
      const path = await tab.evaluate(() => location.pathname);
      const start = await get(tab, 'w16.1', 'heading');
      await link(tab, '75°').click();
      await has(tab, 'w16.1', 'heading', 75);
      await link(tab, '45°').click();
      await has(tab, 'w16.1', 'heading', 45);
      // Changes by the reader between two links are restored, too.
      await tab.evaluate((css) => document.querySelector(css).set('tau', 1.1), widget('w16.1'));
      await link(tab, 'last').click();
      await has(tab, 'w16.2', 't', 119);
      assert.match(tab.url(), /w=16.2&t=119/);
      await tab.goBack();
      await has(tab, 'w16.2', 't', 92);
      assert.equal(await get(tab, 'w16.1', 'tau'), 1.1);
      await tab.goBack();
      await has(tab, 'w16.1', 'heading', 75);
      assert.equal(await get(tab, 'w16.1', 'tau'), 0.7);
      await tab.goBack();
      await has(tab, 'w16.1', 'heading', start);
      await tab.goForward();
      await has(tab, 'w16.1', 'heading', 75);
      assert.equal(await tab.evaluate(() => location.pathname), path);
    });
  });

  it('stays in the address, even if another widget settles after it', async () => {
    await reading(async (tab) => {
      await tab.locator(widget('w16.1')).scrollIntoViewIfNeeded();
      await h.ready(tab, widget('w16.1'));
      const addresses = await link(tab, 'last').evaluate((a, [one, other]) => {
        const result = (css, param, value) => new Promise((told) => {
          document.querySelector(css).addEventListener('slam-result', ({ detail }) => {
            if (detail.value[param] === value) told();
          });
        });
        const seen = [];
        document.querySelector(one).set('tau', 1.1);
        a.click();
        window.navigation.addEventListener('currententrychange', () => seen.push(location.search));
        return Promise.all([result(one, 'tau', 1.1), result(other, 't', 119)]).then(() => seen);
      }, [widget('w16.1'), widget('w16.2')]);
      assert.ok(addresses.length > 0);
      for (const address of addresses) assert.match(address, /w=16.2&t=119/);
      await tab.evaluate(([css, tau]) => document.querySelector(css).set('tau', tau), [widget('w16.1'), 1.3]);
      await tab.waitForURL(/w=16.1.*tau=1.3/);
    });
  });

  it('removes parameters of other widgets from the address, and keeps those of the page', async () => {
    await visit('', async (tab) => {
      await link(tab, 'last').click();
      await tab.waitForURL(/w=16.2&t=119/);
      await link(tab, '45°').click();
      await tab.waitForURL(/w=16\.1&/);
      const search = new URL(tab.url()).searchParams;
      assert.deepEqual(Object.fromEntries(search), { theme: 'light', w: '16.1', dx: '0', dy: '0', heading: '45' });
      // The link plays its run meanwhile.
      const shown = await tab.evaluate((css) => document.querySelector(css).link, widget('w16.1'));
      assert.equal(shown.replace(/&iteration=\d+/, ''), tab.url());
      // Opening the address reports no problems.
      await tab.goto(tab.url());
      await has(tab, 'w16.1', 'heading', 45);
      assert.equal(await tab.locator('slam-widget .note p').count(), 0);
    }, { path: '/index.html?theme=light' });
  });

  it('that scrolls away shows a button back to its sentence', async () => {
    await reading(async (tab) => {
      const here = tab.locator('.legend a.slam-link');
      await here.evaluate((a) => a.scrollIntoView({ block: 'center' }));
      await here.click();
      await tab.waitForFunction((css) => document.querySelector(css).getBoundingClientRect().top < innerHeight, widget('w16.1'));
      assert.equal(await wayBack(tab).textContent(), 'Back to “60°”');
      await wayBack(tab).click();
      assert.equal(await wayBack(tab).count(), 0);
      assert.ok(await here.evaluate((a) => {
        const { top, bottom } = a.getBoundingClientRect();
        return document.activeElement === a && top > 0 && bottom < innerHeight;
      }));
      assert.equal(await get(tab, 'w16.1', 'heading'), 60, 'the widget stays as the link has set it');
    });
  });

  it('hides its back button when the reader closes it or scrolls two screens further', async () => {
    await reading(async (tab) => {
      const here = link(tab, 'τ = 0.1 m');
      const led = async () => {
        await here.evaluate((a) => {
          for (let fold = a.closest('details'); fold; fold = fold.parentElement.closest('details')) fold.open = true;
          a.scrollIntoView({ block: 'center' });
        });
        await here.click();
        await tab.waitForFunction((css) => document.querySelector(css).getBoundingClientRect().top < innerHeight, widget('w16.1'));
        await wayBack(tab).waitFor();
      };
      await led();
      await tab.getByRole('button', { name: 'Stay here' }).click();
      assert.equal(await wayBack(tab).count(), 0);
      await led();
      // A wheel event ends the alignment of the widget.
      const scrollOn = async (screens) => {
        const from = await scrolled(tab);
        await tab.mouse.move(200, 400);
        await tab.mouse.wheel(0, screens * 844);
        await tab.waitForFunction(([y, least]) => scrollY - y > least * innerHeight, [from, screens - 0.1]);
        await h.quiet(tab);
      };
      await scrollOn(1);
      assert.equal(await wayBack(tab).count(), 1, 'one screen on, it is still there');
      await scrollOn(1.2);
      assert.equal(await wayBack(tab).count(), 0, 'two screens on');
    }, { viewport: { width: 390, height: 844 } });
  });

  it('has a back button, and so has an answer that is shown in its widget', async () => {
    await reading(async (tab) => {
      await tab.locator('#further-variants summary').first().click();
      const question = tab.locator('#further-variants slam-predict');
      await question.scrollIntoViewIfNeeded();
      await tab.waitForFunction(() => customElements.get('slam-predict') !== undefined);
      await question.locator('input').first().check();
      await question.locator('button').first().click();
      const show = question.getByRole('button', { name: 'Show it in the widget' });
      await show.click();
      await tab.waitForFunction((css) => {
        const { top, bottom } = document.querySelector(css).getBoundingClientRect();
        return top < innerHeight && bottom > 0;
      }, widget(await question.getAttribute('widget')));
      assert.equal(await wayBack(tab).textContent(), 'Back to the question');
      await wayBack(tab).click();
      assert.equal(await wayBack(tab).count(), 0);
      assert.ok(await show.evaluate((element) => {
        const { top, bottom } = element.getBoundingClientRect();
        return element.getRootNode().activeElement === element && top > 0 && bottom < innerHeight;
      }));
    }, { viewport: { width: 390, height: 844 } });
  });

  it('sets its widget to exactly the named state, for every link', async () => {
    let count = 0;
    for (const page of h.PAGES) {
      await visit('', async (tab) => {
        const asked = await tab.evaluate(() => [...document.querySelectorAll('a.slam-link[href^="?"]')].map((a) => {
          a.closest('details')?.setAttribute('open', '');
          a.click();
          const query = new URLSearchParams(a.search);
          const element = document.querySelector(`slam-widget[name="w${query.get('w')}"]`);
          // A switch is a boolean for scripts, and on or off in a link.
          const said = (value) => ({ true: 'on', false: 'off' })[value] ?? String(value);
          const wrong = [...query].filter(([id, text]) => id !== 'w' && said(element.get(id)) !== text);
          const back = new URLSearchParams(location.search);
          return { href: a.search, wrong, kept: [...query].every(([id, text]) => id === 'w' || back.get(id) === text
            || !element.query.includes(`${id}=`)) };
        }));
        count += asked.length;
        for (const { href, wrong, kept } of asked) assert.deepEqual([wrong, kept], [[], true], href);
      }, { path: `/${page}` });
    }
    assert.ok(count >= 24, `${count} links`);
  });

  it('leads to the page of its widget, in that state', async () => {
    await visit('', async (tab) => {
      const elsewhere = tab.locator('main a.slam-link[href^="index.html?"]').first();
      await elsewhere.evaluate((a) => a.closest('details')?.setAttribute('open', ''));
      await elsewhere.click();
      await tab.waitForURL(/\/index\.html\?w=16\.1&heading=40/);
      await has(tab, 'w16.1', 'heading', 40);
    }, { path: '/reference.html' });
  });
});

describe('on a narrow screen', () => {
  it('the scene stays in view while the reader moves a slider below it', async () => {
    await reading(async (tab) => {
      const css = widget('w16.3');
      await tab.locator(css).scrollIntoViewIfNeeded();
      await h.ready(tab, css);
      await tab.evaluate((name) => (document.querySelector(name).more = true), css);
      await h.quiet(tab);
      // At this slider the picture is out of view.
      await tab.evaluate((name) => {
        const element = document.querySelector(name);
        scrollBy(0, element.shadowRoot.querySelector('#control-cells').getBoundingClientRect().top - 0.7 * innerHeight);
      }, css);
      const pinned = () => tab.evaluate((name) => {
        const copy = document.querySelector(name).shadowRoot.querySelector('.pinned');
        if (copy === null) return null;
        const { top, bottom, left, right } = copy.getBoundingClientRect();
        const { data } = copy.getContext('2d').getImageData(0, 0, copy.width, copy.height);
        return { top, bottom, left, right, colors: new Set(new Uint32Array(data.buffer)).size };
      }, css);
      const isPinned = (wanted) => tab.waitForFunction(
        ([name, is]) => (document.querySelector(name).shadowRoot.querySelector('.pinned') !== null) === is, [css, wanted]);
      const at = await tab.evaluate((name) => {
        const element = document.querySelector(name);
        const { left, top, width, height } = element.shadowRoot.querySelector('#control-cells').getBoundingClientRect();
        return [left + 0.3 * width, top + height / 2];
      }, css);
      await h.quiet(tab);
      assert.equal(await pinned(), null);
      await tab.mouse.move(...at);
      await tab.mouse.down();
      await isPinned(true);
      // The copy is drawn with the next frame.
      await h.moreFrames(tab, 2, css);
      const shown = await pinned();
      assert.ok(shown.top === 0 && shown.bottom < at[1] - 20 && shown.colors > 3, JSON.stringify(shown));
      assert.ok(shown.left >= 0 && shown.right <= 390);
      // The last frames before it rests paint nothing, and leave the canvas empty.
      await h.quiet(tab);
      const rested = await pinned();
      assert.ok(rested.colors > 3, `a copy of ${rested.colors} colours`);
      await tab.mouse.up();
      await isPinned(false);
    }, { viewport: { width: 390, height: 844 }, sees: true });
  });
});

describe('a folded exercise', () => {
  it('opens for the address that names it, and for one that sets its widget', async () => {
    const isOpen = (tab, id) => tab.waitForFunction((name) => document.querySelector(`#${name} > details`).open, id);
    await visit('', async (tab) => {
      await isOpen(tab, 'exercise-2');
      assert.equal(await tab.locator('#exercise-5 > details').getAttribute('open'), null);
      await tab.evaluate(() => { location.hash = 'exercise-5'; });
      await isOpen(tab, 'exercise-5');
    }, { path: '/index.html#exercise-2' });
    await visit('', async (tab) => {
      await isOpen(tab, 'exercise-3');
      await h.ready(tab, widget('w16.12'));
    }, { path: '/index.html?w=16.12&bias=3' });
  });
});
