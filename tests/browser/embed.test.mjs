// embed.html in a frame, also in a sandbox without an origin, and its messages.

import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import * as h from './harness.mjs';

let browser;
before(async () => (browser = await h.launch()));
after(() => browser.close());

/** A page with the widget in a frame that keeps every message that comes out. */
async function framed(query, test, { sandbox } = {}) {
  const attribute = sandbox === undefined ? '' : ` sandbox="${sandbox}"`;
  const page = `<!doctype html><html lang="en"><title>Host</title><link rel="icon" href="data:,">
    <script>window.heard = []; addEventListener('message', (event) => heard.push(event.data));</script>
    <iframe title="Widget" src="/embed.html${query}" style="width: 100%; height: 800px"${attribute}></iframe></html>`;
  const server = await h.serve({ pages: { '/host.html': page } });
  const tab = await h.open(browser, `${server.url}/host.html`);
  const conversation = {
    tab,
    post: (message) => tab.evaluate((data) => document.querySelector('iframe').contentWindow.postMessage(data, '*'), message),
    /** The first message of that type from now or before. */
    hear: async (type, where = () => true) => {
      await tab.waitForFunction((wanted) => heard.some((data) => data.type === wanted), type);
      for (let tries = 0; tries < 200; tries += 1) {
        const found = (await tab.evaluate(() => heard)).find((data) => data.type === type && where(data));
        if (found !== undefined) return found;
        await tab.evaluate(() => new Promise(requestAnimationFrame));
      }
      return assert.fail(`no ${type}`);
    },
  };
  try {
    await test(conversation);
    assert.deepEqual(tab.troubles, []);
  } finally {
    await tab.context().close();
    await server.close();
  }
}

describe('a frame', () => {
  for (const sandbox of [undefined, 'allow-scripts']) {
    it(`${sandbox === undefined ? 'of the same origin' : 'in a sandbox'} runs, is set, answers and tells`, async () => {
      await framed('?w=16.1&heading=60', async ({ post, hear }) => {
        const ready = await hear('ready');
        assert.equal(ready.slam, 1);
        assert.equal(ready.value.heading, 60);
        await post({ slam: 1, type: 'set', values: { heading: 12, variant: 'point-to-plane' } });
        const changed = await hear('changed', (data) => data.parameter === 'heading');
        assert.equal(changed.value, 12);
        const result = await hear('result', (data) => data.value.heading === 12);
        assert.ok(result.outcome.sentence.length > 10);
        await post({ slam: 1, type: 'get', id: 'q1' });
        const state = await hear('state');
        assert.equal(state.id, 'q1');
        assert.equal(state.value.variant, 'point-to-plane');
      }, { sandbox });
    });
  }

  it('tells its size, to learning management systems too', async () => {
    await framed('?w=16.1', async ({ tab, hear }) => {
      await hear('ready');
      const size = await hear('size', (data) => data.height > 500);
      const lti = (await tab.evaluate(() => heard))
        .filter((data) => typeof data === 'string').map((data) => JSON.parse(data));
      assert.ok(lti.some((data) => data.subject === 'lti.frameResize' && data.height === size.height));
    });
  });

  it('names what is wrong in its address and goes on', async () => {
    await framed('?w=16.1&heading=abc&bogus=1', async ({ hear }) => {
      await hear('error', (data) => /`heading` takes a number/.test(data.message));
      await hear('error', (data) => /has no parameter `bogus`/.test(data.message));
      await hear('ready');
    });
  });

  it('refuses messages that do not fit, and leaves those of others alone', async () => {
    await framed('?w=16.1', async ({ tab, post, hear }) => {
      await hear('ready');
      for (const [message, reason] of [
        [{ slam: 2, type: 'get' }, /speaks version 1, not 2/],
        [{ slam: 1, type: 'explode' }, /no message `explode`/],
        [{ slam: 1, type: 'set' }, /set takes `values`/],
        [{ slam: 1, type: 'set', values: { heading: 1e9 } }, /`heading` takes -180 to 180/],
        [{ slam: 1, type: 'set', values: { __proto__x: 1 } }, /has no parameter/],
        [{ slam: 1, type: 'press', button: 'nothing' }, /no button `nothing`/],
        [{ slam: 1, type: 'press' }, /press takes `button`/],
      ]) {
        await post(message);
        await hear('error', (data) => reason.test(data.message));
      }
      const before = (await tab.evaluate(() => heard)).length;
      await post('hello');
      await post({ type: 'webpackOk' });
      await post({ slam: 1, type: 'get', id: 'after' });
      await hear('state', (data) => data.id === 'after');
      const since = (await tab.evaluate(() => heard)).slice(before).filter((data) => data.type === 'error');
      assert.deepEqual(since, []);
    });
  });
});
