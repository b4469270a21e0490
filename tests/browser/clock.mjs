// The clock of the pages under test: it counts their animation frames.
//
// A second of a page is a number of frames, not of heartbeats. So a machine that is held up holds the
// page's clock up as well, and nothing that a test sees depends on how fast it draws.

/** Of one display at 60 Hz: for what depends on how long a press or a fade takes. */
export const SMOOTH_MS = 1000 / 60;

/** Of a display that is slow: a widget that settles for 0.9 s draws three frames, not sixty. */
export const COARSE_MS = 300;

/**
 * A display shows the next frame no sooner, by the clock of the machine: a page that draws all the time, such
 * as one that plays, would draw as often as it can while its test looks at something, and nobody sees it.
 */
export const PAUSE_MS = 60;

/** Of a page that waits for as long as the test does. */
export const FROZEN_MS = 0;

/** Patience of so much is never over by itself: what a page waits for may come from another process. */
export const PATIENCE_MS = 5000;

/** What each look at the clock takes: work that goes on until its time is up comes to an end. */
const LOOK_MS = 0.25;

/** A slow display gets little work done in a frame: what no test waits for costs none of them much. */
const LOOKS_OF_A_SLOW_FRAME = 300;

/** While a test waits for all work to be done, looks take next to nothing: it is done in a frame or two. */
export const QUICK_LOOK_MS = 0.01;

/** What a look takes on a display with such frames. */
export function lookMs(stepMs) {
  return stepMs >= COARSE_MS ? stepMs / LOOKS_OF_A_SLOW_FRAME : LOOK_MS;
}

/**
 * Runs in every page before its own scripts. `frameClock` is what tests see of it.
 *
 * It drives what the widgets ask for time: `performance.now`, the time of an animation frame, and
 * `setTimeout` with a delay. A delay of `patienceMs` or more passes only when a test skips it. Between two
 * frames lie `pauseMs` at least.
 */
export function install({ pauseMs, stepMs, lookMs, quickLookMs, patienceMs }) {
  // A tab that waits for its next test has nothing to do.
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
  // Far from the numbers that the browser gives.
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
    // Also one that is due: another one before it may have called it off.
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
      // One that was due may have called another one off.
      if (timers.delete(timer)) call();
    }
    for (const look of [...watchers]) if (look()) watchers.delete(look);
  };
  nextFrame(tick);

  const when = (holds) => new Promise((resolve) => {
    watchers.add(() => holds() && (resolve(), true));
  });
  window.frameClock = {
    /** Once so much time has passed; says how many frames the page asked for meanwhile. */
    pass: async (ms) => {
      const [from, before] = [nowMs, asked];
      await when(() => nowMs - from >= ms);
      return asked - before;
    },
    /** Once no frame has been asked for during so much time, and three frames at least; says how many were. */
    quiet: async (ms) => {
      const before = asked;
      const from = { ms: nowMs, tick: ticks };
      const since = (name, now) => now - Math.max(from[name], askedAt[name]);
      takesMs = Math.min(lookMs, quickLookMs);
      await when(() => since('ms', nowMs) >= ms && since('tick', ticks) >= 3);
      takesMs = lookMs;
      return asked - before;
    },
    /** Stands still, or goes on: a finger that is quick is quick however long the test takes to move it. */
    hold: (holds) => {
      isHeld = holds;
    },
    /** Lets so much time pass at once, for those as well who are patient. */
    skip: async (ms) => {
      const tick = ticks;
      nowMs += ms;
      skippedMs += ms;
      await when(() => ticks > tick);
    },
  };
}
