// embed.html in a frame, also in a sandbox with an opaque origin, and its messages.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';

const visit = h.visitor();

/** A page with the widget in a frame that records every outgoing message. */
async function framed(query, test, { sandbox, answer, quiet = true } = {}) {
  const attribute = sandbox === undefined ? '' : ` sandbox="${sandbox}"`;
  const page = `<!doctype html><html lang="en"><title>Host</title><link rel="icon" href="data:,">
    <script>window.heard = []; addEventListener('message', (event) => heard.push(event.data));</script>
    <iframe title="Widget" src="/embed.html${query}" style="width: 100%; height: 800px"${attribute}></iframe></html>`;
  const conversation = (tab) => ({
    tab,
    frame: tab.frames().find((frame) => frame !== tab.mainFrame()),
    post: (message) => tab.evaluate((data) => document.querySelector('iframe').contentWindow.postMessage(data, '*'), message),
    /** The first message of that type, earlier or later, whose fields equal or match these. */
    hear: async (type, fields = {}) => {
      const wanted = Object.entries(fields).map(([name, value]) => [name, value.source ?? value, value instanceof RegExp]);
      const found = await tab.waitForFunction(([kind, all]) => heard.find((data) => data?.type === kind
        && all.every(([path, value, isPattern]) => {
          const is = path.split('.').reduce((at, key) => at?.[key], data);
          return isPattern ? new RegExp(value).test(is) : is === value;
        })), [type, wanted]);
      return found.jsonValue();
    },
  });
  await visit('', (tab) => test(conversation(tab)), {
    path: '/host.html', server: { pages: { '/host.html': page }, answer }, quiet,
  });
}

/** embed.html as a separate page. */
const alone = (query, test, how) => visit('', test, { path: `/embed.html${query}`, ...how });

describe('a frame', () => {
  for (const sandbox of [undefined, 'allow-scripts']) {
    it(`${sandbox === undefined ? 'of the same origin' : 'in a sandbox'} runs, can be set, answers and reports`, async () => {
      await framed('?w=16.1&heading=60', async ({ post, hear }) => {
        const ready = await hear('ready');
        assert.equal(ready.slam, 1);
        assert.equal(ready.value.heading, 60);
        await post({ slam: 1, type: 'set', values: { heading: 12, variant: 'point-to-plane' } });
        const changed = await hear('changed', { parameter: 'heading' });
        assert.equal(changed.value, 12);
        const result = await hear('result', { 'value.heading': 12 });
        assert.ok(result.outcome.sentence.length > 10);
        await post({ slam: 1, type: 'get', id: 'q1' });
        const state = await hear('state');
        assert.equal(state.id, 'q1');
        assert.equal(state.value.variant, 'point-to-plane');
      }, { sandbox });
    });
  }

  it('saves the picture from a sandbox that allows downloads', async () => {
    await framed('?w=16.1', async ({ tab, frame, hear }) => {
      await hear('ready');
      await frame.getByText('Share', { exact: true }).click();
      const [download] = await Promise.all([
        tab.waitForEvent('download'),
        frame.getByRole('button', { name: 'Save picture' }).click(),
      ]);
      assert.equal(download.suggestedFilename(), 'w16.1.png');
    }, { sandbox: 'allow-scripts allow-downloads' });
  });

  it('reports its size, also to learning management systems', async () => {
    await framed('?w=16.1', async ({ tab, hear }) => {
      await hear('ready');
      await tab.waitForFunction(() => {
        const told = heard.filter((data) => typeof data === 'string').map((data) => JSON.parse(data));
        return heard.some((data) => data.type === 'size' && data.height > 500
          && told.some((lti) => lti.subject === 'lti.frameResize' && lti.height === data.height));
      });
    });
  });

  it('repeats its size when it is ready, and in its state, for late listeners', async () => {
    await framed('?w=16.1', async ({ tab, frame, post, hear }) => {
      await hear('ready');
      await tab.waitForFunction(() => heard.slice(heard.findIndex((data) => data.type === 'ready'))
        .some((data) => data.type === 'size'));
      await post({ slam: 1, type: 'get' });
      const { width, height } = await hear('state');
      const main = await frame.evaluate(() => document.querySelector('main').getBoundingClientRect());
      assert.deepEqual([width, height], [main.width, main.height].map(Math.ceil));
    });
  });

  it('does not scroll in a frame of the reported height', async () => {
    await framed('?w=16.1&bogus=1', async ({ tab, frame, hear }) => {
      await hear('ready');
      await tab.evaluate(() => addEventListener('message', ({ data }) => {
        if (data.type === 'size') document.querySelector('iframe').style.height = `${data.height}px`;
      }));
      // A change of width makes the frame report its size again.
      await tab.evaluate(() => (document.querySelector('iframe').style.width = '90%'));
      await frame.waitForFunction(() => innerWidth < 1000
        && Math.ceil(document.querySelector('main').getBoundingClientRect().height) === innerHeight
        && document.documentElement.scrollHeight === innerHeight);
    });
  });

  it('reports errors in its address to page and reader, and keeps working', async () => {
    await framed('?w=16.1&heading=abc&bogus=1', async ({ frame, hear }) => {
      const { kind, name } = await hear('error', { message: /`heading` takes a number/ });
      assert.deepEqual([kind, name], ['address', 'w16.1']);
      await hear('error', { message: /has no parameter `bogus`/ });
      await hear('ready');
      for (const sentence of ['`heading` takes a number, not `abc`', 'w16.1 has no parameter `bogus`']) {
        assert.ok(await frame.getByText(sentence).isVisible(), sentence);
      }
    });
  });

  it('rejects invalid messages, and ignores those of others', async () => {
    await framed('?w=16.1', async ({ tab, post, hear }) => {
      await hear('ready');
      for (const [message, reason] of [
        [{ slam: 2, type: 'get' }, /speaks version 1, not 2/],
        [{ slam: 1, type: 'explode' }, /no message `explode`/],
        [{ slam: 1, type: 'set' }, /set takes `values`/],
        [{ slam: 1, type: 'set', values: { heading: 1e9, dx: 0.5 } }, /`heading` takes -180 to 180/],
        [{ slam: 1, type: 'set', values: { __proto__x: 1 } }, /has no parameter/],
        [{ slam: 1, type: 'press', button: 'nothing' }, /no button `nothing`/],
        [{ slam: 1, type: 'press' }, /press takes `button`/],
      ]) {
        await post(message);
        assert.equal((await hear('error', { message: reason })).kind, 'message');
      }
      // Valid values of the same message are set.
      await hear('changed', { parameter: 'dx', value: 0.5 });
      const before = (await tab.evaluate(() => heard)).length;
      await post('hello');
      await post({ type: 'webpackOk' });
      await post({ slam: 1, type: 'get', id: 'after' });
      await hear('state', { id: 'after' });
      const since = (await tab.evaluate(() => heard)).slice(before).filter((data) => data.type === 'error');
      assert.deepEqual(since, []);
    });
  });

  it('answers a message of a megabyte with a sentence', async () => {
    await framed('?w=16.1', async ({ tab, post, hear }) => {
      await hear('ready');
      const long = 'x'.repeat(1e6);
      const many = Object.fromEntries(Array.from({ length: 1e5 }, (_, i) => [`x${i}`, 1]));
      for (const [message, reason] of [
        [{ slam: long, type: 'get' }, /speaks version 1/],
        [{ slam: 1, type: long }, /no message `x+…`/],
        [{ slam: 1, type: 'get', id: long }, /at most 200 characters/],
        [{ slam: 1, type: 'press', button: long }, /no button `x+…`/],
        [{ slam: 1, type: 'set', values: { [long]: 1 } }, /no parameter `x+…`/],
        [{ slam: 1, type: 'set', values: { heading: long } }, /takes a number, not `x+…`/],
        [{ slam: 1, type: 'set', values: many }, /99992 more values are invalid/],
      ]) {
        await post(message);
        await hear('error', { message: reason });
      }
      const told = (await tab.evaluate(() => heard)).filter(({ type }) => type === 'error');
      assert.equal(told.length, 15);
      assert.ok(told.every((message) => JSON.stringify(message).length < 500));
    });
  });

  it('accepts messages only from its parent', async () => {
    await framed('?w=16.1&heading=60', async ({ tab, post, hear }) => {
      await hear('ready');
      await tab.evaluate(() => {
        const stranger = document.body.appendChild(document.createElement('iframe'));
        const speak = stranger.contentWindow.eval('(data) => parent.frames[0].postMessage(data, "*")');
        speak({ slam: 1, type: 'set', values: { heading: 7 } });
        speak({ slam: 1, type: 'get', id: 'stranger' });
        speak({ slam: 2, type: 'get' });
      });
      await post({ slam: 1, type: 'get', id: 'parent' });
      const state = await hear('state', { id: 'parent' });
      assert.equal(state.value.heading, 60);
      const others = (await tab.evaluate(() => heard)).filter(({ type, id }) => type === 'error' || id === 'stranger');
      assert.deepEqual(others, []);
    });
  });
});

describe('a frame that cannot start', () => {
  /** The page's sentence for this case. */
  const says = (frame) => frame.getByText('The widget has not started.').waitFor();

  it('explains what a sandbox needs if the server sends no Access-Control-Allow-Origin', async () => {
    const answer = (_, response) => {
      response.removeHeader('Access-Control-Allow-Origin');
      return false;
    };
    await framed('?w=16.1', async ({ tab, frame }) => {
      await says(frame);
      assert.ok(await frame.getByText('Access-Control-Allow-Origin: *').isVisible());
      assert.match(tab.troubles.join('\n'), /blocked by CORS policy/);
    }, { sandbox: 'allow-scripts', answer, quiet: false });
  });

  it('shows a sentence without JavaScript', async () => {
    await alone('?w=16.1', says, { options: { javaScriptEnabled: false } });
  });

  it('shows no such sentence if it starts', async () => {
    await alone('?w=16.1', async (tab) => {
      await h.ready(tab);
      assert.equal(await tab.getByText('The widget has not started.').count(), 0);
    });
  });
});

describe('embed.html as a page', () => {
  it('has the title of its widget, also as a heading', async () => {
    await alone('', async (tab, server) => {
      for (const { id, title } of h.schema) {
        await tab.goto(`${server.url}/embed.html?w=${id.slice(1)}`);
        assert.equal(await tab.title(), title);
        assert.equal(await tab.getByRole('main').getByRole('heading', { level: 1 }).innerText(), title);
      }
    });
  });

  it('works under the strict policy, and satisfies axe-core', async () => {
    await alone('?w=16.1&heading=abc', async (tab) => {
      await h.ready(tab);
      assert.ok(await tab.getByText('`heading` takes a number, not `abc`').isVisible());
      assert.deepEqual(await violations(tab), []);
    }, { server: { policy: h.STRICT_POLICY } });
  });

  it('shows texts of its address as text, never as HTML', async () => {
    const html = '<img src=x onerror="window.ran = true"><b id=made>';
    const part = encodeURIComponent(html);
    for (const [query, sentences] of [[`?w=${part}`, 1], [`?w=16.1&heading=${part}&${part}=1&theme=${part}`, 2]]) {
      await alone(query, async (tab) => {
        await h.ready(tab);
        const made = await tab.evaluate(() => {
          const roots = [document, document.querySelector('slam-widget').shadowRoot];
          return roots.flatMap((root) => [...root.querySelectorAll('#made, [onerror]')].map((element) => element.outerHTML));
        });
        assert.deepEqual(made, []);
        assert.equal(await tab.evaluate(() => window.ran), undefined);
        const told = await tab.locator('.problems p').allInnerTexts();
        assert.equal(told.length, sentences);
        for (const sentence of told) assert.ok(sentence.includes('<img src=x'), sentence);
      });
    }
  });
});
