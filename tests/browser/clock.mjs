// The clock of the pages under test: it counts their animation frames.
//
// A second of a page is a number of frames instead of real time. A slow machine slows the page's clock down
// as well, so no result of a test depends on the drawing speed.

/** A frame of a display at 60 Hz, for tests that depend on the duration of a press or a fade. */
export const SMOOTH_MS = 1000 / 60;

/** A frame of a slow display: a widget that settles for 0.9 s draws three frames instead of sixty. */
export const COARSE_MS = 300;

/**
 * Smallest real time between frames. Otherwise a page that plays would draw as fast as it can while its test
 * inspects something.
 */
export const PAUSE_MS = 60;

/** Frame duration of a page whose clock stands still. */
export const FROZEN_MS = 0;

/** Delays of at least this length never end by themselves: the page may wait for another process. */
export const PATIENCE_MS = 5000;

/** Advance of the clock at each reading, so that work with a time limit comes to its end. */
const LOOK_MS = 0.25;

/**
 * Number of clock readings in a slow frame: little work is done in it, so tests that do not wait for work
 * stay fast.
 */
const LOOKS_OF_A_SLOW_FRAME = 300;

/** Advance at each reading while a test waits for all work: it is finished in a frame or two. */
export const QUICK_LOOK_MS = 0.01;

/** Advance at each reading for frames of that length. */
export function lookMs(stepMs) {
  return stepMs >= COARSE_MS ? stepMs / LOOKS_OF_A_SLOW_FRAME : LOOK_MS;
}

/**
 * Runs in every page before its own scripts. `frameClock` is the tests' interface.
 *
 * It replaces the sources of time of the widgets: `performance.now`, the time of an animation frame, and
 * `setTimeout` with a delay. A delay of `patienceMs` or more ends only if a test skips it. Frames are at
 * least `pauseMs` apart.
 */
export function install({ pauseMs, stepMs, lookMs, quickLookMs, patienceMs }) {
  // A tab that waits for its next test does nothing.
  if (location.href === 'about:blank') return;
  const displayed = window.requestAnimationFrame.bind(window);
  const [soon, forget] = [window.setTimeout.bind(window), window.clearTimeout.bind(window)];
  const timers = new Map();
  const watchers = new Set();
  let nowMs = 0;
  let takesMs = lookMs;
  let isHeld = false;
  let skippedMs = 0;
  let asked = 0;
  let askedAt = { ms: 0, tick: 0 };
  let ticks = 0;
  let waiting = new Map();
  let due = new Map();
  let lastFrame = 0;
  // Far from the numbers of the browser.
  let lastTimer = 1e9;

  const show = () => {
    [due, waiting] = [waiting, new Map()];
    for (const callback of due.values()) {
      try {
        callback();
      } catch (error) {
        reportError(error);
      }
    }
  };
  const nextFrame = (callback) => {
    if (waiting.size === 0) soon(() => displayed(show), pauseMs);
    lastFrame += 1;
    waiting.set(lastFrame, callback);
    return lastFrame;
  };

  performance.now = () => (nowMs += isHeld ? 0 : takesMs);
  window.requestAnimationFrame = (callback) => {
    asked += 1;
    askedAt = { ms: nowMs, tick: ticks };
    return nextFrame(() => callback(nowMs));
  };
  window.cancelAnimationFrame = (frame) => {
    // Also a due one: an earlier callback may have cancelled it.
    if (!waiting.delete(frame)) due.delete(frame);
  };
  window.setTimeout = (callback, delay, ...given) => {
    if (typeof callback !== 'function' || !(delay > 0)) return soon(callback, delay, ...given);
    lastTimer += 1;
    const isPatient = delay >= patienceMs;
    const atMs = (isPatient ? skippedMs : nowMs) + delay;
    timers.set(lastTimer, { atMs, isPatient, call: () => callback(...given) });
    return lastTimer;
  };
  window.clearTimeout = (timer) => {
    if (!timers.delete(timer)) forget(timer);
  };

  const tick = () => {
    nextFrame(tick);
    ticks += 1;
    nowMs += isHeld ? 0 : stepMs;
    const due = [...timers].filter(([, { atMs, isPatient }]) => atMs <= (isPatient ? skippedMs : nowMs));
    for (const [timer, { call }] of due.sort(([, a], [, b]) => a.atMs - b.atMs)) {
      // An earlier callback may have cancelled a due one.
      if (timers.delete(timer)) call();
    }
    for (const look of [...watchers]) if (look()) watchers.delete(look);
  };
  nextFrame(tick);

  const when = (holds) => new Promise((resolve) => {
    watchers.add(() => holds() && (resolve(), true));
  });
  window.frameClock = {
    /** Resolves after that much time, with the number of frames that the page requested meanwhile. */
    pass: async (ms) => {
      const [from, before] = [nowMs, asked];
      await when(() => nowMs - from >= ms);
      return asked - before;
    },
    /**
     * Resolves after that much time and at least three frames without a requested one, with the number of
     * earlier ones.
     */
    quiet: async (ms) => {
      const before = asked;
      const from = { ms: nowMs, tick: ticks };
      const since = (name, now) => now - Math.max(from[name], askedAt[name]);
      takesMs = Math.min(lookMs, quickLookMs);
      await when(() => since('ms', nowMs) >= ms && since('tick', ticks) >= 3);
      takesMs = lookMs;
      return asked - before;
    },
    /** Stops or resumes the clock, so that a quick touch is quick regardless of the test's speed. */
    hold: (holds) => {
      isHeld = holds;
    },
    /** Advances the clock by that much at once, including long delays. */
    skip: async (ms) => {
      const tick = ticks;
      nowMs += ms;
      skippedMs += ms;
      await when(() => ticks > tick);
    },
  };
}
