// The element on a page: it paints, takes values in every way, and tells what happens.

import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import * as h from './harness.mjs';

const names = h.schema.map((widget) => widget.id);
const page = (body, head) => ({ '/t.html': h.bare(body, head) });

let browser;
before(async () => (browser = await h.launch()));
after(() => browser.close());

/** Opens a page with that body, runs the test on it, expects no trouble, and closes all. */
async function on(body, test, { options, head, url = '', troubles = true } = {}) {
  const server = await h.serve({ pages: page(body, head) });
  const tab = await h.open(browser, `${server.url}/t.html${url}`, options);
  try {
    await test(tab, server);
    if (troubles) assert.deepEqual(tab.troubles, []);
  } finally {
    await tab.context().close();
    await server.close();
  }
}

describe('every widget', () => {
  for (const name of names) {
    it(`${name} paints something other than background, in light and dark`, async () => {
      for (const theme of ['light', 'dark']) {
        await on(`<slam-widget name="${name}" theme="${theme}"></slam-widget>`, async (tab) => {
          await h.ready(tab);
          const { share, colors } = await h.paintedShare(tab);
          assert.ok(share > 0.03, `${theme}: ${share} of the pixels differ`);
          assert.ok(colors > 20, `${theme}: ${colors} colours`);
        });
      }
    });

    it(`${name} fits into 390 pixels without scrolling sideways`, async () => {
      const options = { viewport: { width: 390, height: 800 }, deviceScaleFactor: 2 };
      await on(`<slam-widget name="${name}"></slam-widget>`, async (tab) => {
        await h.ready(tab);
        const [wide, high] = await tab.evaluate(() => [
          document.documentElement.scrollWidth,
          document.querySelector('slam-widget').offsetHeight,
        ]);
        assert.ok(wide <= 390, `${wide} pixels wide`);
        assert.ok(high > 400, `${high} pixels high`);
      }, { options });
    });
  }
});

describe('values', () => {
  it('come in by attribute, property, value and link, and go out by all of them', async () => {
    await on('<slam-widget name="w16.1" heading="60"></slam-widget>', async (tab) => {
      const read = () => tab.evaluate(() => document.querySelector('slam-widget').value);
      assert.equal((await read()).heading, 60);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = -30.5));
      assert.equal((await read()).heading, -30.5);
      await tab.evaluate(() => document.querySelector('slam-widget').setAttribute('heading', '45'));
      assert.equal((await read()).heading, 45);
      await tab.evaluate(() => (document.querySelector('slam-widget').value = '{"heading": 12}'));
      assert.equal((await read()).heading, 12);
      assert.equal(
        await tab.evaluate(() => document.querySelector('slam-widget').query),
        '?w=16.1&heading=12',
      );
      await tab.evaluate(() => document.querySelector('slam-widget').removeAttribute('heading'));
      const spec = h.schema[0].params.find((param) => param.id === 'heading');
      assert.equal((await read()).heading, spec.default);
    });
  });

  it('reach the running widget and come back in its outcome', async () => {
    await on('<slam-widget name="w16.1" heading="60"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const before = await tab.evaluate(() => document.querySelector('slam-widget').outcome);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = 0));
      const after = await tab.evaluate(() => document.querySelector('slam-widget').outcome);
      assert.notDeepEqual(after.facts, before.facts);
      assert.ok(after.sentence.length > 10);
    });
  });

  it('that are broken are named, as text, and the default stands', async () => {
    const evil = '&lt;img src=x onerror=&quot;document.title=1&quot;&gt;';
    await on(`<slam-widget name="w16.1" heading="${evil}"></slam-widget>`, async (tab) => {
      const note = await tab.evaluate(() => {
        const { shadowRoot, heading } = document.querySelector('slam-widget');
        const element = shadowRoot.querySelector('.note');
        return { text: element.textContent, images: element.querySelectorAll('img').length, heading };
      });
      assert.match(note.text, /`heading` takes a number, not `<img/);
      assert.equal(note.images, 0);
      assert.equal(note.heading, h.schema[0].params.find((param) => param.id === 'heading').default);
      assert.equal(await tab.title(), 'Test');
    });
  });

  it('of a linked widget are read from the address and written to it', async () => {
    await on('<slam-widget name="w16.1" linked></slam-widget>', async (tab) => {
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').heading), 70);
      const note = await tab.evaluate(
        () => document.querySelector('slam-widget').shadowRoot.querySelector('.note').textContent,
      );
      assert.match(note, /has no parameter `bogus`/);
      await h.ready(tab);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = 20));
      await tab.waitForURL(/heading=20/);
    }, { url: '?w=16.1&heading=70&bogus=1' });
  });

  it('of an address that names no widget are reported once', async () => {
    const two = '<slam-widget name="w16.1" linked></slam-widget><slam-widget name="w16.2" linked></slam-widget>';
    await on(two, async (tab) => {
      const notes = await tab.evaluate(() => [...document.querySelectorAll('slam-widget')].map(
        (widget) => widget.shadowRoot.querySelector('.note').textContent));
      assert.deepEqual(notes, ['There is no widget `99`.', '']);
    }, { url: '?w=99' });
  });

  it('in an unknown widget name the widgets there are', async () => {
    await on('<slam-widget name="w99"></slam-widget>', async (tab) => {
      const note = await tab.evaluate(
        () => document.querySelector('slam-widget').shadowRoot.querySelector('.note').textContent,
      );
      assert.match(note, /There is no widget `w99`; there are w16.1/);
    });
  });
});

describe('events', () => {
  it('tell of readiness, each change, and the result once it settles', async () => {
    const head = `<script>
      window.heard = [];
      for (const type of ['slam-ready', 'slam-change', 'slam-result', 'slam-error'])
        document.addEventListener(type, (event) => heard.push([type, event.detail]));
    </script>`;
    await on('<slam-widget name="w16.1"></slam-widget>', async (tab) => {
      await h.ready(tab);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = 33));
      await tab.waitForFunction(() => heard.some(([type]) => type === 'slam-result'));
      const heard = await tab.evaluate(() => heard);
      const [ready] = heard.find(([type]) => type === 'slam-ready');
      assert.equal(ready, 'slam-ready');
      const [, change] = heard.find(
        ([type, detail]) => type === 'slam-change' && detail.parameter === 'heading',
      );
      assert.equal(change.value, 33);
      assert.equal(change.name, 'w16.1');
      const [, result] = heard.find(([type]) => type === 'slam-result');
      assert.equal(result.value.heading, 33);
      assert.ok(result.outcome.sentence.length > 10);
    }, { head });
  });
});

describe('exports', () => {
  it('save the view as PNG and every table as CSV', async () => {
    await on('<slam-widget name="w16.1"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const [picture] = await Promise.all([
        tab.waitForEvent('download'),
        tab.getByRole('button', { name: 'Save picture' }).click(),
      ]);
      assert.equal(picture.suggestedFilename(), 'w16.1.png');
      const [data] = await Promise.all([
        tab.waitForEvent('download'),
        tab.getByRole('button', { name: 'Save data' }).click(),
      ]);
      assert.match(data.suggestedFilename(), /^w16\.1-.*\.csv$/);
    });
  });

  it('print the picture of the present state in place of the canvas', async () => {
    await on('<slam-widget name="w16.1" heading="60"></slam-widget>', async (tab) => {
      await h.ready(tab);
      await tab.evaluate(() => window.dispatchEvent(new Event('beforeprint')));
      await tab.emulateMedia({ media: 'print' });
      const shown = await tab.evaluate(() => {
        const { shadowRoot } = document.querySelector('slam-widget');
        const display = (css) => getComputedStyle(shadowRoot.querySelector(css)).display;
        return { canvas: display('canvas'), picture: display('.picture'),
          source: shadowRoot.querySelector('.picture').src.slice(0, 19) };
      });
      assert.deepEqual(shown, { canvas: 'none', picture: 'block', source: 'data:image/svg+xml;' });
    });
  });
});
