// Safe to embed: under a strict policy, with broken files, without WebGL, and mounted many times.

import assert from 'node:assert/strict';
import { createReadStream, readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import * as h from './harness.mjs';

const ONE = '<slam-widget name="w16.2"></slam-widget>';
const WASM = readdirSync(h.DIST).find((file) => file.endsWith('.wasm'));

let browser;
before(async () => (browser = await h.launch()));
after(() => browser.close());

async function on(body, test, { server: serverOptions, options, quiet = true, with: other } = {}) {
  const server = await h.serve({ ...serverOptions, pages: { '/t.html': h.bare(body) } });
  const tab = await h.open(other ?? browser, `${server.url}/t.html`, options);
  try {
    await test(tab, server);
    if (quiet) assert.deepEqual(tab.troubles, []);
  } finally {
    await tab.context().close();
    await server.close();
  }
}

const failure = (tab) => tab.locator('slam-widget .failure');

/** One sentence with the reason, and the static picture in place of the canvas. */
async function fallsBack(tab, reason) {
  await failure(tab).waitFor();
  assert.match(await failure(tab).innerText(), reason);
  const picture = await tab.evaluate(async () => {
    const image = document.querySelector('slam-widget').shadowRoot.querySelector('.picture');
    await image.decode();
    return { width: image.naturalWidth, shown: image.getBoundingClientRect().height, alt: image.alt };
  });
  assert.ok(picture.width > 300 && picture.shown > 200, JSON.stringify(picture));
  assert.ok(picture.alt.length > 40, picture.alt);
}

it('works under the strict policy, and nothing is refused by it', async () => {
  await on(ONE, async (tab) => {
    await h.ready(tab);
    assert.ok((await h.paintedShare(tab)).share > 0.03);
  }, { server: { policy: h.STRICT_POLICY } });
});

it('stores nothing: no cookie, no local storage, no database', async () => {
  await on(ONE, async (tab) => {
    await h.ready(tab);
    await tab.evaluate(() => (document.querySelector('slam-widget').noise = 2));
    await h.moreFrames(tab, 3);
    const kept = await tab.evaluate(async () => ({
      cookie: document.cookie,
      local: localStorage.length,
      session: sessionStorage.length,
      databases: (await indexedDB.databases()).length,
    }));
    assert.deepEqual(kept, { cookie: '', local: 0, session: 0, databases: 0 });
  });
});

describe('a wasm file', () => {
  const answerWasm = (answer) => ({
    answer: (path, response) => path.endsWith('.wasm') && (answer(response), true),
  });

  it('of the wrong type runs all the same', async () => {
    const answer = (response) => {
      response.setHeader('Content-Type', 'text/plain');
      createReadStream(join(h.DIST, WASM)).pipe(response);
    };
    await on(ONE, (tab) => h.ready(tab), { server: answerWasm(answer) });
  });

  it('that is missing leaves the picture and one sentence', async () => {
    const answer = (response) => {
      response.statusCode = 404;
      response.end();
    };
    await on(ONE, (tab) => fallsBack(tab, /could not be fetched \(404\)/), {
      server: answerWasm(answer), quiet: false,
    });
  });

  it('that is cut short leaves the picture and one sentence', async () => {
    const bytes = readFileSync(join(h.DIST, WASM));
    const answer = (response) => {
      response.setHeader('Content-Type', 'application/wasm');
      response.end(bytes.subarray(0, bytes.length / 2));
    };
    await on(ONE, (tab) => fallsBack(tab, /arrived incomplete/), { server: answerWasm(answer), quiet: false });
  });

  it('that comes at the second attempt runs after "Try again"', async () => {
    let asked = 0;
    const server = {
      answer: (path, response) => {
        if (!path.endsWith('.wasm') || (asked += 1) > 1) return false;
        response.statusCode = 503;
        response.end();
        return true;
      },
    };
    await on(ONE, async (tab) => {
      await failure(tab).waitFor();
      await tab.getByRole('button', { name: 'Try again' }).click();
      await h.ready(tab);
    }, { server, quiet: false });
  });

  it('shows how much of it has arrived', async () => {
    const bytes = readFileSync(join(h.DIST, WASM));
    let finish;
    const answer = (response) => {
      response.setHeader('Content-Length', bytes.length);
      response.write(bytes.subarray(0, bytes.length / 2));
      finish = () => response.end(bytes.subarray(bytes.length / 2));
    };
    await on(ONE, async (tab) => {
      const progress = () => tab.evaluate(() =>
        document.querySelector('slam-widget').shadowRoot.querySelector('progress:not([hidden])')?.value ?? 0);
      await tab.waitForFunction(() =>
        document.querySelector('slam-widget').shadowRoot.querySelector('progress').value > 0.3);
      assert.ok((await progress()) < 0.7);
      finish();
      await h.ready(tab);
      assert.equal(await progress(), 0);
    }, { server: answerWasm(answer) });
  });
});

it('falls back without WebAssembly', async () => {
  const server = await h.serve({ pages: { '/t.html': h.bare(ONE, '<script>delete window.WebAssembly</script>') } });
  const tab = await h.open(browser, `${server.url}/t.html`);
  await fallsBack(tab, /no WebAssembly/);
  await tab.context().close();
  await server.close();
});

it('falls back without WebGL 2', async () => {
  const other = await h.launch(['--disable-3d-apis']);
  try {
    await on(ONE, (tab) => fallsBack(tab, /no WebGL 2/), { with: other });
  } finally {
    await other.close();
  }
});

it('never pairs an old glue with a new wasm: both names hold hashes of what they need', () => {
  const entry = readFileSync(join(h.DIST, 'slam-widget.js'), 'utf8');
  const [, core] = entry.match(/'\.\/(slam-widget-[0-9a-f]{12}\.js)'/);
  assert.ok(statSync(join(h.DIST, core)).size > 10_000);
  assert.match(readFileSync(join(h.DIST, core), 'utf8'), new RegExp(`["']\\./${WASM}["']`));
});

it('loads the wasm once for a page of many widgets', async () => {
  let asked = 0;
  const server = { answer: (path) => ((asked += path.endsWith('.wasm') ? 1 : 0), false) };
  await on(ONE + ONE + ONE, async (tab) => {
    await tab.evaluate(() => document.querySelectorAll('slam-widget')[2].scrollIntoView());
    await tab.waitForFunction(() => document.querySelectorAll('slam-widget')[2].state === 'running');
    assert.equal(asked, 1);
  }, { server });
});

it('is mounted and taken away thirty times without leaking memory, contexts or listeners', async () => {
  await on('<div id="here"></div>', async (tab) => {
    const session = await tab.context().newCDPSession(tab);
    await tab.evaluate(() => {
      window.memories = [];
      const { instantiate } = WebAssembly;
      WebAssembly.instantiate = async (...given) => {
        const instance = await instantiate(...given);
        memories.push(new WeakRef(instance.exports.memory));
        return instance;
      };
    });
    const mount = async () => {
      await tab.evaluate(() => {
        document.querySelector('#here').innerHTML = '<slam-widget name="w16.4"></slam-widget>';
      });
      await h.ready(tab);
      await tab.evaluate(() => document.querySelector('#here').replaceChildren());
    };
    const measure = async () => {
      for (let i = 0; i < 3; i += 1) await session.send('HeapProfiler.collectGarbage');
      const { jsEventListeners, nodes } = await session.send('Memory.getDOMCounters');
      const { usedSize } = await session.send('Runtime.getHeapUsage');
      const memories = await tab.evaluate(
        () => window.memories.filter((memory) => memory.deref() !== undefined).length);
      return { jsEventListeners, nodes, usedSize, memories };
    };
    for (let i = 0; i < 5; i += 1) await mount();
    const before = await measure();
    for (let i = 0; i < 30; i += 1) await mount();
    const after = await measure();
    assert.ok(after.jsEventListeners - before.jsEventListeners < 15, `listeners ${before.jsEventListeners} → ${after.jsEventListeners}`);
    assert.ok(after.nodes - before.nodes < 300, `nodes ${before.nodes} → ${after.nodes}`);
    assert.ok(after.memories <= 2, `${after.memories} of 35 wasm memories are still there`);
    assert.ok(after.usedSize - before.usedSize < 5e6, `heap ${before.usedSize} → ${after.usedSize}`);
  });
});
