// Browsers that lack a feature, and files that break off: what a reader sees then. Each feature is taken away before the page
// starts.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { SMOOTH_MS } from './clock.mjs';
import * as h from './harness.mjs';
import { draggingSpot } from './spots.mjs';
import { fingers } from './touch.mjs';
import { unpackOffline } from './unpacked.mjs';
import { oldestBrowsers } from '../../web/browsers.mjs';

const visit = h.visitor();
const ONE = '<slam-widget name="w16.1"></slam-widget>';

/** A page of the site with a script before all others, which its policy would forbid. */
function without(script, page) {
  const html = readFileSync(join(h.DIST, page), 'utf8').replace(/<meta http-equiv="Content-Security-Policy"[^>]*>/, '');
  return { path: `/${page}`, fresh: true, server: { pages: { [`/${page}`]: html.replace('<head>', `<head><script>${script}</script>`) } } };
}

describe('a browser without', () => {
  for (const [feature, script] of Object.entries({
    'Array.findLast': 'delete Array.prototype.findLast',
    inert: 'delete HTMLElement.prototype.inert',
    BroadcastChannel: 'delete window.BroadcastChannel',
    DecompressionStream: 'delete window.DecompressionStream',
    MathML: 'delete window.MathMLElement',
    ':has': 'CSS.supports = () => false',
  })) {
    for (const [what, page] of [['a page of the chapter', 'reference.html'], ['the slides', 'slides.html']]) {
      it(`${feature} is told on ${what} which browsers have everything`, async () => {
        await visit('', async (tab) => {
          const line = tab.getByRole('status').filter({ hasText: `Everything works in ${oldestBrowsers()}, or a later version.` });
          await line.waitFor();
          const { y } = await line.boundingBox();
          assert.ok(y < 200, `${y}`);
        }, { ...without(script, page), quiet: false });
      });
    }
  }

  it('nothing of that sees no such sentence', async () => {
    await visit('', async (tab) => {
      await tab.locator('.bar').waitFor();
      assert.equal(await tab.locator('.older').count(), 0);
    }, { path: '/reference.html' });
  });

  it('popovers hides a definition until its word is pressed', async () => {
    // The engine's own popovers do not open either.
    const script = "for (const name of ['popover', 'showPopover', 'hidePopover', 'togglePopover']) delete HTMLElement.prototype[name]; addEventListener('click', (event) => event.preventDefault(), true)";
    await visit('', async (tab) => {
      // The scripts of the page have run once its list of contents follows the reader.
      await tab.locator('.reading').waitFor({ state: 'attached' });
      const word = tab.locator('button.term').first();
      const line = tab.locator('.term-line').first();
      assert.equal(await line.isVisible(), false);
      await word.click();
      await line.waitFor();
      await word.click();
      await line.waitFor({ state: 'hidden' });
    }, without(script, 'index.html'));
  });

  it('BroadcastChannel turns the slides', async () => {
    await visit('', async (tab) => {
      await tab.locator('.turn output').filter({ hasText: /^1 of/ }).waitFor();
      await tab.keyboard.press('ArrowRight');
      await tab.locator('.turn output').filter({ hasText: /^2 of/ }).waitFor();
    }, without('delete window.BroadcastChannel', 'slides.html'));
  });

  it('AbortSignal.timeout lets a written function drive its widget', async () => {
    const body = `<main><h1>Drive</h1><details open data-write="svd_align"><summary>Write it yourself</summary></details>${ONE}</main>
      <script type="module">import { open } from './write-yourself.js'; open(document.querySelector('details'));</script>`;
    await visit(body, async (tab) => {
      await tab.getByRole('button', { name: 'Drive the registration of w16.1 with it', exact: true }).click();
      await tab.getByRole('status').filter({ hasText: 'drives the registration of w16.1' }).waitFor();
    }, { head: '<script>delete AbortSignal.timeout</script>', fresh: true, quiet: false, options: { stepMs: SMOOTH_MS } });
  });

  it('compileStreaming starts a widget', async () => {
    await visit(ONE, (tab) => h.ready(tab), { head: '<script>delete WebAssembly.compileStreaming; delete WebAssembly.instantiateStreaming</script>' });
  });

  it('a constructor of touches drags by a touch', async () => {
    const head = "<script>window.Touch = class { constructor() { throw new TypeError('Illegal constructor'); } }</script>";
    await visit(`${ONE}<p style="height: 3000px">Much text.</p>`, async (tab) => {
      await h.ready(tab);
      const [x, y] = await draggingSpot(tab);
      const before = await tab.evaluate(() => document.querySelector('slam-widget').query);
      const { touch } = await fingers(tab);
      await touch('touchStart', [[x, y]]);
      for (const step of [15, 30, 45, 60]) await touch('touchMove', [[x + step, y - step]]);
      await touch('touchEnd');
      await tab.waitForFunction((old) => document.querySelector('slam-widget').query !== old, before);
    }, { head, options: { hasTouch: true, stepMs: SMOOTH_MS } });
  });

  it('DecompressionStream is told so by a widget of the offline site', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'older-'));
    const browser = await h.launch();
    try {
      unpackOffline(join(folder, 'site.zip'), folder);
      const tab = await browser.newPage();
      await tab.addInitScript(() => delete window.DecompressionStream);
      await tab.goto(`${pathToFileURL(folder).href}/own-robot.html?w=16.10`);
      const failure = tab.locator('slam-widget .failure');
      await failure.waitFor();
      assert.match(await failure.innerText(), /DecompressionStream is not defined\. It needs Chrome \d+/);
    } finally {
      await browser.close();
      rmSync(folder, { recursive: true });
    }
  });
});

describe('a file that breaks off', () => {
  const breaksOff = (wanted) => ({
    answer: (path, response) => {
      const isIt = wanted.test(path);
      if (isIt) {
        const file = join(h.DIST, path);
        const { size } = statSync(file);
        response.setHeader('Content-Length', size);
        response.setHeader('Content-Type', path.endsWith('.wasm') ? 'application/wasm' : 'application/json');
        response.write(readFileSync(file).subarray(0, size / 2), () => response.destroy());
      }
      return isIt;
    },
  });
  const uncaught = (tab) => tab.troubles.filter((trouble) => trouble.startsWith('page:'));

  for (const name of ['lap', 'building']) {
    it(`leaves the still picture, and no uncaught error: ${name}`, async () => {
      const file = `/${readdirSync(h.DIST).find((one) => one.startsWith(`${name}-`))}`;
      await visit('', async (tab) => {
        const page = h.PAGES.find((one) => readFileSync(join(h.DIST, one), 'utf8').includes(name === 'building' ? 'id="building"' : 'id="lap"'));
        const [failed] = await Promise.all([tab.waitForEvent('requestfailed', (request) => request.url().endsWith(file)), tab.goto(`${tab.home}/${page}`)]);
        assert.ok(failed);
        await tab.evaluate(() => window.frameClock.pass(1000));
        assert.deepEqual(uncaught(tab), []);
      }, { path: '/notices.html', quiet: false, server: breaksOff(new RegExp(file)) });
    });
  }

  it('leaves the count of laps as it is, and no uncaught error: the program', async () => {
    await visit('', async (tab) => {
      const [failed] = await Promise.all([
        tab.waitForEvent('requestfailed', (request) => request.url().endsWith('.wasm')),
        tab.locator('#laps').scrollIntoViewIfNeeded(),
      ]);
      assert.ok(failed);
      await tab.locator('slam-widget .failure').first().waitFor();
      await tab.evaluate(() => window.frameClock.pass(1000));
      assert.deepEqual(uncaught(tab), []);
    }, { path: h.PAGES.map((page) => `/${page}`).find((page) => readFileSync(join(h.DIST, page), 'utf8').includes('id="laps"')), quiet: false, server: breaksOff(/slam_web-.*\.wasm$/) });
  });
});
