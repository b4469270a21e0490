// A widget draws only while something moves or settles.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { SMOOTH_MS } from './clock.mjs';
import * as h from './harness.mjs';

const TALL = '<p style="height: 3000px">Much text.</p>';
/** A widget that computes everything at once; w16.1 fills its map for a while. */
const CALM = '<slam-widget name="w16.2"></slam-widget>';
/** Stock eframe requests frames forever. */
const SETTLE_MS = 900;
const SETTLE_FRAMES = 3;

const visit = h.visitor();
const on = (body, test, stepMs) => visit(body, test, { options: { stepMs } });

/** Frames that the widget has drawn so far. */
const drawn = (tab) => tab.evaluate(() => document.querySelector('slam-widget').frames);

for (const { id } of h.schema) {
  describe(id, () => {
    const page = visit.once(`<slam-widget name="${id}"></slam-widget>`);

    it('neither draws nor requests frames while idle', async () => {
      const { tab } = page;
      await h.ready(tab);
      await h.quiet(tab);
      const before = await drawn(tab);
      assert.equal(await h.countFrames(tab, 5000), 0);
      assert.equal(await drawn(tab), before);
    });

    // Before a log is open, w16.10 has nothing to play.
    if (id === 'w16.10') return;
    it('shows the end of a run at once under reduced motion', async () => {
      const { tab } = page;
      const play = (from) => tab.evaluate(async (start) => {
        const widget = document.querySelector('slam-widget');
        const { param } = widget.timeline;
        widget.set(param, start);
        await widget.press('play');
        const { playing, last } = widget.timeline;
        return { playing, shown: Math.min(widget.get(param), last), last };
      }, from);
      // The setting may change while the page is open.
      assert.ok((await play(0)).playing);
      await tab.emulateMedia({ reducedMotion: 'reduce' });
      await tab.waitForFunction(() => !document.querySelector('slam-widget').timeline.playing);
      const { playing, shown, last } = await play(0);
      assert.equal(playing, false);
      assert.equal(shown, last);
      await h.quiet(tab);
      assert.equal(await h.countFrames(tab, 1000), 0);
    });
  });
}

describe('a widget', () => {
  it('draws during a playback, and stops when it is scrolled out of view', async () => {
    await on(CALM + TALL, async (tab) => {
      await h.ready(tab);
      await h.quiet(tab);
      await tab.evaluate(() => document.querySelector('slam-widget').press('play'));
      const before = await drawn(tab);
      await tab.waitForFunction((old) => document.querySelector('slam-widget').frames > old + 5, before);
      // Out of view, but near enough to keep running.
      await tab.evaluate(() => {
        const { height } = document.querySelector('slam-widget').getBoundingClientRect();
        window.scrollTo(0, height + 100);
      });
      await h.quiet(tab);
      const there = await drawn(tab);
      assert.ok(await tab.evaluate(() => document.querySelector('slam-widget').timeline.playing));
      assert.equal(await h.countFrames(tab, 1000), 0);
      assert.equal(await drawn(tab), there);
    });
  });

  // egui's fades and delays: with less time a fade would stop halfway.
  it('settles for 0.9 s after an event: 54 frames of a smooth display', async () => {
    await on(CALM, async (tab) => {
      const frames = await settlingFrames(tab);
      const due = SETTLE_MS / SMOOTH_MS;
      assert.ok(frames > due - 5 && frames < due + 5, `${frames} frames, of ${due}`);
    }, SMOOTH_MS);
  });

  it('sets no timers in a hidden page while idle, as eframe does there', async () => {
    await on(CALM, async (tab) => {
      await h.ready(tab);
      await h.quiet(tab);
      await tab.evaluate(() => {
        Object.defineProperty(document, 'hidden', { value: true });
        document.dispatchEvent(new Event('visibilitychange'));
      });
      await h.quiet(tab);
      await tab.evaluate(() => {
        const { setTimeout } = window;
        window.timers = 0;
        window.setTimeout = (...call) => {
          window.timers += 1;
          return setTimeout(...call);
        };
      });
      await h.countFrames(tab, 5000);
      assert.equal(await tab.evaluate(() => window.timers), 0);
    });
  });

  it('settles for three frames after an event, however slow they are', async () => {
    await on(CALM, async (tab) => {
      const frames = await settlingFrames(tab);
      assert.ok(frames >= SETTLE_FRAMES && frames <= SETTLE_FRAMES + 2, `${frames} frames`);
    }, 2000);
  });
});

/** The frames that are requested after one event. */
async function settlingFrames(tab) {
  await h.ready(tab);
  await h.quiet(tab);
  return tab.evaluate(() => {
    const counted = frameClock.quiet(1000);
    document.querySelector('slam-widget').shadowRoot.querySelector('.stage').dispatchEvent(new Event('pointerleave'));
    return counted;
  });
}
