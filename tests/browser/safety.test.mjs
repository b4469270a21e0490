// Safe to embed: under a strict policy, with broken files, and without WebGL.

import assert from 'node:assert/strict';
import { createReadStream, readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { FROZEN_MS } from './clock.mjs';
import * as h from './harness.mjs';

const ONE = '<slam-widget name="w16.2"></slam-widget>';
const WASM = readdirSync(h.DIST).find((file) => /^slam_web-[0-9a-f]+\.wasm$/.test(file));

const on = h.visitor();
const failure = (tab) => tab.locator('slam-widget .failure');

/** One sentence with the reason, and the static picture instead of the canvas. */
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

it('a widget paints, predicts, and saves picture and data under the strict policy', async () => {
  const body = `<script type="module" src="/slam-predict.js"></script>
    <slam-predict widget="w16.1" state="heading=90&dx=0&dy=0">
      <p>Where does it end?</p>
      <ul><li data-choice="right minimum">at the truth</li><li data-choice="quarter turn">a quarter turn off</li></ul>
      <p data-why>The room is almost square.</p>
    </slam-predict><slam-widget name="w16.1"></slam-widget>`;
  await on(body, async (tab) => {
    await h.ready(tab);
    assert.ok((await h.painted(tab)).share > 0.03);
    await tab.getByLabel('at the truth').check();
    await tab.getByRole('button', { name: 'Commit and see' }).click();
    await tab.getByText('The room is almost square.').waitFor();
    await tab.getByText('Share', { exact: true }).click();
    for (const [name, start] of [['Save picture', '\x89PNG'], ['Save data', '']]) {
      const [download] = await Promise.all([
        tab.waitForEvent('download'),
        tab.getByRole('button', { name }).click(),
      ]);
      const bytes = await h.bytesOf(download);
      assert.ok(bytes.length > 100 && bytes.toString('latin1').startsWith(start), `${name}: ${bytes.length} bytes`);
    }
  }, { server: { policy: h.STRICT_POLICY }, options: { sees: true } });
});

it('a widget shows texts of the address and of attributes as text, never as HTML', async () => {
  const html = '<img src=x onerror="window.ran = true"><b id=made>';
  const attribute = html.replaceAll('"', '&quot;').replaceAll('<', '&lt;');
  const body = `<slam-widget linked name="w16.1" heading="${attribute}"></slam-widget><slam-widget name="${attribute}"></slam-widget>`;
  const query = new URLSearchParams([['w', '16.1'], ['dx', html], [html, '1']]);
  await on(body, async (tab) => {
    await h.ready(tab);
    const seen = await tab.evaluate(() => [...document.querySelectorAll('slam-widget')].map(({ shadowRoot }) => ({
      told: [...new Set([...shadowRoot.querySelectorAll('.note p')].map((line) => line.textContent))],
      made: shadowRoot.querySelectorAll('#made, [onerror]').length,
    })));
    assert.deepEqual(seen.map(({ told, made }) => [told.length, made]), [[3, 0], [1, 0]]);
    for (const sentence of seen.flatMap(({ told }) => told)) assert.match(sentence, /<img src=x/);
    assert.equal(await tab.evaluate(() => window.ran), undefined);
  }, { path: `/t.html?${query}` });
});

it('a widget stores nothing: no cookie, no local storage, no database', async () => {
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

/** A server that delays the core: `asked` is set once a page requests it, and `send` sends it. */
function heldBack() {
  let hear;
  const asked = new Promise((resolve) => (hear = resolve));
  const send = async () => {
    const response = await asked;
    response.setHeader('Content-Type', 'application/wasm');
    createReadStream(join(h.DIST, WASM)).pipe(response);
  };
  const answer = (path, response) => {
    const isModule = path.endsWith('.wasm');
    if (isModule) hear(response);
    return isModule;
  };
  return { asked, send, server: { answer } };
}

describe('a wasm file', () => {
  const answerWasm = (answer) => ({
    answer: (path, response) => {
      const isModule = path.endsWith('.wasm');
      if (isModule) answer(response);
      return isModule;
    },
  });

  it('with the wrong MIME type runs', async () => {
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

  it('that is truncated leaves the picture and one sentence', async () => {
    const bytes = readFileSync(join(h.DIST, WASM));
    const answer = (response) => {
      response.setHeader('Content-Type', 'application/wasm');
      response.end(bytes.subarray(0, bytes.length / 2));
    };
    await on(ONE, (tab) => fallsBack(tab, /arrived incomplete/), { server: answerWasm(answer), quiet: false });
  });

  it('that arrives at the second attempt runs after "Try again"', async () => {
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

  for (const [what, share] of [['never arrives', 0], ['stalls halfway', 0.5]]) {
    it(`that ${what} times out after ten seconds, and loads after "Try again"`, async () => {
      const bytes = readFileSync(join(h.DIST, WASM));
      let asked = 0;
      let heard;
      const silent = new Promise((resolve) => (heard = resolve));
      const server = {
        answer: (path, response) => {
          if (!path.endsWith('.wasm') || (asked += 1) > 1) return false;
          response.setHeader('Content-Type', 'application/wasm');
          response.setHeader('Content-Length', bytes.length);
          if (share > 0) response.write(bytes.subarray(0, share * bytes.length));
          heard();
          return true;
        },
      };
      await on(ONE, async (tab) => {
        await silent;
        await tab.waitForFunction((part) => {
          const { value } = document.querySelector('slam-widget').shadowRoot.querySelector('progress');
          return value > 0.99 * part;
        }, share - 0.01);
        await tab.evaluate(() => frameClock.skip(9_900));
        assert.equal(await failure(tab).count(), 0);
        await tab.evaluate(() => frameClock.skip(200));
        await fallsBack(tab, /the server of the program does not answer/);
        await tab.getByRole('button', { name: 'Try again' }).click();
        await h.ready(tab);
        assert.equal(asked, 2);
      }, { server });
    });
  }

  it('that arrives late starts a widget that moved meanwhile, with the preset that was pressed', async () => {
    const { asked, send, server } = heldBack();
    const [{ id: preset }] = h.schema.find(({ id }) => id === 'w16.2').presets;
    await on(`${ONE}<div id="there"></div>`, async (tab) => {
      await asked;
      await tab.evaluate((button) => {
        const widget = document.querySelector('slam-widget');
        widget.shadowRoot.querySelector(`[data-control="${button}"]`).click();
        document.querySelector('#there').append(widget);
      }, preset);
      await send();
      await h.ready(tab);
      assert.equal(await failure(tab).count(), 0);
      const [shown, expected] = await tab.evaluate(async (button) => {
        const fresh = document.createElement('slam-widget');
        fresh.name = 'w16.2';
        await fresh.press(button);
        return [document.querySelector('slam-widget').value, fresh.value];
      }, preset);
      assert.deepEqual(shown, expected);
    }, { server, options: { stepMs: FROZEN_MS } });
  });

  it('that arrives after the values have settled reports their result to programs only', async () => {
    const { asked, send, server } = heldBack();
    const head = `<script>
      window.heard = [];
      for (const type of ['slam-ready', 'slam-result'])
        document.addEventListener(type, ({ detail }) => heard.push([type, detail.value.heading]));
    </script>`;
    await on('<slam-widget name="w16.1" heading="70"></slam-widget>', async (tab) => {
      await asked;
      await tab.evaluate(() => frameClock.pass(900));
      assert.deepEqual(await tab.evaluate(() => heard), []);
      await send();
      await h.ready(tab);
      await h.quiet(tab);
      assert.deepEqual(await tab.evaluate(() => heard), [['slam-ready', 70], ['slam-result', 70]]);
      assert.equal(await tab.locator('slam-widget [aria-live="polite"]').textContent(), '');
    }, { server, head });
  });

  it('of another build is reported in one sentence, with a button that reloads the page', async () => {
    // It has all imports and exports for linking, but lacks a function that the glue calls after the start.
    const [, mark] = WASM.match(/-([0-9a-f]+)\.wasm/);
    const bytes = readFileSync(join(h.DIST, WASM)).toString('latin1');
    const other = Buffer.from(bytes.replace('widget_settle', 'widget_rested').replace(mark, '0'.repeat(mark.length)), 'latin1');
    const isOld = { now: true };
    const server = {
      answer: (path, response) => {
        if (!path.endsWith('.wasm') || !isOld.now) return false;
        response.setHeader('Content-Type', 'application/wasm');
        response.end(other);
        return true;
      },
    };
    await on(ONE, async (tab) => {
      await fallsBack(tab, /different versions\. Reload the page\./);
      assert.equal(await tab.locator('slam-widget .failure p').count(), 1);
      isOld.now = false;
      await tab.getByRole('button', { name: 'Reload the page' }).click();
      await h.ready(tab);
    }, { server, quiet: false });
  });

  it('that is outdated in the cache is fetched again, unnoticed by the reader', async () => {
    // An empty module: it compiles, but fits no glue.
    const empty = Buffer.from([0, 97, 115, 109, 1, 0, 0, 0]);
    let asked = 0;
    const server = {
      answer: (path, response) => {
        if (!path.endsWith('.wasm') || (asked += 1) > 1) return false;
        response.setHeader('Content-Type', 'application/wasm');
        // The headers of a host that caches a file with a hash in its name.
        response.setHeader('Cache-Control', 'public, max-age=31536000, immutable');
        response.end(empty);
        return true;
      },
    };
    await on(ONE, async (tab) => {
      await h.ready(tab);
      assert.equal(asked, 2);
      assert.equal(await failure(tab).count(), 0);
    }, { server });
  });

  it('reports its download progress', async () => {
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
    }, { server: answerWasm(answer), options: { stepMs: FROZEN_MS } });
  });
});

it('a widget shows the picture and one sentence without WebAssembly', async () => {
  await on(ONE, (tab) => fallsBack(tab, /no WebAssembly/), { head: '<script>delete window.WebAssembly</script>' });
});

describe('a start that is broken', () => {
  const BROKEN = {
    'an observer that throws': [
      "Object.defineProperty(ResizeObserverEntry.prototype, 'contentRect', { get() { throw new TypeError('no rectangle'); } })",
      /TypeError: no rectangle\. It needs Chrome \d+, Firefox \d+ or Safari [\d.]+, or a later version\./,
    ],
    'a missing observer': ['delete window.IntersectionObserver', /IntersectionObserver is not defined\. It needs Chrome/],
    'a refused shader': ['WebGL2RenderingContext.prototype.getShaderParameter = () => false', /cannot run here: Error starting glow painter.*It needs Chrome/],
    'refused memory': ["WebAssembly.instantiate = () => Promise.reject(new RangeError('could not allocate'))", /gives it no memory; close other tabs/],
  };
  for (const [what, [script, reason]] of Object.entries(BROKEN)) {
    it(`by ${what} leaves the picture and one sentence with cause and remedy`, async () => {
      await on(ONE, (tab) => fallsBack(tab, reason), { head: `<script>${script}</script>`, quiet: false });
    });
  }
});

describe('a start that hangs', () => {
  const arrived = (tab) => tab.waitForFunction(() => document.querySelector('slam-widget')?.shadowRoot?.querySelector('progress')?.value === 1);
  const hasCanvas = (tab) => tab.locator('slam-widget .stage.waiting canvas').waitFor({ state: 'attached' });
  const HANGING = {
    'in the compiler': [
      'WebAssembly.compileStreaming = async (response) => { await (await response).arrayBuffer(); return new Promise(() => {}); }',
      /drawn nothing yet: the browser has not compiled its program/,
    ],
    'at the start of the program': ['WebAssembly.instantiate = () => new Promise(() => {})', /drawn nothing yet: the browser has not compiled its program/],
    'for its first frame': ['window.requestAnimationFrame = () => 1', /drawn nothing yet: the browser renders no frames/, hasCanvas],
  };
  for (const [where, [script, reason, lastSign = arrived]] of Object.entries(HANGING)) {
    it(`${where} is told about ten seconds after the last sign of life`, async () => {
      await on(ONE, async (tab) => {
        await lastSign(tab);
        await tab.evaluate(() => frameClock.skip(9_900));
        assert.equal(await failure(tab).count(), 0);
        await tab.evaluate(() => frameClock.skip(1_200));
        await fallsBack(tab, reason);
      }, { head: `<script>${script}</script>` });
    });
  }

  it('by a slow line is not told while the program arrives', async () => {
    const bytes = readFileSync(join(h.DIST, WASM));
    const PARTS = 5;
    let line;
    const send = (part) => line.write(bytes.subarray(part * bytes.length / PARTS, (part + 1) * bytes.length / PARTS));
    const server = {
      answer: (path, response) => {
        if (!path.endsWith('.wasm')) return false;
        response.setHeader('Content-Type', 'application/wasm');
        response.setHeader('Content-Length', bytes.length);
        line = response;
        send(0);
        return true;
      },
    };
    await on(ONE, async (tab) => {
      for (let part = 1; part <= PARTS; part += 1) {
        await tab.waitForFunction((share) => document.querySelector('slam-widget').shadowRoot?.querySelector('progress')?.value >= share, (part - 0.001) / PARTS);
        if (part === PARTS) break;
        await tab.evaluate(() => frameClock.skip(9_000));
        assert.equal(await failure(tab).count(), 0);
        send(part);
      }
      line.end();
      await h.ready(tab);
      assert.equal(await failure(tab).count(), 0);
    }, { server });
  });
});

it('a widget starts without the exact size of its canvas, which no Safari has', async () => {
  await on(ONE, (tab) => h.ready(tab), { head: '<script>delete ResizeObserverEntry.prototype.devicePixelContentBoxSize</script>' });
});

it('a widget shows the picture and one sentence without WebGL 2', async () => {
  const other = await h.launch(['--disable-3d-apis']);
  try {
    await on(ONE, (tab) => fallsBack(tab, /no WebGL 2/), { with: other });
  } finally {
    await other.close();
  }
});

it('old glue is never paired with new wasm: both names have hashes of their content', () => {
  const entry = readFileSync(join(h.DIST, 'slam-widget.js'), 'utf8');
  const [, core] = entry.match(/'\.\/(slam-widget-[0-9a-f]{12}\.js)'/);
  assert.ok(statSync(join(h.DIST, core)).size > 10_000);
  assert.match(readFileSync(join(h.DIST, core), 'utf8'), new RegExp(`["']\\./${WASM}["']`));
});

describe('a cached slam-widget.js whose core is gone', () => {
  const server = {
    answer: (path, response) => {
      if (path !== '/slam-widget.js') return false;
      response.setHeader('Content-Type', 'text/javascript');
      response.end("export * from './slam-widget-000000000000.js';\n");
      return true;
    },
  };
  /** The picture within the element is loaded and visible, and so is its sentence. */
  const showsItsContent = async (tab) => {
    const widgets = await tab.evaluate(async () => {
      const isSeen = (element) => element.getBoundingClientRect().height > 10;
      const found = [];
      for (const fold of document.querySelectorAll('details:has(slam-widget)')) fold.open = true;
      for (const widget of document.querySelectorAll('slam-widget')) {
        const image = widget.querySelector('img');
        // One after the other, because of lazy loading.
        image.scrollIntoView();
        await image.decode();
        found.push(image.naturalWidth > 300 && isSeen(image) && isSeen(widget.querySelector('p')));
      }
      return found;
    });
    assert.ok(widgets.length > 0 && widgets.every(Boolean), JSON.stringify(widgets));
  };

  it('leaves the pictures and sentences of the page', async () => {
    await on('', showsItsContent, { server, path: '/', quiet: false });
  });

  it('leaves the fallback content of any page, which a running element hides', async () => {
    const body = '<slam-widget name="w16.2"><img src="/pictures/w16.2-light.svg" alt="The lap"><p>A still picture.</p></slam-widget>';
    await on(body, showsItsContent, { server, quiet: false });
    await on(body, async (tab) => {
      await h.ready(tab);
      assert.equal(await tab.getByText('A still picture.').isVisible(), false);
    });
  });

  it('leaves the same if it has the wrong type', async () => {
    const body = '<slam-widget name="w16.2"><img src="/pictures/w16.2-light.svg" alt="The lap"><p>A still picture.</p></slam-widget>';
    const ofWrongType = (path, response) => {
      const isScript = /^\/slam-widget-\w+\.js$/.test(path);
      if (isScript) {
        response.setHeader('Content-Type', 'text/plain');
        createReadStream(join(h.DIST, path)).pipe(response);
      }
      return isScript;
    };
    await on(body, showsItsContent, { server: { answer: ofWrongType }, quiet: false });
  });

  it('leaves a sentence in a frame', async () => {
    await on('', (tab) => tab.getByText('reload this page').waitFor(), {
      server, path: '/embed.html?w=16.1', quiet: false,
    });
  });
});

it('a widget starts on a machine so slow that the canvas gets its size seconds later', async () => {
  const head = `<script>
    const Prompt = ResizeObserver;
    window.ResizeObserver = class extends Prompt {
      constructor(tell) {
        super((...told) => setTimeout(() => tell(...told), 2000));
      }
    };
  </script>`;
  await on(ONE, (tab) => h.ready(tab), { head });
});

it('a page of many widgets fetches the wasm once', async () => {
  let asked = 0;
  const server = {
    answer: (path) => {
      if (path.endsWith('.wasm')) asked += 1;
      return false;
    },
  };
  await on(ONE + ONE + ONE, async (tab) => {
    await tab.evaluate(() => document.querySelectorAll('slam-widget')[2].scrollIntoView());
    await tab.waitForFunction(() => document.querySelectorAll('slam-widget')[2].state === 'running');
    assert.equal(asked, 1);
  }, { server });
});
