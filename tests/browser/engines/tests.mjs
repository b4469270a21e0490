// The tests that run in every engine: what differs between browsers, and nothing that one of them proves for all.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { pathToFileURL } from 'node:url';
import * as h from '../harness.mjs';
import { native } from '../../native.mjs';
import { skip } from '../../skip.mjs';
import { driveOf, robotServer } from '../robot-server.mjs';
import { unpackOffline } from '../unpacked.mjs';
import { WATCH, WATCH_TEXT, ask, click, clickButton, clickControl, live, loaded, troublesOf, until, watched } from './page.mjs';

/** Frames of the page in which a widget has heard of a drag that has ended. */
const FRAMES_AFTER_DRAG = 6;

/** The widgets that lose a context: what replaces it is the same for all, and each takes a second or more. */
const LOSING = ['w16.1', 'w16.3', 'w16.10'];

/** A page with `body`, and one with it in a sandbox. */
const WIDGETS = h.schema.map(({ id }) => `<div style="padding-bottom: 80vh"><slam-widget name="${id}" more="on"></slam-widget></div>`).join('');
const PAGES = {
  '/widgets.html': h.bare(WIDGETS, '<style>body { margin: 0 } slam-widget { max-width: 900px }</style>'),
  '/sandbox.html': `<!doctype html><meta charset="utf-8"><title>Sandbox</title><body>
    <iframe sandbox="allow-scripts" style="width: 900px; height: 850px; border: 0"></iframe></body>`,
  '/write.html': h.bare(`<details open data-write="gate"><summary>Write it yourself</summary></details>
    <script type="module">import { open } from './write-yourself.js'; open(document.querySelector('details'));</script>`),
  '/clean.html': '<!doctype html><meta charset="utf-8"><title>Another page</title><a href="widgets.html">Back</a>',
};

/**
 * Serves the site; each page records its errors, the server the files that it has not. While `half.wanted`, the first half of
 * a module is sent, and `half.sent` resolves.
 */
async function serve(missing, modules, half) {
  const answer = (pathname, response) => {
    if (pathname === WATCH) {
      response.setHeader('Content-Type', 'text/javascript');
      response.end(WATCH_TEXT);
      return true;
    }
    if (pathname.endsWith('.wasm')) modules.push(pathname);
    if (pathname.endsWith('.wasm') && half.wanted !== undefined) {
      const bytes = readFileSync(join(h.DIST, pathname));
      response.setHeader('Content-Type', 'application/wasm');
      response.setHeader('Content-Length', bytes.length);
      response.write(bytes.subarray(0, bytes.length / 2), half.wanted);
      return true;
    }
    const isPage = pathname.endsWith('.html') && pathname !== '/your-code.html';
    if (!isPage) {
      response.on('finish', () => response.statusCode === 404 && pathname !== '/favicon.ico' && missing.push(pathname));
      return false;
    }
    response.setHeader('Content-Type', 'text/html; charset=utf-8');
    response.end(watched(PAGES[pathname] ?? readFileSync(join(h.DIST, pathname), 'utf8')));
    return true;
  };
  return h.serve({ answer });
}

/** Declares the tests for an engine: `open` starts it, `problem` says why it cannot. */
export function testIn(name, open, problem) {
  describe(name, () => {
    let page;
    let server;
    const missing = [];
    const modules = [];
    const half = { wanted: undefined };
    const why = problem();

    before(async () => {
      if (why !== undefined) return;
      server = await serve(missing, modules, half);
      page = await open();
      await page.resize(1100, 900);
    });
    after(async () => {
      await page?.close();
      await server?.close();
    });
    const test = (title, run) => it(title, async (context) => {
      if (why !== undefined) {
        skip(context, `${name} ${why}`);
        return;
      }
      missing.length = 0;
      await run(context);
      assert.deepEqual(missing, []);
    });
    const visit = async (path) => {
      await page.goto(`${server.url}${path}`);
      await loaded(page);
    };
    const isClean = async () => assert.deepEqual(await troublesOf(page), []);

    test('every page starts without an error, a violation of its policy, or a missing file', async (context) => {
      for (const file of [...h.PAGES, 'slides.html', 'embed.html']) {
        await context.test(file, async () => {
          await page.goto(`${server.url}/${file}${file === 'embed.html' ? '?w=16.1' : ''}`);
          await loaded(page);
          const first = await ask(page, () => [...document.querySelectorAll('slam-widget')]
            .find((widget) => widget.getBoundingClientRect().height > 0 && widget.getBoundingClientRect().top < innerHeight)?.name);
          if (first) await live(page, first);
          assert.deepEqual(await troublesOf(page), []);
        });
      }
    });

    test('every widget starts, follows the pointer and the keyboard, plays, and concludes what it does natively; three recover from a lost context', async (context) => {
      await visit('/widgets.html');
      for (const widget of h.schema) {
        await context.test(widget.id, async () => {
          await ask(page, (id) => document.querySelector(`slam-widget[name="${id}"]`).scrollIntoView(), widget.id);
          await live(page, widget.id);
          const expected = JSON.parse(native('states', widget.id).trim().split('\n').at(-1));
          await followsPointer(page, widget.id, expected.timeline.param);
          await followsKeyboard(page, widget);
          await plays(page, widget);
          if (LOSING.includes(widget.id)) await recovers(page, widget.id);
          await concludes(page, widget.id, expected);
        });
      }
      await isClean();
    });

    test('the sample of w16.10 is mapped, and its session saved; then a robot that drives', async () => {
      await visit('/own-robot.html?w=16.10');
      await live(page, 'w16.10');
      await mapsSample(page);
      await ask(page, () => document.querySelector('slam-widget').press('save'));
      await until(page, () => window.saved.some(({ size }) => size > 1000));
      await mapsRobot(page);
      await isClean();
    });

    test('who scrolls fetches the module of the widgets once', async () => {
      await page.goto(`${server.url}/index.html`);
      await until(page, () => document.querySelector('#lap.live') !== null);
      modules.length = 0;
      await ask(page, () => scrollBy(0, 40));
      await ask(page, () => document.querySelector('slam-widget').scrollIntoView());
      await until(page, () => document.querySelector('slam-widget').shadowRoot?.querySelector('.stage.live') !== null);
      assert.equal(modules.length, 1, modules.join(' '));
    });

    for (const [what, path, expected] of [
      ['a page of the chapter in a sandbox runs its lap and its widgets', '/index.html?w=16.1', { ready: 'w16.1', hasLap: true }],
      ['a slide in a sandbox runs its widget', slideOf('w16.1'), { ready: 'w16.1', hasLap: false }],
    ]) {
      test(what, async () => {
        await page.goto(`${server.url}/sandbox.html`);
        await ask(page, (src) => {
          addEventListener('message', ({ data }) => { if (data?.ready) window.framed = data; });
          document.querySelector('iframe').src = src;
        }, path);
        const framed = await until(page, () => window.framed);
        assert.deepEqual(framed, { ...expected, troubles: [] });
      });
    }

    test('a frame in a sandbox runs a widget, and maps the sample', async () => {
      await page.goto(`${server.url}/sandbox.html`);
      await ask(page, (src) => {
        window.told = [];
        addEventListener('message', ({ data }) => data?.slam === 1 && window.told.push(data));
        document.querySelector('iframe').src = src;
      }, '/embed.html?w=16.10');
      const heard = (wanted) => until(page, `() => {
        const problem = window.told.find(({ type }) => type === 'error')?.message;
        return problem ?? window.told.map(${wanted}).find(Boolean);
      }`);
      assert.equal(await heard(({ type }) => type === 'ready' && 'ready'), 'ready');
      await ask(page, () => document.querySelector('iframe').contentWindow.postMessage({ slam: 1, type: 'press', button: 'sample' }, '*'));
      const mapped = await heard(({ type, outcome }) => {
        if (type !== 'result') return null;
        if (outcome.facts.keyframes > 5) return 'mapped';
        return /cannot|stopped/.test(outcome.sentence) && outcome.sentence;
      });
      assert.equal(mapped, 'mapped');
    });

    test('a reader\u2019s code is tested: right, wrong, with a syntax error, and without end', async () => {
      await page.goto(`${server.url}/write.html`);
      await until(page, () => document.querySelector('.cm-content') !== null);
      for (const [code, answer] of [
        ['function gate(innovation, gap) { return 1; }', /^✗ .*expected/],
        ['function gate(innovation) {\n  return (1;\n}', /^✗ Line 2: .*(SyntaxError|Unexpected|missing)/],
        ['function gate() { for (;;); }', /no answer for 1 s/],
      ]) {
        const line = await runCode(page, code);
        assert.match(line, answer, code);
      }
      for (let step = 0; step < 4; step += 1) await clickButton(page, 'Help');
      assert.match(await runCode(page), /^All \d tests pass/);
    });

    test('Back returns to a page whose widgets run', async () => {
      await visit('/index.html?w=16.1&heading=30');
      await ask(page, () => document.querySelector('slam-widget[name="w16.1"]').scrollIntoView());
      await live(page, 'w16.1');
      await page.goto(`${server.url}/clean.html`);
      await page.back();
      await loaded(page);
      await ask(page, () => document.querySelector('slam-widget[name="w16.1"]').scrollIntoView());
      await live(page, 'w16.1');
      assert.equal(await ask(page, () => document.querySelector('slam-widget[name="w16.1"]').heading), 30);
      await isClean();
    });

    test('who leaves while the module arrives returns to a page whose widgets run', async () => {
      const sent = new Promise((resolve) => { half.wanted = resolve; });
      await visit('/widgets.html');
      await sent;
      await until(page, () => document.querySelector('slam-widget').shadowRoot.querySelector('progress').value > 0);
      half.wanted = undefined;
      // WebKit keeps the page both times: without what it was fetching, and as it ran.
      for (const left of ['while the module arrives', 'while it runs']) {
        await page.goto(`${server.url}/clean.html`);
        await page.back();
        await loaded(page);
        await live(page, 'w16.1');
        await followsKeyboard(page, { id: 'w16.1' });
        assert.deepEqual(await troublesOf(page), [], left);
      }
    });

    test('the offline site opens from the disk, runs a widget, and maps the sample', async () => {
      const folder = mkdtempSync(join(tmpdir(), 'engines-'));
      try {
        unpackOffline(join(folder, 'site.zip'), folder, (file, bytes) =>
          file.endsWith('.html') ? watched(Buffer.from(bytes).toString()).replace(WATCH, WATCH.slice(1)) : bytes);
        writeFileSync(join(folder, WATCH.slice(1)), WATCH_TEXT);
        await page.goto(`${pathToFileURL(folder).href}/own-robot.html?w=16.10`);
        await loaded(page);
        await live(page, 'w16.10');
        await mapsSample(page);
        await isClean();
        await page.goto('about:blank');
      } finally {
        rmSync(folder, { recursive: true });
      }
    });
  });
}

/** The address of a widget's slide. */
function slideOf(id) {
  const slides = readFileSync(join(h.DIST, 'slides.html'), 'utf8').split('<section ').slice(1);
  return `/slides.html#${slides.findIndex((slide) => slide.startsWith('class="figure"') && slide.includes(`name="${id}"`)) + 1}`;
}

/** Presses the sample of w16.10 and waits for its map. */
async function mapsSample(page) {
  await ask(page, () => void document.querySelector('slam-widget').press('sample'));
  const end = await until(page, () => {
    const { outcome } = document.querySelector('slam-widget');
    return outcome && (outcome.facts.keyframes > 5 || /cannot|stopped/.test(outcome.sentence)) && outcome;
  });
  assert.ok(end.facts.keyframes > 5, end.sentence);
}

/** Connects to a robot that drives, by its panel, and stops once all its scans are there. */
async function mapsRobot(page) {
  const messages = driveOf(readFileSync(join(h.DIST, 'samples', 'ring.log'), 'utf8')).slice(0, 201);
  const scans = messages.filter(({ topic }) => topic === '/scan').length;
  const robot = await robotServer({ messages });
  try {
    const inPanel = (css) => `() => document.querySelector('slam-widget').shadowRoot.querySelector('.connection ${css}')`;
    const says = (words) => until(page, `(words) => (${inPanel('')})().textContent.includes(words)`, words);
    await click(page, inPanel('summary'));
    await ask(page, `(url) => { (${inPanel('input')})().value = url; }`, robot.url);
    await click(page, inPanel('button[type=submit]'));
    await says(`${scans} scans arrived`);
    await until(page, `() => { for (const button of document.querySelector('slam-widget').shadowRoot.querySelectorAll('.connection button')) if (button.textContent === 'Stop') { button.click(); return true; } }`);
    await says(`${scans} scans arrived, ${scans} are mapped.`);
  } finally {
    await robot.close();
  }
}

/** Runs code in the editor, or what is there; returns the first sentence. */
async function runCode(page, code) {
  if (code !== undefined) {
    await ask(page, (text) => {
      const content = document.querySelector('.cm-content');
      const { view } = content.cmView ?? content.cmTile;
      view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
    }, code);
  }
  await clickButton(page, 'Run');
  return until(page, () => {
    const text = document.querySelector('.write-results p')?.textContent;
    return !document.querySelector('.write-controls button').disabled && text !== 'Your function is being called …' && text;
  });
}

/** Values of a widget, as one text. */
const state = (id) => JSON.stringify(document.querySelector(`slam-widget[name="${id}"]`).value);

/** Waits until the values of a widget differ from earlier ones. */
function changed(page, id, earlier) {
  return until(page, `(id, earlier) => (${state})(id) !== earlier`, id, earlier);
}

/** An arrow key moves the first slider that is shown, and a drag of its thumb. */
async function followsKeyboard(page, { id }) {
  const earlier = await ask(page, state, id);
  const found = await ask(page, (name) => {
    const { shadowRoot } = document.querySelector(`slam-widget[name="${name}"]`);
    const range = [...shadowRoot.querySelectorAll('input[type=range]')].find((one) => one.getClientRects().length > 0 && Number(one.max) > Number(one.min));
    range?.focus();
    return range && (range.value === range.max ? 'ArrowLeft' : 'ArrowRight');
  }, id);
  if (!found) return;
  await page.press(found);
  await changed(page, id, earlier);
}

/** Places in the picture that drag, those farthest from what does not drag first: the middle of a handle is among them. */
const grips = (id) => {
  const [STEP_PX, APART_PX, MOST] = [6, 40, 6];
  const widget = document.querySelector(`slam-widget[name="${id}"]`);
  widget.scrollIntoView();
  const box = widget.shadowRoot.querySelector('canvas').getBoundingClientRect();
  const [columns, rows] = [box.width, Math.min(box.height, innerHeight - box.top - 60)].map((side) => Math.floor(side / STEP_PX));
  const drags = Array.from({ length: rows }, (_, row) => Array.from({ length: columns }, (_, column) => widget.dragsAt(STEP_PX * column, STEP_PX * row)));
  const reachOf = (row, column) => {
    let reach = 0;
    const isDragging = (dx, dy) => drags[row + dy]?.[column + dx] === true;
    const holds = (n) => [-n, n].every((far) => Array.from({ length: 2 * n + 1 }, (_, k) => k - n).every((k) => isDragging(far, k) && isDragging(k, far)));
    while (reach < MOST && holds(reach)) reach += 1;
    return reach;
  };
  const found = drags.flatMap((line, row) => line.map((_, column) => ({ x: box.left + STEP_PX * column, y: box.top + STEP_PX * row, reach: reachOf(row, column) })));
  const apart = [];
  for (const one of found.filter(({ reach }) => reach > 0).sort((a, b) => b.reach - a.reach)) {
    if (apart.length < MOST && apart.every(({ x, y }) => Math.hypot(one.x - x, one.y - y) > APART_PX)) apart.push(one);
  }
  return apart;
};

/** A drag of something in the picture changes a value other than the moment that a run plays. */
async function followsPointer(page, id, moment) {
  const spots = await ask(page, grips, id);
  // The map of a recording does not drag.
  if (id === 'w16.10') {
    assert.deepEqual(spots, []);
    return;
  }
  const values = () => ask(page, (name, played) => {
    const { [played]: _, ...value } = document.querySelector(`slam-widget[name="${name}"]`).value;
    return JSON.stringify(value);
  }, id, moment);
  for (const { x, y } of spots) {
    const earlier = await values();
    // WebKit may answer before its page has heard of a release.
    await ask(page, () => {
      window.isReleased = false;
      addEventListener('pointerup', () => { window.isReleased = true; }, { capture: true, once: true });
    });
    await page.move(x, y);
    await page.down();
    for (const step of [6, 14, 24, 36]) await page.move(x + step, y + step / 3);
    await page.up();
    await until(page, () => window.isReleased);
    await page.evaluate(`(async () => { for (let frame = 0; frame < ${FRAMES_AFTER_DRAG}; frame += 1) await new Promise(requestAnimationFrame); })()`);
    if ((await values()) !== earlier) return;
  }
  assert.fail(`${id}: no drag changes a value, from ${JSON.stringify(spots)}`);
}

/** After its last preset a widget has the outcome that the native program computes, to the bit. */
async function concludes(page, id, { preset, outcome }) {
  const found = await ask(page, async (name, button) => {
    const widget = document.querySelector(`slam-widget[name="${name}"]`);
    await widget.press(button);
    while (widget.outcome === undefined) await new Promise((resolve) => setTimeout(resolve, 20));
    return widget.outcome;
  }, id, preset);
  assert.deepEqual(found, outcome);
}

/** Play moves the run on. */
async function plays(page, { id, buttons }) {
  if (!['play', 'reset'].every((needed) => buttons.some((button) => button.id === needed))) return;
  const isOffered = await ask(page, (name) => document.querySelector(`slam-widget[name="${name}"]`).shadowRoot.querySelector('button[data-control="play"]')?.getClientRects().length > 0, id);
  if (!isOffered) return;
  await ask(page, (name) => document.querySelector(`slam-widget[name="${name}"]`).press('reset'), id);
  const earlier = await ask(page, state, id);
  await clickControl(page, id, 'play');
  await changed(page, id, earlier);
  await until(page, async (name) => {
    const widget = document.querySelector(`slam-widget[name="${name}"]`);
    if (widget.shadowRoot.querySelector('button[data-control="play"]').textContent !== 'Pause') return true;
    await widget.press('play');
    return false;
  }, id);
}

/** A new canvas takes the place of one whose context is lost, with the same values. */
async function recovers(page, id) {
  const earlier = await ask(page, (name) => {
    const widget = document.querySelector(`slam-widget[name="${name}"]`);
    const canvas = widget.shadowRoot.querySelector('canvas');
    window.lost = canvas;
    const values = JSON.stringify(widget.value);
    canvas.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext();
    return values;
  }, id);
  await until(page, (name) => {
    const canvas = document.querySelector(`slam-widget[name="${name}"]`).shadowRoot.querySelector('.stage.live canvas');
    return canvas !== null && canvas !== window.lost;
  }, id);
  assert.equal(await ask(page, state, id), earlier);
}
