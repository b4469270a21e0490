// Every recipe of docs/embedding.md is a file of web/examples, and works.

import assert from 'node:assert/strict';
import { createReadStream, existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as esbuild from '../../web/node_modules/esbuild/lib/main.js';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';
import { installPackage } from './package.mjs';

const REVEAL = fileURLToPath(new URL('./node_modules/reveal.js/dist/', import.meta.url));
const EXAMPLES = fileURLToPath(new URL('../../web/examples/', import.meta.url));

const visit = h.visitor();

const TYPES = {
  '.css': 'text/css',
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
};

/** Sends a file that is not in dist/. */
function send(file, response) {
  response.setHeader('Content-Type', TYPES[extname(file)]);
  createReadStream(file).pipe(response);
  return true;
}

/** Opens an example of the site; at the end axe must report no violation. */
function example(file, test) {
  const answer = (path, response) => {
    if (path.startsWith('/examples/reveal/')) return send(join(REVEAL, path.slice('/examples/reveal/'.length)), response);
    // The slides are not part of the site.
    return path.startsWith('/examples/reveal') && send(join(EXAMPLES, path.slice('/examples/'.length)), response);
  };
  return visit('', async (tab) => {
    await test(tab);
    assert.deepEqual(await violations(tab), []);
  }, { path: `/examples/${file}`, server: { answer } });
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

it('iframe.html: a sandboxed frame that can be set and answers', async () => {
  await example('iframe.html', async (tab) => {
    // The script of the page sets the height that the frame reports.
    const frame = tab.frames().find((candidate) => candidate !== tab.mainFrame());
    await h.ready(frame);
    const fits = () => frame.waitForFunction(
      () => innerHeight === Math.ceil(document.querySelector('main').getBoundingClientRect().height));
    await fits();
    // On a slow network the frame may have loaded before the script.
    await tab.evaluate(() => {
      document.querySelector('#lap').style.height = '1000px';
      return import('/examples/iframe.js?late');
    });
    await fits();
    await tab.click('#noisy');
    await tab.waitForFunction(() => document.querySelector('#said').textContent.length > 10);
  });
});

/** Focuses the first slider of the widget; returns a function that reads its value. */
async function focusSlider(tab, name) {
  const { id } = h.schema.find((widget) => widget.id === name).params.find(({ kind }) => kind === 'slider');
  await tab.evaluate(() => document.querySelector('slam-widget').set('more', 'on'));
  await tab.locator(`slam-widget #control-${id}`).focus();
  return () => tab.evaluate((param) => document.querySelector('slam-widget').get(param), id);
}

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

it('mdbook.html: an arrow key moves the focused slider, and turns no page', async () => {
  await example('mdbook.html', async (tab) => {
    await h.ready(tab);
    const value = await focusSlider(tab, 'w16.3');
    const before = await value();
    for (const key of ['ArrowRight', 'ArrowRight', 'ArrowLeft']) await tab.keyboard.press(key);
    assert.notEqual(await value(), before);
    assert.equal(await tab.evaluate(() => location.hash), '');
    await tab.evaluate(() => document.activeElement.blur());
    await tab.keyboard.press('ArrowRight');
    assert.equal(await tab.evaluate(() => location.hash), '#next');
  });
});

it('jupyter.html: the anywidget module in sync with its model, both ways', async () => {
  await example('jupyter.html', async (tab) => {
    await h.ready(tab);
    await tab.waitForFunction(() => traits.outcome !== null);
    assert.equal(await tab.evaluate(() => traits.value.noise), 2);
    await tab.evaluate(() => assign({ noise: 3 }));
    assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').noise), 3);
    await tab.evaluate(() => (document.querySelector('slam-widget').noise = 0.5));
    await tab.waitForFunction(() => traits.value.noise === 0.5);
    await tab.evaluate(() => unmount());
    assert.equal(await tab.locator('#cell > *').count(), 0);
  });
});

it('jupyter.html: values that the kernel repeats revert nothing, and new ones are set', async () => {
  await example('jupyter.html', async (tab) => {
    await h.ready(tab);
    await tab.waitForFunction(() => traits.value.seed !== undefined);
    const noise = () => tab.evaluate(() => document.querySelector('slam-widget').noise);
    await tab.evaluate(() => {
      document.querySelector('slam-widget').noise = 3;
      assign({ noise: 2 });
    });
    assert.equal(await noise(), 3);
    await tab.waitForFunction(() => traits.value.noise === 3);
    for (const said of [2, 1, 2]) {
      await tab.evaluate((value) => assign({ noise: value }), said);
      assert.equal(await noise(), said);
    }
  });
});

it('jupyter.html: an invalid value is reported in the cell, and the others are set', async () => {
  await example('jupyter.html', async (tab) => {
    const cell = tab.locator('#cell');
    const noise = () => tab.evaluate(() => document.querySelector('slam-widget').noise);
    await tab.evaluate(() => assign({ bogus: 1, noise: 3, seed: 'many' }));
    await cell.getByText('w16.2 has no parameter `bogus`').waitFor();
    await cell.getByText('`seed` takes a number, not `many`. It keeps its value.').waitFor();
    assert.equal(await noise(), 3);
    // Values that the widget writes to the model do not clear the message.
    await h.ready(tab);
    await tab.waitForFunction(() => traits.value.noise === 3);
    assert.match(await cell.innerText(), /no parameter `bogus`; it has [a-z, -]+\. `seed`/);
    await tab.evaluate(() => assign({ noise: 1 }));
    assert.equal(await noise(), 1);
    assert.doesNotMatch(await cell.innerText(), /bogus/);
    await tab.evaluate(() => assign('noise=2'));
    await cell.getByText('`value` takes an object of parameters').waitFor();
  });
});

it('a notebook that starts with an invalid value gets the widget and a sentence', async () => {
  await example('jupyter.html', async (tab) => {
    await tab.evaluate(() => {
      unmount();
      Object.assign(traits, { name: 'w16.1', value: { heading: 999, dx: 0.5 } });
      mount();
    });
    await tab.locator('#cell').getByText('`heading` takes -180 to 180, not `999`').waitFor();
    await h.ready(tab);
    assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').dx), 0.5);
    await tab.waitForFunction(() => traits.outcome !== null && traits.value.heading !== 999);
  });
});

it('myst.md: the widget runs from the file that MyST copies', async () => {
  const text = (file) => readFileSync(new URL(`../../web/examples/${file}`, import.meta.url), 'utf8');
  const [, path, body] = text('myst.md').match(/```\{anywidget\} \.\/(\S+)\n([\s\S]*?)```/);
  // MyST renames the module and renders into a shadow tree.
  const page = `<!doctype html><html lang="en"><title>MyST</title><link rel="icon" href="data:,">
    <div id="host"></div><script type="module">
      import widget from '/build/4f1c.mjs';
      const traits = ${body};
      const model = { get: (trait) => traits[trait], set: (trait, value) => (traits[trait] = value),
        save_changes() {}, on() {}, off() {} };
      const el = document.createElement('div');
      document.querySelector('#host').attachShadow({ mode: 'open' }).append(el);
      widget.render({ model, el });
      window.inside = () => el.querySelector('slam-widget');
    </script></html>`;
  const answer = (asked, response, { headers }) => {
    if (asked !== '/build/4f1c.mjs') return false;
    response.setHeader('Content-Type', TYPES['.mjs']);
    response.end(text(path).replace('localhost:8016', headers.host));
    return true;
  };
  await visit('', async (tab) => {
    await tab.waitForFunction(() => window.inside?.().state === 'running');
    assert.equal(await tab.evaluate(() => inside().noise), JSON.parse(body).value.noise);
  }, { server: { pages: { '/t.html': page }, answer } });
});

it('reveal.html: the widget runs on its slide, and the deck gets its keys', async () => {
  await example('reveal.html', async (tab) => {
    await tab.evaluate(() => deck);
    await tab.keyboard.press('ArrowRight');
    await h.ready(tab);
    const box = await tab.locator('slam-widget canvas').boundingBox();
    assert.ok(box.width > 700, `${box.width} wide`);
    const slide = () => tab.evaluate(async () => (await deck).getIndices().h);
    const value = await focusSlider(tab, 'w16.2');
    const before = await value();
    for (const key of ['ArrowRight', 'ArrowRight', 'ArrowLeft']) await tab.keyboard.press(key);
    assert.notEqual(await value(), before);
    assert.equal(await slide(), 1);
    await tab.evaluate(() => document.activeElement.blur());
    await tab.keyboard.press('ArrowLeft');
    await tab.waitForFunction(async () => (await deck).getIndices().h === 0);
  });
});

it('the npm package, packed and installed, works in a bundle, and links to its own embed.html', async () => {
  const project = installPackage();
  try {
    const manifest = JSON.parse(readFileSync(join(project.installed, 'package.json'), 'utf8'));
    for (const target of Object.values(manifest.exports)) {
      for (const file of typeof target === 'string' ? [target] : Object.values(target)) {
        const isThere = file.includes('*') || existsSync(join(project.installed, file));
        assert.ok(isThere, `${file} is not in the package`);
      }
    }
    writeFileSync(join(project.folder, 'main.js'),
      "import { widgets } from 'slam-widgets';\nimport 'slam-widgets/predict';\nwindow.names = widgets.map((widget) => widget.id);\n");
    const { outputFiles } = await esbuild.build({
      entryPoints: [join(project.folder, 'main.js')], bundle: true, minify: true, format: 'esm', write: false, outdir: project.folder,
    });
    // Only the files that docs/embedding.md lists are next to the bundle.
    const isBeside = /^\/app\/([^/]+\.wasm|pictures\/[^/]+|embed\.html|slam-[^/]+\.js)$/;
    const answer = (path, response) => {
      if (path === '/app/main.js') {
        response.setHeader('Content-Type', TYPES['.js']);
        response.end(outputFiles[0].text);
        return true;
      }
      const [, file] = path.match(isBeside) ?? [];
      if (file !== undefined) return send(join(project.installed, file), response);
      if (path === '/t.html') return false;
      response.statusCode = 404;
      response.end();
      return true;
    };
    const page = '<!doctype html><html lang="en"><title>App</title><link rel="icon" href="data:,"><script type="module" src="/app/main.js"></script><slam-widget name="w16.4" noise="2"></slam-widget></html>';
    const options = { permissions: ['clipboard-read', 'clipboard-write'] };
    await visit('', async (tab, server) => {
      await h.ready(tab);
      assert.deepEqual(await tab.evaluate(() => names), h.schema.map((widget) => widget.id));
      assert.ok(await tab.evaluate(() => customElements.get('slam-predict') !== undefined));
      await tab.getByText('Share', { exact: true }).click();
      await tab.getByRole('button', { name: 'Copy link' }).click();
      await tab.getByText('The link is copied.').waitFor();
      const link = await tab.evaluate(() => navigator.clipboard.readText());
      assert.equal(link, `${server.url}/app/embed.html?w=16.4&noise=2`);
      await tab.goto(link);
      await h.ready(tab);
    }, { server: { pages: { '/t.html': page }, answer }, options });
  } finally {
    project.remove();
  }
});

it('the examples of the site request only files that exist', () => {
  const folder = join(h.DIST, 'examples');
  for (const file of readdirSync(folder).filter((name) => /\.(html|js|mjs)$/.test(name))) {
    const text = readFileSync(join(folder, file), 'utf8');
    const asked = [...text.matchAll(/(?:src|href)="((?!\w+:)[^"#?]+)|from '(\.[^']+)'/g)].map(([, a, b]) => a ?? b);
    for (const path of asked) assert.ok(existsSync(join(folder, path)), `${file} asks for ${path}`);
  }
});

it('each recipe of docs/embedding.md names existing files, and each example has a recipe', () => {
  const text = readFileSync(new URL('../../docs/embedding.md', import.meta.url), 'utf8');
  const named = new Set([...text.matchAll(/web\/examples\/([\w.-]+)/g)].map(([, file]) => file));
  const folder = new URL('../../web/examples/', import.meta.url);
  for (const file of named) assert.ok(existsSync(new URL(file, folder)), file);
  const pages = readdirSync(folder).filter((file) => /\.(html|md|py)$/.test(file));
  assert.deepEqual(pages.filter((file) => !named.has(file)), []);
});
