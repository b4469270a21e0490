// Every recipe of docs/embedding.md is a file of web/examples, and works.

import assert from 'node:assert/strict';
import { createReadStream, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync, cpSync, readdirSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as esbuild from '../../web/node_modules/esbuild/lib/main.js';
import * as h from './harness.mjs';

const REVEAL = fileURLToPath(new URL('./node_modules/reveal.js/dist/', import.meta.url));

let browser;
before(async () => (browser = await h.launch()));
after(() => browser.close());

async function example(file, test) {
  const answer = (path, response) => {
    if (!path.startsWith('/examples/reveal/')) return false;
    const type = path.endsWith('.css') ? 'text/css' : 'text/javascript';
    response.setHeader('Content-Type', type);
    createReadStream(join(REVEAL, path.slice('/examples/reveal/'.length))).pipe(response);
    return true;
  };
  const server = await h.serve({ answer });
  const tab = await h.open(browser, `${server.url}/examples/${file}`);
  try {
    await test(tab);
    assert.deepEqual(tab.troubles, []);
  } finally {
    await tab.context().close();
    await server.close();
  }
}

it('plain.html: a widget, a link that sets it, and a prediction', async () => {
  await example('plain.html', async (tab) => {
    const predict = tab.locator('slam-predict');
    await tab.evaluate(() => document.addEventListener('slam-predict', (event) => (window.told = event.detail)));
    assert.equal(await predict.locator('[data-why]').isVisible(), false);
    await predict.getByLabel('at the truth').check();
    await predict.getByRole('button', { name: 'Commit and see' }).click();
    await tab.waitForFunction(() => window.told !== undefined);
    const told = await tab.evaluate(() => told);
    const verdict = await tab.evaluate(() => document.querySelector('slam-widget').outcome.verdict);
    assert.equal(told.result, verdict);
    assert.equal(told.correct, verdict === 'right minimum');
    assert.equal(await predict.locator('[data-why]').isVisible(), true);
    await tab.getByRole('link', { name: '60°' }).click();
    const state = await tab.evaluate(() => document.querySelector('slam-widget').value);
    assert.equal(state.heading, 60);
    assert.equal(state.variant, 'point-to-point');
    await h.ready(tab);
  });
});

it('iframe.html: a sandboxed frame that is set and answers', async () => {
  await example('iframe.html', async (tab) => {
    await tab.waitForFunction(() => parseInt(document.querySelector('#lap').style.height, 10) !== 900);
    await tab.click('#noisy');
    await tab.waitForFunction(() => document.querySelector('#said').textContent.length > 10);
  });
});

for (const [file, parameter, value] of [
  ['mdbook.html', 'scene', 'corridor'],
  ['quarto.html', 'noise', 2],
]) {
  it(`${file}: the widget with its parameter, in the theme of the page`, async () => {
    await example(file, async (tab) => {
      await h.ready(tab);
      const [is, isDark] = await tab.evaluate((id) => {
        const widget = document.querySelector('slam-widget');
        return [widget.get(id), widget.shadowRoot.querySelector('.frame').classList.contains('dark')];
      }, parameter);
      assert.equal(is, value);
      assert.equal(isDark, file === 'mdbook.html');
    });
  });
}

it('jupyter.html: the anywidget module in step with its model, both ways', async () => {
  await example('jupyter.html', async (tab) => {
    await h.ready(tab);
    await tab.waitForFunction(() => traits.outcome !== null);
    assert.equal(await tab.evaluate(() => traits.value.noise), 2);
    await tab.evaluate(() => assign({ noise: 3 }));
    assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').noise), 3);
    await tab.evaluate(() => (document.querySelector('slam-widget').noise = 0.5));
    await tab.waitForFunction(() => traits.value.noise === 0.5);
    await tab.evaluate(() => unmount());
    assert.equal(await tab.locator('slam-widget').count(), 0);
  });
});

it('reveal.html: the widget runs on its slide and leaves the keys to the deck', async () => {
  await example('reveal.html', async (tab) => {
    await tab.evaluate(() => deck);
    await tab.keyboard.press('ArrowRight');
    await h.ready(tab);
    const box = await tab.locator('slam-widget canvas').boundingBox();
    assert.ok(box.width > 700, `${box.width} wide`);
    await tab.keyboard.press('ArrowLeft');
    await tab.waitForFunction(async () => (await deck).getIndices().h === 0);
  });
});

it('the npm package works from a bundler', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'slam-bundle-'));
  try {
    const modules = join(folder, 'node_modules', 'slam-widgets');
    cpSync(h.DIST, modules, { recursive: true });
    const manifest = JSON.parse(readFileSync(join(modules, 'package.json'), 'utf8'));
    for (const target of Object.values(manifest.exports)) {
      for (const file of typeof target === 'string' ? [target] : Object.values(target)) {
        assert.ok(file.includes('*') || existsSync(join(modules, file)), `${file} is not in the package`);
      }
    }
    writeFileSync(join(folder, 'main.js'), "import { widgets } from 'slam-widgets';\nwindow.names = widgets.map((widget) => widget.id);\n");
    const { outputFiles } = await esbuild.build({
      entryPoints: [join(folder, 'main.js')], bundle: true, minify: true, format: 'esm', write: false, outdir: folder,
    });
    const wasm = readdirSync(h.DIST).find((file) => file.endsWith('.wasm'));
    const answer = (path, response) => {
      if (path === '/app/main.js') {
        response.setHeader('Content-Type', 'text/javascript');
        response.end(outputFiles[0].text);
      } else if (path === `/app/${wasm}`) {
        response.setHeader('Content-Type', 'application/wasm');
        createReadStream(join(h.DIST, wasm)).pipe(response);
      } else if (path.startsWith('/app/pictures/')) {
        response.setHeader('Content-Type', 'image/svg+xml');
        createReadStream(join(h.DIST, path.slice(5))).pipe(response);
      } else return false;
      return true;
    };
    const page = '<!doctype html><html lang="en"><title>App</title><link rel="icon" href="data:,"><script type="module" src="/app/main.js"></script><slam-widget name="w16.4"></slam-widget></html>';
    const server = await h.serve({ pages: { '/t.html': page }, answer });
    const tab = await h.open(browser, `${server.url}/t.html`);
    await h.ready(tab);
    assert.deepEqual(await tab.evaluate(() => names), h.schema.map((widget) => widget.id));
    assert.deepEqual(tab.troubles, []);
    await tab.context().close();
    await server.close();
  } finally {
    rmSync(folder, { recursive: true });
  }
});

it('the recipes in docs/embedding.md name files that exist', () => {
  const text = readFileSync(new URL('../../docs/embedding.md', import.meta.url), 'utf8');
  const files = [...text.matchAll(/web\/examples\/([\w.-]+)/g)].map(([, file]) => file);
  assert.ok(new Set(files).size >= 6, files.join(', '));
  for (const file of files) {
    assert.ok(existsSync(new URL(`../../web/examples/${file}`, import.meta.url)), file);
  }
});
