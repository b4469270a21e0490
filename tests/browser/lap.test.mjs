// The strip under the title: the canonical lap, replayed from data of the core.

import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { brotliCompressSync } from 'node:zlib';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const reading = (test, options = {}, how = {}) => visit('', test, { path: '/index.html', options, ...how });
const live = (tab) => tab.waitForSelector('#lap.live');
/** Loads a module of the strip in Node. */
async function load(file) {
  const web = new URL('../../web/', import.meta.url);
  const { build } = createRequire(web)('esbuild');
  const { outputFiles } = await build({
    entryPoints: [new URL(`page/lap/${file}`, web).pathname], bundle: true, format: 'esm', write: false, logLevel: 'warning',
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
}
const slider = (tab) => tab.locator('.lap-controls input');
const button = (tab) => tab.locator('.lap-controls button');
const tick = (tab) => tab.evaluate(() => Number(document.querySelector('#lap').dataset.tick));
const act = (tab) => tab.locator('.lap-acts li[aria-current]').textContent();
/** Waits until an act begins so: the page may hear a touch late. */
const acts = (tab, words) => tab.locator('.lap-acts li[aria-current]').filter({ hasText: words }).waitFor();
/** Waits until the button says that. */
const offers = (tab, words) => tab.locator('.lap-controls').getByRole('button', { name: words, exact: true }).waitFor();
/** Waits until a hundredth of the canvas is painted, which happens in the frame after its resize. */
const inked = (tab) => tab.waitForFunction(() => {
  const canvas = document.querySelector('.lap-picture canvas');
  if (canvas.width === 0 || canvas.height === 0) return false;
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return data.reduce((sum, value, at) => sum + (at % 4 === 3 && value > 128 ? 1 : 0), 0) > 0.01 * (data.length / 4);
});

/** The page, modified to record the order of the acts. */
const noting = readFileSync(join(h.DIST, 'index.html'), 'utf8').replace('<head>', `<head><script>
  window.acts = [];
  addEventListener('DOMContentLoaded', () => new MutationObserver(() => {
    const name = document.querySelector('.lap-acts li[aria-current] b')?.textContent;
    if (name !== undefined && acts.at(-1) !== name) acts.push(name);
  }).observe(document.querySelector('.lap-acts'), { subtree: true, attributeFilter: ['aria-current'] }));
</script>`);

/** The lap that its script contains. */
const storyOf = (script) => JSON.parse(script.match(/'(\{"[^']*\})'/)[1]);

describe('the lap under the title', () => {
  it('moves while the scripts of the page and of the widgets are on their way', async () => {
    const held = [];
    const answer = (path, response) => {
      const isHeld = /^\/(slam-widget|page)/.test(path) && path.endsWith('.js');
      if (isHeld) held.push(response);
      return isHeld;
    };
    // Waiting for the load of the page would wait for these scripts.
    await visit('', async (tab) => {
      await tab.goto(`${tab.home}/index.html`, { waitUntil: 'commit' });
      await live(tab);
      await tab.waitForFunction(() => Number(document.querySelector('.lap-controls input').value) > 0);
      assert.equal(await tab.evaluate(() => customElements.get('slam-widget')), undefined);
      assert.ok(held.length >= 2, `${held.length} are held back`);
    }, { path: '/notices.html', server: { answer }, quiet: false });
  });

  for (const viewport of [{ width: 1440, height: 900 }, { width: 390, height: 844 }]) {
    it(`is interactive on the first screen, at ${viewport.width}×${viewport.height}`, async () => {
      await reading(async (tab) => {
        const place = () => tab.evaluate(() => {
          const { top, bottom } = document.querySelector('.lap-picture').getBoundingClientRect();
          return { top, bottom, height: document.querySelector('#lap').offsetHeight };
        });
        await tab.waitForFunction(() => document.documentElement.dataset.script === 'on');
        const before = await place();
        await live(tab);
        const after = await place();
        assert.ok(after.top >= 0 && after.bottom <= viewport.height, JSON.stringify(after));
        await inked(tab);
        // The still picture was at the same position.
        assert.ok(Math.abs(after.height - before.height) <= 2, `${before.height} px, then ${after.height}`);
        assert.equal(before.top, after.top);
      }, { viewport });
    });
  }

  it('plays before the module of the widgets is fetched, on a page of at most 300 kB', async () => {
    for (const viewport of [{ width: 1440, height: 900 }, { width: 390, height: 844 }]) {
      const asked = new Set();
      const answer = (path) => void asked.add(path);
      await reading(async (tab) => {
        await live(tab);
        await h.quiet(tab);
        const weights = [...asked].filter((path) => !path.endsWith('.woff2')).map((path) => {
          const bytes = readFileSync(join(h.DIST, path));
          // The script of a quick build includes a source map.
          const sent = path.endsWith('.js') ? Buffer.from(bytes.toString().replace(/\n\/\/# sourceMappingURL=.*/s, '')) : bytes;
          return [path, brotliCompressSync(sent).length];
        });
        const total = weights.reduce((sum, [, bytes]) => sum + bytes, 0);
        assert.ok(total > 50_000 && total <= 300_000, `${total} bytes: ${weights.join(' ')}`);
        // The stills of the first two widgets are near enough to be fetched ahead; their bytes are in the sum above.
        assert.deepEqual([...asked].filter((path) => /\.wasm$|pictures\/w16\.(?!1-|11-)/.test(path)), []);
      }, { viewport }, { server: { answer } });
    }
  });

  it('restyles no other part of the page while it plays', async () => {
    await reading(async (tab) => {
      await live(tab);
      await h.quiet(tab);
      await offers(tab, 'Play again');
      await button(tab).click();
      const played = (least) => tab.waitForFunction((s) => Number(document.querySelector('.lap-controls input').value) > s, least);
      await played(0);
      const browser = tab.context().browser();
      await browser.startTracing(tab, { categories: ['devtools.timeline'] });
      await played(4);
      const { traceEvents } = JSON.parse(await browser.stopTracing());
      const named = (which) => traceEvents.filter(({ name }) => name === which);
      assert.ok(named('FireAnimationFrame').length > 5, 'it plays');
      // A pass that the end of the trace cuts short has no count. The largest is set aside: a font that arrives late, or the
      // browser itself, may restyle the page once, whereas a strip that restyled it would do so in each frame.
      const passes = named('UpdateLayoutTree').filter(({ args }) => 'elementCount' in args);
      const counts = passes.map(({ args }) => args.elementCount).sort((a, b) => a - b).slice(0, -1);
      const restyled = counts.reduce((sum, count) => sum + count, 0);
      const elements = await tab.evaluate(() => document.querySelectorAll('*').length);
      assert.ok(passes.length > 0 && elements > 3000 && restyled < elements / 10, `${restyled} of ${elements}`);
    });
  });

  it('fetches the module once for page and widgets, as soon as the reader scrolls', async () => {
    const asked = [];
    const answer = (path) => void (path.endsWith('.wasm') && asked.push(path));
    await reading(async (tab) => {
      await live(tab);
      await h.quiet(tab);
      assert.equal(asked.length, 0);
      const request = tab.waitForRequest((one) => one.url().endsWith('.wasm'));
      await tab.evaluate(() => scrollBy(0, 40));
      await request;
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').state), 'resting');
      await tab.locator('slam-widget[name="w16.1"]').scrollIntoViewIfNeeded();
      await h.ready(tab, 'slam-widget[name="w16.1"]');
      assert.equal(asked.length, 1);
    }, {}, { server: { answer } });
  });

  it('plays its acts in about ten seconds, and stops', async () => {
    await reading(async (tab) => {
      await live(tab);
      const lengthS = Number(await slider(tab).getAttribute('max'));
      assert.ok(lengthS > 9 && lengthS < 12, `${lengthS} s`);
      await tab.waitForFunction(() => document.querySelector('.lap-controls button').textContent === 'Play again');
      assert.equal(await tick(tab), 129);
      assert.deepEqual(await tab.evaluate(() => acts), ['Wheels drive through walls.', 'Walls appear double.', 'The loop snaps.']);
      await h.quiet(tab);
    }, {}, { server: { pages: { '/index.html': noting } } });
  });

  it('pauses while it is out of view', async () => {
    await reading(async (tab) => {
      await live(tab);
      await tab.evaluate(() => scrollTo(0, 3 * innerHeight));
      await h.quiet(tab);
      const stood = await slider(tab).inputValue();
      await tab.evaluate(() => frameClock.pass(3000));
      assert.equal(await slider(tab).inputValue(), stood);
      assert.equal(await button(tab).textContent(), 'Pause');
      await tab.evaluate(() => scrollTo(0, 0));
      await tab.waitForFunction((old) => document.querySelector('.lap-controls input').value > old, stood);
    }, { stepMs: 100 });
  });

  it('shows the doubled walls under reduced motion, and is controlled by keyboard and touch', async () => {
    await reading(async (tab) => {
      await live(tab);
      await h.quiet(tab);
      assert.match(await act(tab), /^Walls appear double/);
      assert.equal(await button(tab).textContent(), 'Play');
      const rested = await tick(tab);
      assert.equal(rested, 92);
      await slider(tab).focus();
      for (let press = 0; press < 20; press += 1) await tab.keyboard.press('ArrowLeft');
      assert.ok((await tick(tab)) < rested);
      assert.match(await slider(tab).getAttribute('aria-valuetext'), /^Walls appear double, tick \d+$/);
      await tab.keyboard.press('End');
      assert.equal(await tick(tab), 129);
      // It plays from there: the clock is stopped until the test has read the position.
      await tab.evaluate(() => frameClock.hold(true));
      await tab.getByRole('button', { name: 'Wheels drive through walls.' }).tap();
      await offers(tab, 'Pause');
      assert.ok((await tick(tab)) < 64);
      await button(tab).tap();
      await offers(tab, 'Play');
      await tab.evaluate(() => frameClock.hold(false));
      const { x, y, width, height } = await slider(tab).boundingBox();
      await tab.touchscreen.tap(x + 0.8 * width, y + height / 2);
      await acts(tab, /^The loop snaps/);
    }, { reducedMotion: 'reduce', hasTouch: true });
  });

  it('is scrubbed by dragging the robot, to the turn and back', async () => {
    await reading(async (tab) => {
      await live(tab);
      await slider(tab).press('Home');
      const { x, y, width, height } = await tab.locator('.lap-picture canvas').boundingBox();
      const cursor = () => tab.evaluate(() => document.querySelector('.lap-picture canvas').style.cursor);
      // The cursor changes over the robot.
      let at = x;
      while ((await cursor()) !== 'grab' && at < x + width) {
        at += 20;
        await tab.mouse.move(at, y + height / 2);
      }
      assert.ok(at < x + 0.25 * width, `${at - x} of ${width} px`);
      await tab.mouse.down();
      await tab.mouse.move(x + 0.5 * width, y + height / 2, { steps: 20 });
      const out = await tick(tab);
      assert.ok(out > 20 && out < 50, `tick ${out}`);
      await tab.mouse.move(x + 0.99 * width, y + height / 2, { steps: 20 });
      const turned = await tick(tab);
      await tab.mouse.move(x + 0.6 * width, y + height / 2, { steps: 30 });
      const back = await tick(tab);
      assert.ok(turned > 50 && back > turned + 5, `tick ${turned}, then ${back}`);
      // The first loop is closed on the way, where the robot stands for a second.
      await tab.mouse.move(x + 0.1 * width, y + height / 2, { steps: 30 });
      const home = await tick(tab);
      assert.ok(home > 110, `tick ${home}`);
      await tab.mouse.up();
      await tab.mouse.move(x, y);
      assert.equal(await tick(tab), home);
      assert.equal(await button(tab).textContent(), 'Play');
    }, { reducedMotion: 'reduce' });
  });

  it('keeps both robots in view at every moment, and ends with the uncorrected walls', async () => {
    const { Replay } = await load('story.ts');
    const { camera, ASPECT } = await load('drawing.ts');
    const story = storyOf(readFileSync(join(h.DIST, readdirSync(h.DIST).find((name) => name.startsWith('lap-'))), 'utf8'));
    const replay = new Replay(story);
    for (let seconds = 0; seconds <= replay.lengthS; seconds += 0.1) {
      const { robot, wheels, closeness } = replay.at(seconds);
      for (const [x, y] of [robot, wheels.at(-1)].map(([x, y]) => camera(closeness, 900)([x, y]))) {
        assert.ok(x > 10 && x < 890 && y > 10 && y < 900 / ASPECT - 10, `${seconds} s: ${x}, ${y}`);
      }
    }
    assert.equal(replay.at(replay.doubledS).before.strength, 0);
    assert.equal(replay.at(replay.lengthS).before.strength, 1);
  });

  it('closes the doubled wall in slow motion under one number, and no labels lie on each other, also on a phone', async () => {
    const { Replay } = await load('story.ts');
    const { draw, drawGrip } = await load('drawing.ts');
    const story = storyOf(readFileSync(join(h.DIST, readdirSync(h.DIST).find((name) => name.startsWith('lap-'))), 'utf8'));
    const replay = new Replay(story);
    const wordsAt = (seconds, width, invitation = '') => {
      const words = [];
      const record = (text, at, _ink, size) => words.push({ text, at, size });
      const surface = new Proxy({}, { get: (_, name) => (name === 'words' ? record : () => {}) });
      draw(story, replay.at(seconds), surface, width);
      drawGrip(replay.at(seconds), surface, width, invitation);
      // A metre's words stand in a corner.
      return words.filter(({ text }) => text !== '1 m');
    };
    for (const width of [348, 900]) {
      for (let seconds = 0; seconds <= replay.lengthS; seconds += 0.1) {
        const words = wordsAt(seconds, width, 'drag me');
        for (const [k, one] of words.entries()) {
          for (const other of words.slice(k + 1)) {
            // A letter is about half as wide as high.
            const apart = [0.25 * (one.size * one.text.length + other.size * other.text.length), 0.5 * (one.size + other.size)];
            assert.ok([0, 1].some((i) => Math.abs(one.at[i] - other.at[i]) >= apart[i]), `${width} px, ${seconds.toFixed(1)} s: ${one.text}, ${other.text}`);
          }
        }
      }
    }
    const { before, keyframes } = replay.at(replay.lengthS);
    const moved = before.poses.map(([x, y], node) => Math.hypot(x - keyframes[node][0], y - keyframes[node][1]));
    assert.deepEqual(wordsAt(replay.lengthS, 900).map(({ text }) => text), ['from wheels', 'from sweeps', `the past moved ${Math.round(100 * Math.max(...moved))} cm`]);
    const numbers = [];
    for (let seconds = replay.doubledS + 0.02; seconds < replay.doubledS + 2.6; seconds += 0.05) {
      numbers.push(Number(wordsAt(seconds, 900).at(-1).text.match(/\d+/)[0]));
    }
    assert.ok(numbers[0] === 0 && numbers.at(-1) > 10, `${numbers}`);
    assert.ok(new Set(numbers).size > 8, `it counts in slow motion: ${numbers}`);
  });

  it('is a still picture without scripts', async () => {
    await reading(async (tab) => {
      const picture = tab.locator('#lap img');
      assert.ok(await picture.evaluate((image) => image.decode().then(() => image.naturalWidth > 300)));
      assert.ok((await picture.getAttribute('alt')).length > 100);
      assert.equal(await tab.locator('.lap-controls').count(), 0);
    }, { javaScriptEnabled: false });
  });
});
