// A removed widget leaves nothing behind: no context, no memory, no listener.

import assert from 'node:assert/strict';
import { it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();

/** Init script: records every WebGL context and every wasm memory. */
const REMEMBER = `<script>
  window.contexts = [];
  window.memories = [];
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (...given) {
    const context = getContext.apply(this, given);
    const isNew = context instanceof WebGL2RenderingContext && !contexts.some((held) => held.deref() === context);
    if (isNew) contexts.push(new WeakRef(context));
    if (isNew) window.kept?.push(context);
    return context;
  };
  const { instantiate } = WebAssembly;
  WebAssembly.instantiate = async (...given) => {
    const instance = await instantiate(...given);
    memories.push(new WeakRef(instance.exports.memory));
    return instance;
  };
  /** Contexts that are still alive: on the page, and elsewhere. */
  window.heldContexts = () => {
    const held = contexts.map((context) => context.deref()).filter((context) => context?.isContextLost() === false);
    const onPage = held.filter((context) => context.canvas.isConnected);
    return { onPage, elsewhere: held.filter((context) => !onPage.includes(context)) };
  };
</script>`;

/** A page with an empty container for widgets. */
const on = (test) => visit('<div id="here"></div>', test, { head: REMEMBER, fresh: true });

it('a widget is mounted and removed thirty times without leaking memory, contexts or listeners', async () => {
  await on(async (tab) => {
    const session = await tab.context().newCDPSession(tab);
    const mount = async () => {
      await tab.evaluate(() => {
        document.querySelector('#here').innerHTML = '<slam-widget name="w16.4"></slam-widget>';
      });
      await h.ready(tab);
      // The context is alive until the element is removed.
      const [before, after] = await tab.evaluate(() => {
        const { onPage, elsewhere } = heldContexts();
        document.querySelector('#here').replaceChildren();
        return [[onPage.length, elsewhere.length], [...onPage, ...elsewhere].map((context) => context.isContextLost())];
      });
      assert.deepEqual(before, [1, 0], 'contexts of the widget, and others');
      assert.deepEqual(after, [true], 'the context is given back');
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
    const limits = {
      jsEventListeners: before.jsEventListeners + 15,
      nodes: before.nodes + 300,
      usedSize: before.usedSize + 5e6,
      memories: 3,
    };
    const over = (now) => Object.keys(limits).filter((name) => now[name] >= limits[name]);
    // The garbage collector may run at any time, but never frees leaked memory.
    let now = await measure();
    for (let tries = 0; tries < 20 && over(now).length > 0; tries += 1) now = await measure();
    assert.deepEqual(over(now), [], `${JSON.stringify(before)} → ${JSON.stringify(now)}`);
  });
});

it('a widget that is removed at any moment of its start keeps no context', async () => {
  await on(async (tab) => {
    // The cleanup must not depend on the garbage collector.
    await tab.evaluate(() => (window.kept = []));
    const mountUntil = (moment) => tab.evaluate(async ([hasCanvas, frames]) => {
      const here = document.querySelector('#here');
      here.innerHTML = '<slam-widget name="w16.1"></slam-widget>';
      const stage = here.firstChild.shadowRoot.querySelector('.stage');
      if (hasCanvas) {
        await new Promise((resolve) => new MutationObserver(() => stage.querySelector('canvas') && resolve())
          .observe(stage, { childList: true }));
      }
      for (let i = 0; i < frames; i += 1) await new Promise(requestAnimationFrame);
      const state = { isLive: stage.classList.contains('live'), hasCanvas: stage.querySelector('canvas') !== null };
      here.replaceChildren();
      return state;
    }, moment);
    // The module has loaded before the tested moments.
    await tab.evaluate(() => (document.querySelector('#here').innerHTML = '<slam-widget name="w16.1"></slam-widget>'));
    await h.ready(tab);
    // Before the canvas exists, when it is created, and frame by frame until its first picture.
    assert.deepEqual(await mountUntil([false, 0]), { isLive: false, hasCanvas: false });
    assert.deepEqual(await mountUntil([true, 0]), { isLive: false, hasCanvas: true });
    for (let frames = 1; frames < 6; frames += 1) {
      await mountUntil([false, frames]);
      await mountUntil([true, frames]);
    }
    // A pending start ends a little later.
    await tab.waitForFunction(() => {
      const { onPage, elsewhere } = heldContexts();
      return onPage.length === 0 && elsewhere.length === 0;
    });
    assert.ok(await tab.evaluate(() => kept.length > 2));
  });
});
