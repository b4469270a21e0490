// "Write it yourself": an editor by the keyboard, tests as sentences, and code that can do no harm.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { it } from 'node:test';
import { violations } from './axe.mjs';
import * as clock from './clock.mjs';
import * as h from './harness.mjs';

const visit = h.visitor();

const NAMES = ['svd_align', 'point_to_plane_step', 'keep_pairs', 'gate'];

/** A page with one opened editor and nothing else. */
async function writing(name, test, how = {}) {
  const body = `<main><h1>Write</h1><details open data-write="${name}"><summary>Write it yourself</summary></details></main>
    <script type="module">import { open } from './write-yourself.js'; open(document.querySelector('details'));</script>`;
  await visit(body, async (tab) => {
    await tab.getByRole('textbox').waitFor();
    await test(tab);
  }, { fresh: true, ...how, options: { stepMs: clock.SMOOTH_MS } });
}

/** Types code by the keyboard in place of what is there. */
async function type(tab, code) {
  await tab.getByRole('textbox').click();
  await tab.keyboard.press('ControlOrMeta+a');
  await tab.keyboard.insertText(code);
}

/** Presses Run, and returns the sentences. */
async function run(tab) {
  await tab.getByRole('button', { name: 'Run', exact: true }).click();
  await tab.getByRole('button', { name: 'Run', exact: true, disabled: false }).waitFor();
  return tab.getByRole('status').locator('p').allTextContents();
}

it('each exercise fails as it is handed out, and passes with the solution of the last step of help', async () => {
  for (const name of NAMES) {
    await writing(name, async (tab) => {
      const [first] = await run(tab);
      assert.match(first, /^✗ .*: .*expected /, name);
      for (let step = 0; step < 4; step += 1) await tab.getByRole('button', { name: /^Help/ }).click();
      const solved = await run(tab);
      assert.match(solved[0], /^All \d tests pass: /, `${name}: ${solved.join('\n')}`);
      await tab.getByRole('textbox').click();
      await tab.keyboard.press('ControlOrMeta+z');
      assert.match((await run(tab))[0], /^✗ /, `${name}: undo brings the reader's code back`);
    });
  }
});

it('a wrong function is told which number was expected, which came, and what it means', async () => {
  await writing('svd_align', async (tab) => {
    // No turn: only the means are matched.
    await type(tab, `function svd_align(src, dst) {
      const mean = (points, k) => points.filter((_, at) => at % 2 === k).reduce((sum, one) => sum + one, 0) / (points.length / 2);
      return src.length === 0 ? [0, 0, 0] : [mean(dst, 0) - mean(src, 0), mean(dst, 1) - mean(src, 1), 0];
    }`);
    const sentences = await run(tab);
    assert.match(sentences[0], /^✗ A known motion: expected \(2\.0000 m, 1\.0000 m, 36\.870°\), but got \(2\.0000 m, 1\.0000 m, 0\.000°\)/);
    assert.ok(sentences.some((one) => /^✗ Mirrored points: .*the sign of the determinant/.test(one)), sentences.join('\n'));
    assert.ok(sentences.includes('✓ A corridor: as expected.') && sentences.includes('✓ No pairs: as expected.'));
  });
});

it('a loop without end is stopped, errors name their line, and a missing function is named', async () => {
  await writing('gate', async (tab) => {
    await type(tab, 'function gate() {\n  for (;;) {}\n}');
    assert.deepEqual(await run(tab), ['✗ There was no answer for 1 s, and your code was stopped. Is there an infinite loop?']);
    await type(tab, 'for (;;) {}');
    assert.match((await run(tab))[0], /no answer for 1 s/);
    await type(tab, 'function gate(innovation) {\n  const [x] = innovation;\n  return y;\n}');
    assert.match((await run(tab))[0], /^✗ A known innovation: your function ended with ReferenceError: y is not defined in line 3\.$/);
    assert.equal(await tab.locator('.cm-lintRange-error').count(), 1);
    await type(tab, 'function gate() {\n  return 1;\n}\nlet = ;');
    assert.match((await run(tab))[0], /^✗ Line 4: SyntaxError/);
    await type(tab, 'const other = 1;');
    assert.deepEqual(await run(tab), ['✗ There is no function gate. Keep its name.']);
  });
});

it('the code has no network, no page and no storage', async () => {
  const asked = [];
  const answer = (path) => {
    if (path.startsWith('/secret')) asked.push(path);
    return false;
  };
  await writing('gate', async (tab) => {
    const home = new URL(tab.url()).origin;
    await type(tab, `
      const found = [typeof document, typeof localStorage, self.origin];
      let tried = 'none';
      try { importScripts('${home}/secret.js'); tried = 'imported'; } catch (error) { tried = error.name; }
      try { const r = new XMLHttpRequest(); r.open('GET', '${home}/secret-xhr', false); r.send(); tried += ' sent'; } catch (error) { tried += ' ' + error.name; }
      fetch('${home}/secret-fetch').catch(() => {});
      try { new WebSocket('${home.replace('http', 'ws')}/secret-socket'); } catch {}
      function gate() { throw new Error([...found, tried].join(' ')); }`);
    assert.match((await run(tab))[0], /Error: undefined undefined null NetworkError NetworkError/);
    assert.deepEqual(asked, []);
  }, { quiet: false, server: { answer } });
});

it('a page whose policy forbids code says so', async () => {
  await writing('gate', async (tab) => {
    assert.match((await run(tab))[0], /^✗ The policy of this page does not let code run here/);
  }, { quiet: false, server: { policy: `${h.STRICT_POLICY.replace("script-src 'self'", "script-src 'self' 'unsafe-inline'")}; frame-src 'self'` } });
});

/** The frame of the code with another class of workers; a page sees each request for one in `window.asked`. */
const withWorkers = (members) => {
  const html = readFileSync(join(h.DIST, 'your-code.html'), 'utf8');
  const script = `<script>self.Worker = class { static Real = Worker; constructor(url) { this.url = url; parent.postMessage({ worker: null }, '*'); } ${members} };</script>`;
  return { quiet: false, head: "<script>addEventListener('message', ({ data }) => (window.asked ||= data.worker === null))</script>", server: { pages: { '/your-code.html': html.replace('<script>', `${script}<script>`) } } };
};

it('a worker that starts late runs the code, which has its second from then on', async () => {
  await writing('gate', async (tab) => {
    await tab.getByRole('button', { name: 'Run', exact: true }).click();
    await tab.waitForFunction(() => window.asked);
    await tab.evaluate(() => window.frameClock.pass(3000));
    await tab.evaluate(() => document.querySelector('iframe[title^="Your code"]').contentWindow.postMessage({ request: 'begin' }, '*'));
    await tab.getByRole('status').getByText(/^✗ A known innovation: expected/).waitFor();
  }, withWorkers(`postMessage(message) {
    if (message !== 'begin') { this.real.postMessage(message); return; }
    this.real = new this.constructor.Real(this.url);
    this.real.onmessage = (event) => this.onmessage(event);
  }`));
});

it('a worker that never starts is reported as such, with what to do', async () => {
  await writing('gate', async (tab) => {
    await tab.getByRole('button', { name: 'Run', exact: true }).click();
    await tab.waitForFunction(() => window.asked);
    await tab.evaluate(() => window.frameClock.skip(5000));
    await tab.getByRole('status').getByText('✗ The browser did not start your code within 5 s. Close other tabs and press the button again, or reload the page.', { exact: true }).waitFor();
  }, withWorkers('postMessage() {}'));
});

it('every page carries its policy, and the frame of the code runs none outside a sandbox', async () => {
  for (const page of [...h.PAGES, 'slides.html', 'notices.html']) {
    const html = readFileSync(join(h.DIST, page), 'utf8');
    const carrier = page !== 'notices.html' ? '<script data-policy' : '<meta http-equiv="Content-Security-Policy" content';
    const first = '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n';
    assert.ok(html.startsWith(`${first}${carrier}="default-src 'none'; script-src 'self' 'wasm-unsafe-eval';`), page);
  }
  await visit('', async (tab) => {
    const directive = await tab.evaluate(() => new Promise((resolve) => {
      document.addEventListener('securitypolicyviolation', ({ effectiveDirective }) => resolve(effectiveDirective));
      const script = document.createElement('script');
      script.textContent = "document.title = 'ran'";
      document.head.append(script);
    }));
    assert.match(directive, /^script-src/);
    assert.notEqual(await tab.title(), 'ran');
  }, { path: '/reference.html', quiet: false });
  await visit('<iframe src="/your-code.html"></iframe><iframe sandbox="allow-scripts" src="/your-code.html"></iframe>', async (tab) => {
    const told = await tab.evaluate(async () => {
      const heard = [];
      const frames = [...document.querySelectorAll('iframe')];
      addEventListener('message', ({ source, data }) => {
        heard.push([frames.findIndex((frame) => frame.contentWindow === source), Object.keys(data)]);
      });
      for (const frame of frames) await new Promise((loaded) => {
        frame.onload = loaded;
        frame.src = `${frame.src}?again`;
      });
      for (const frame of frames) frame.contentWindow.postMessage({ text: 'postMessage({ ran: true })' }, '*');
      while (!heard.some(([, keys]) => keys.includes('worker'))) await new Promise(requestAnimationFrame);
      return heard;
    });
    assert.deepEqual(told, [[1, ['started']], [1, ['worker']]]);
  });
});

it('functions are judged as by `ch16-mark`: right, wrong, noisy, slow and malicious ones', async () => {
  const corpus = JSON.parse(readFileSync(new URL('../reference/written-functions.json', import.meta.url), 'utf8'));
  for (const name of NAMES) {
    const of = corpus.filter((one) => one.function === name);
    if (of.length > 0) await writing(name, async (tab) => {
      for (const { kind, code, passes } of of) {
        await type(tab, code);
        const sentences = await run(tab);
        assert.equal(/^All [1-9]\d* tests pass: /.test(sentences[0]), passes, `${kind}: ${sentences.join('\n')}`);
        if (!passes) assert.match(sentences[0], /^✗ /, kind);
        if (kind === 'wrong: async') assert.match(sentences[0], /a promise: leave out async/);
      }
    }, { quiet: false });
  }
});

it('a run notes the help that was taken, 4 once the solution was shown', async () => {
  await writing('gate', async (tab) => {
    await tab.evaluate(() => {
      globalThis.noted = [];
      document.addEventListener('slam-code', ({ detail }) => globalThis.noted.push(detail.help));
    });
    await run(tab);
    await tab.getByRole('button', { name: /^Help/ }).click();
    await run(tab);
    for (let step = 1; step < 4; step += 1) await tab.getByRole('button', { name: /^Help/ }).click();
    const solution = await tab.locator('.cm-content').innerText();
    await type(tab, `${solution}\n// mine`);
    await run(tab);
    assert.deepEqual(await tab.evaluate(() => globalThis.noted), [0, 1, 4]);
  });
});

it('code is kept only on wish, and deleted when the wish is withdrawn', async () => {
  await writing('gate', async (tab) => {
    const kept = () => tab.evaluate(() => Object.keys(localStorage).filter((key) => key.startsWith('slam2d-code')));
    await type(tab, '// mine');
    assert.deepEqual(await kept(), []);
    await tab.getByLabel('Keep my code in this browser').check();
    assert.deepEqual(await kept(), ['slam2d-code/1:gate']);
    await tab.reload();
    await tab.getByRole('textbox').filter({ hasText: '// mine' }).waitFor();
    await tab.getByLabel('Keep my code in this browser').uncheck();
    assert.deepEqual(await kept(), []);
  });
});

it('the editor works by the keyboard and satisfies axe-core', async () => {
  await writing('keep_pairs', async (tab) => {
    await tab.getByRole('textbox').focus();
    assert.equal(await tab.getByRole('textbox').getAttribute('aria-label'), 'Your keep_pairs, in JavaScript. Tab leaves the editor.');
    await tab.keyboard.press('Tab');
    await tab.keyboard.press('Enter');
    await tab.getByText(/^✗ A box that moved/).waitFor();
    assert.deepEqual(await violations(tab), []);
  });
});

it('the page loads the editor when it is opened, and not before', async () => {
  const loaded = [];
  await visit('', async (tab) => {
    tab.on('request', (request) => loaded.push(new URL(request.url()).pathname));
    const places = tab.locator('details[data-write]');
    assert.deepEqual(await places.evaluateAll((all) => all.map((one) => one.dataset.write)), NAMES);
    assert.ok(!(await tab.evaluate(() => performance.getEntriesByType('resource').some(({ name }) => name.includes('write-yourself')))));
    await places.first().evaluate((one) => {
      for (let at = one; at !== null; at = at.parentElement?.closest('details') ?? null) at.open = true;
    });
    await places.first().getByRole('textbox').waitFor();
    assert.ok(loaded.includes('/write-yourself.js'));
  }, { path: '/index.html', fresh: true });
});
