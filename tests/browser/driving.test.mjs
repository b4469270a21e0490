// The reader's function drives the widgets: written by the keyboard, called in a worker, seen in the picture.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { it } from 'node:test';
import * as clock from './clock.mjs';
import * as h from './harness.mjs';

const visit = h.visitor();

/** A reader's own way to write the best motion: by the complex product of centred pairs. */
const ALIGN = `function svd_align(src, dst) {
  const n = src.length / 2;
  const mean = (points, axis) => { let sum = 0; for (let k = axis; k < points.length; k += 2) sum += points[k]; return sum / n; };
  if (n === 0) return [0, 0, 0];
  const p = [mean(src, 0), mean(src, 1)], q = [mean(dst, 0), mean(dst, 1)];
  let re = 0, im = 0;
  for (let k = 0; k < src.length; k += 2) {
    const a = [src[k] - p[0], src[k + 1] - p[1]], b = [dst[k] - q[0], dst[k + 1] - q[1]];
    re += a[0] * b[0] + a[1] * b[1];
    im += a[0] * b[1] - a[1] * b[0];
  }
  const t = Math.atan2(im, re), c = Math.cos(t), s = Math.sin(t);
  return [q[0] - c * p[0] + s * p[1], q[1] - s * p[0] - c * p[1], t];
}`;
/** The same without its turn. */
const SHIFT = ALIGN.replace('Math.atan2(im, re)', '0');

const W1 = 'slam-widget[name="w16.1"]';
const W2 = 'slam-widget[name="w16.2"]';

/** An editor beside the widgets. */
const page = (name) => `<main><h1>Drive</h1><details open data-write="${name}"><summary>Write it yourself</summary></details>
    <slam-widget name="w16.1"></slam-widget><slam-widget name="w16.2"></slam-widget></main>
    <script type="module">import { open } from './write-yourself.js'; open(document.querySelector('details'));</script>`;

async function beside(name, test, how = {}) {
  await visit(page(name), async (tab) => {
    await tab.getByRole('textbox').first().waitFor();
    await test(tab);
  }, { fresh: true, ...how, options: { stepMs: clock.SMOOTH_MS } });
}

async function type(tab, code) {
  await tab.locator('.cm-content').click();
  await tab.keyboard.press('ControlOrMeta+a');
  await tab.keyboard.insertText(code);
}

const press = (tab, name) => tab.getByRole('button', { name, exact: true }).click();
const says = (tab, text) => tab.getByRole('status').filter({ hasText: text }).waitFor();
const outcome = (tab, css) => tab.evaluate((at) => document.querySelector(at).outcome, css);

/** The outcome once its sentence has those words. */
async function said(tab, css, words) {
  await tab.waitForFunction(([at, text]) => document.querySelector(at).outcome?.sentence.includes(text), [css, words]);
  return outcome(tab, css);
}

/** 1e-9: the browser's atan2 and cos differ from libm in the last bit. */
function assertNear(found, expected, facts, tolerance = 1e-9) {
  for (const fact of facts) {
    const apart = Math.abs(found.facts[fact] - expected.facts[fact]);
    assert.ok(apart <= tolerance, `${fact}: ${found.facts[fact]} beside ${expected.facts[fact]}`);
  }
}

it('a step typed by the keyboard drives w16.1 beside ours and maps its basin, and ours drives again', async () => {
  await beside('svd_align', async (tab) => {
    await tab.locator(W1).scrollIntoViewIfNeeded();
    await h.ready(tab, W1);
    const ours = await outcome(tab, W1);
    await type(tab, ALIGN);
    await press(tab, 'Run');
    await says(tab, 'All 5 tests pass');
    await press(tab, 'Drive the registration of w16.1 with it');
    await says(tab, 'drives the registration of w16.1');
    const theirs = await said(tab, W1, 'your svd_align ends');
    assertNear(theirs, ours, ['error_m', 'error_deg', 'rmse_m', 'pairs', 'iterations']);
    assert.match(theirs.sentence, /Ours ends 0\.01 m/);
    // It follows what the reader changes.
    await tab.evaluate((at) => (document.querySelector(at).value = { heading: 65, dx: 0, dy: 0 }), W1);
    const turned = await said(tab, W1, 'From 65° off, your svd_align ends');
    assert.equal(turned.verdict, 'quarter turn');
    // Its basin map, cell by cell.
    const cells = () => tab.evaluate(async (at) => (await document.querySelector(at).tables()).find(({ id }) => id === 'basins').csv, W1);
    const isFull = async () => {
      while (/,[,\r]/.test(await cells())) await h.moreFrames(tab, 3, W1);
    };
    await tab.locator(W1).scrollIntoViewIfNeeded();
    await tab.evaluate((at) => document.querySelector(at).set('more', true), W1);
    await isFull();
    const theirMap = await cells();
    await press(tab, 'Let ours drive the registration of w16.1 again');
    await said(tab, W1, 'From 65° off, point-to-point ends');
    await tab.locator(W1).scrollIntoViewIfNeeded();
    await isFull();
    const [a, b] = [theirMap, await cells()].map((csv) => csv.split('\n'));
    const differing = a.filter((line, k) => line !== b[k]).length;
    // A start on the edge of two basins may fall to the other side by the last bit.
    assert.ok(differing <= a.length / 100, `${differing} of ${a.length}`);
  });
});

it('a step and a gate typed by the keyboard drive the lap of w16.2', async () => {
  await beside('svd_align', async (tab) => {
    await tab.locator(W2).scrollIntoViewIfNeeded();
    await h.ready(tab, W2);
    await tab.evaluate((at) => document.querySelector(at).set('t', 129), W2);
    const ours = await outcome(tab, W2);
    await type(tab, ALIGN);
    await press(tab, 'Drive the lap of w16.2 with it');
    const theirs = await said(tab, W2, 'With your svd_align, ');
    // 1 cm: a point on the edge of a cell falls to the other side by the last bit, and the lap differs in its millimetres.
    assertNear(theirs, ours, ['keyframe_rms_m', 'graph_error_m'], 0.01);
    assertNear(theirs, ours, ['loops_closed', 'false_loops', 'keyframes'], 0);
    await type(tab, SHIFT);
    await press(tab, 'Let ours drive the lap of w16.2 again');
    await press(tab, 'Drive the lap of w16.2 with it');
    await tab.waitForFunction(([at, rms]) => document.querySelector(at).outcome?.facts.keyframe_rms_m > 1.5 * rms, [W2, ours.facts.keyframe_rms_m]);
  });
  await beside('gate', async (tab) => {
    await tab.locator(W2).scrollIntoViewIfNeeded();
    await h.ready(tab, W2);
    await tab.evaluate((at) => document.querySelector(at).set('t', 129), W2);
    assert.ok((await outcome(tab, W2)).facts.loops_closed > 0);
    await type(tab, 'function gate(innovation, gap, drift, limit) {\n  return { chi2: Infinity, accepted: false };\n}');
    await press(tab, 'Drive the loops of w16.2 with it');
    assert.equal((await said(tab, W2, 'With your gate, ')).facts.loops_closed, 0);
    await type(tab, 'function gate(innovation, gap, drift, limit) {\n  return { chi2: 1, accepted: false };\n}');
    await press(tab, 'Let ours drive the loops of w16.2 again');
    await press(tab, 'Drive the loops of w16.2 with it');
    await says(tab, 'gate rejects a loop of χ² 1.000 at the limit 7.815: accepted has to be χ² ≤ limit');
    // Ours drives on.
    await tab.waitForFunction((at) => document.querySelector(at).outcome.facts.loops_closed > 0, W2);
    await type(tab, 'function gate(innovation, gap, drift, limit) {\n  return { chi2: NaN, accepted: false };\n}');
    await press(tab, 'Drive the loops of w16.2 with it');
    await says(tab, 'gate returned χ² NaN for an innovation of three numbers. Ours drives again.');
  });
});

/** A reader's own rejection: ranks instead of a sorted limit. */
const KEEP = `function keep_pairs(lengths, trim) {
  const order = [...lengths.keys()].sort((a, b) => lengths[a] - lengths[b] || a - b);
  return order.slice(0, Math.max(1, Math.ceil((1 - trim) * lengths.length))).sort((a, b) => a - b);
}`;

it('a rejection of pairs typed by the keyboard drives w16.1 beside ours, and the lap', async () => {
  await beside('keep_pairs', async (tab) => {
    await tab.locator(W1).scrollIntoViewIfNeeded();
    await h.ready(tab, W1);
    await tab.evaluate((at) => document.querySelector(at).set('trim', 0.4), W1);
    const ours = await outcome(tab, W1);
    await type(tab, KEEP);
    await press(tab, 'Drive the registration of w16.1 with it');
    const theirs = await said(tab, W1, 'your keep_pairs ends');
    assertNear(theirs, ours, ['error_m', 'error_deg', 'rmse_m', 'pairs', 'iterations']);
    await press(tab, 'Let ours drive the registration of w16.1 again');
    await said(tab, W1, 'point-to-point ends');
    // The longest instead of the shortest.
    await type(tab, KEEP.replace('lengths[a] - lengths[b]', 'lengths[b] - lengths[a]'));
    await press(tab, 'Drive the registration of w16.1 with it');
    const longest = await said(tab, W1, 'your keep_pairs ends');
    assert.ok(Math.abs(longest.facts.error_deg - ours.facts.error_deg) > 1, longest.sentence);
    await press(tab, 'Let ours drive the registration of w16.1 again');
    for (const [code, sentence] of [
      ['function keep_pairs(lengths) {\n  return [lengths.length];\n}', /keep_pairs keeps pair (\d+) of \1; they are numbered from 0\. Ours drives again\./],
      ['function keep_pairs() {\n  return 3;\n}', 'keep_pairs has to return an array of the indices of the pairs that it keeps. Ours drives again.'],
    ]) {
      await type(tab, code);
      await press(tab, 'Drive the registration of w16.1 with it');
      await says(tab, sentence);
    }
    await tab.locator(W2).scrollIntoViewIfNeeded();
    await h.ready(tab, W2);
    await tab.evaluate((at) => document.querySelector(at).set('t', 129), W2);
    const lap = await outcome(tab, W2);
    // The shorter half, whatever it is asked for.
    await type(tab, KEEP.replace('(1 - trim)', '0.5'));
    await press(tab, 'Drive the lap of w16.2 with it');
    assert.notEqual((await said(tab, W2, 'With your keep_pairs, ')).facts.keyframe_rms_m, lap.facts.keyframe_rms_m);
  });
});

it('a wrong function is told its fault and may drive, an error names its line, and a loop without end is stopped', async () => {
  await beside('svd_align', async (tab) => {
    await tab.locator(W1).scrollIntoViewIfNeeded();
    await h.ready(tab, W1);
    await type(tab, SHIFT);
    await press(tab, 'Run');
    await says(tab, '✗ A known motion: expected (2.0000 m, 1.0000 m, 36.870°)');
    const drive = 'Drive the registration of w16.1 with it';
    await press(tab, drive);
    const theirs = await said(tab, W1, 'your svd_align ends');
    assert.ok(Math.abs(theirs.facts.error_deg - 25) < 0.1, `${theirs.facts.error_deg}`);
    const faults = [
      ['function svd_align(src, dst) {\n  for (;;) {}\n}', 'There was no answer for 1 s, and your code was stopped. Is there an infinite loop? Ours drives again.'],
      ['function svd_align(src, dst) {\n  return [srk[0], 0, 0];\n}', 'Line 2: Your function ended with ReferenceError: srk is not defined. Ours drives again.'],
      ['function svd_align(src, dst) {\n  return [0, NaN, 0];\n}', 'svd_align returned [0, NaN, 0]: each has to be a finite number. Ours drives again.'],
      ['function svd_align(src, dst) {\n  return [src[0] / 0, 0, 0];\n}', /svd_align returned \[-?inf, 0, 0\]: each has to be a finite number\. Ours drives again\./],
      ['function svd_align(src, dst) {}', 'svd_align has to return three numbers, [x, y, θ]. Ours drives again.'],
      ['const other = 1;', 'There is no function svd_align. Keep its name. Ours drives again.'],
    ];
    await press(tab, 'Let ours drive the registration of w16.1 again');
    for (const [code, sentence] of faults) {
      await type(tab, code);
      await press(tab, drive);
      await says(tab, sentence);
      await said(tab, W1, 'point-to-point ends');
      await tab.getByRole('button', { name: drive, exact: true, disabled: false }).waitFor();
    }
  });
});

it('a link carries no code, and a new instance of the widget is driven by the same function', async () => {
  await beside('svd_align', async (tab) => {
    await tab.locator(W1).scrollIntoViewIfNeeded();
    await h.ready(tab, W1);
    await type(tab, SHIFT);
    await press(tab, 'Drive the registration of w16.1 with it');
    await said(tab, W1, 'your svd_align ends');
    const link = await tab.evaluate((at) => document.querySelector(at).link, W1);
    assert.ok(!/svd_align|function/.test(decodeURIComponent(link)), link);
    await tab.evaluate((at) => document.querySelector(at).suspend(), W1);
    await tab.locator(W1).scrollIntoViewIfNeeded();
    await h.ready(tab, W1);
    await said(tab, W1, 'your svd_align ends');
  });
});

it('in a frame without an origin the editor runs, and its function drives', async () => {
  const outer = '<!doctype html><html lang="en"><title>Frame</title><link rel="icon" href="data:,"><iframe sandbox="allow-scripts" width="900" height="800" src="/t.html"></iframe>';
  await visit(page('svd_align'), async (tab) => {
    const inner = tab.frameLocator('iframe');
    await inner.locator('.cm-content').click();
    await tab.keyboard.press('ControlOrMeta+a');
    await tab.keyboard.insertText(ALIGN);
    await inner.getByRole('button', { name: 'Run', exact: true }).click();
    await inner.getByText('All 5 tests pass').waitFor();
    await inner.getByRole('button', { name: 'Drive the registration of w16.1 with it' }).click();
    await inner.getByText('drives the registration of w16.1').waitFor();
    const frame = tab.frames().find((one) => one.url().endsWith('/t.html'));
    await frame.waitForFunction((at) => document.querySelector(at).outcome?.sentence.includes('your svd_align ends'), W1);
    await inner.getByLabel('Keep my code in this browser').click();
    await inner.getByText('This browser does not let the page store anything.').waitFor();
  }, { fresh: true, path: '/outer.html', server: { pages: { '/outer.html': outer } }, options: { stepMs: clock.SMOOTH_MS } });
});

it('a program that does not arrive, or may not start, is reported with its cause and what to do', async () => {
  const tries = async (sentence, server) => {
    await beside('svd_align', async (tab) => {
      await press(tab, 'Drive the registration of w16.1 with it');
      await says(tab, sentence);
      await says(tab, 'Ours drives again.');
    }, { quiet: false, server });
  };
  for (const missing of ['/write-worker-', '/slam_robot-']) {
    await tries('The program that calls your code could not be fetched (status 404). Check the connection and press the button again.', {
      answer: (path, response) => {
        if (!path.startsWith(missing)) return false;
        response.statusCode = 404;
        response.end();
        return true;
      },
    });
  }
  const html = readFileSync(join(h.DIST, 'your-code.html'), 'utf8');
  await tries(/The widgets’ program did not start alongside your code \(.+\)\. Close other tabs/, {
    pages: { '/your-code.html': html.replace(" 'wasm-unsafe-eval'", '') },
  });
});
