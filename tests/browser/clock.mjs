// A fake clock for pages under test: time is a number of animation frames. No result of a test depends on the speed of the
// machine.

/** A frame at 60 Hz, for tests that depend on the duration of a press or a fade. */
export const SMOOTH_MS = 1000 / 60;

/** A slow frame: a widget that settles for 0.9 s draws three frames instead of 54. */
export const COARSE_MS = 300;

/** Minimum real time between frames: an unthrottled playback would keep the CPU busy while its test inspects something. */
export const PAUSE_MS = 60;

/** Frame duration of a stopped clock. */
export const FROZEN_MS = 0;

/** Timers of at least this delay fire only if a test skips it: the page may wait for another process. */
export const LONG_DELAY_MS = 5000;

/** Advance of the clock at each reading: work with a time limit has to end. */
const READING_MS = 0.25;

/** Clock readings in a slow frame. A low number limits the work in a frame, and keeps tests fast that need no work. */
const READINGS_PER_SLOW_FRAME = 300;

/** Advance at each reading while a test waits for all work, which then takes a frame or two. */
export const QUICK_READING_MS = 0.01;

/** Advance at each reading for a frame duration. */
export function readingMs(stepMs) {
  return stepMs >= COARSE_MS ? stepMs / READINGS_PER_SLOW_FRAME : READING_MS;
}

/**
 * Init script. Replaces `performance.now`, the time of animation frames, and `setTimeout` with a delay. Tests control the
 * clock by `frameClock`. Timers of `longDelayMs` or more fire only if a test skips the delay. Frames are at least `pauseMs`
 * apart.
 */
export function install({ pauseMs, stepMs, readingMs, quickReadingMs, longDelayMs }) {
  // A tab between two tests.
  if (location.href === 'about:blank') return;
  const realRequestFrame = window.requestAnimationFrame.bind(window);
  const [realSetTimeout, realClearTimeout] = [window.setTimeout.bind(window), window.clearTimeout.bind(window)];
  const timers = new Map();
  const watchers = new Set();
  let nowMs = 0;
  let advanceMs = readingMs;
  let isStopped = false;
  let skippedMs = 0;
  let requests = 0;
  let requestedAt = { ms: 0, tick: 0 };
  let ticks = 0;
  let waiting = new Map();
  let due = new Map();
  let lastFrame = 0;
  // Does not collide with the browser's timer ids.
  let lastTimer = 1e9;

  const runFrame = () => {
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
    // While the test waits for the clock, there is nothing to leave time for.
    if (waiting.size === 0) {
      if (watchers.size > 0) realRequestFrame(runFrame);
      else realSetTimeout(() => realRequestFrame(runFrame), pauseMs);
    }
    lastFrame += 1;
    waiting.set(lastFrame, callback);
    return lastFrame;
  };

  performance.now = () => (nowMs += isStopped ? 0 : advanceMs);
  window.requestAnimationFrame = (callback) => {
    requests += 1;
    requestedAt = { ms: nowMs, tick: ticks };
    return nextFrame(() => callback(nowMs));
  };
  window.cancelAnimationFrame = (frame) => {
    // An earlier callback of the same frame may cancel a due one.
    if (!waiting.delete(frame)) due.delete(frame);
  };
  window.setTimeout = (callback, delay, ...args) => {
    if (typeof callback !== 'function' || !(delay > 0)) return realSetTimeout(callback, delay, ...args);
    lastTimer += 1;
    const isLong = delay >= longDelayMs;
    const atMs = (isLong ? skippedMs : nowMs) + delay;
    timers.set(lastTimer, { atMs, isLong, call: () => callback(...args) });
    return lastTimer;
  };
  window.clearTimeout = (timer) => {
    if (!timers.delete(timer)) realClearTimeout(timer);
  };

  const tick = () => {
    nextFrame(tick);
    ticks += 1;
    nowMs += isStopped ? 0 : stepMs;
    const due = [...timers].filter(([, { atMs, isLong }]) => atMs <= (isLong ? skippedMs : nowMs));
    for (const [timer, { call }] of due.sort(([, a], [, b]) => a.atMs - b.atMs)) {
      // An earlier callback may have cancelled a due one.
      if (timers.delete(timer)) call();
    }
    for (const check of [...watchers]) if (check()) watchers.delete(check);
  };
  nextFrame(tick);

  const when = (condition) => new Promise((resolve) => {
    watchers.add(() => {
      const holds = condition();
      if (holds) resolve();
      return holds;
    });
  });
  window.frameClock = {
    /** Resolves at the first frame in which a condition holds. */
    until: when,
    /** Resolves after a time, with the number of frames that the page requested meanwhile. */
    pass: async (ms) => {
      const [from, before] = [nowMs, requests];
      await when(() => nowMs - from >= ms);
      return requests - before;
    },
    /** Resolves after a time and at least three frames without a request, with the number of earlier requests. */
    quiet: async (ms) => {
      const before = requests;
      const from = { ms: nowMs, tick: ticks };
      const since = (name, now) => now - Math.max(from[name], requestedAt[name]);
      advanceMs = Math.min(readingMs, quickReadingMs);
      await when(() => since('ms', nowMs) >= ms && since('tick', ticks) >= 3);
      advanceMs = readingMs;
      return requests - before;
    },
    /** Stops or resumes the clock: a quick touch has to be quick on a slow machine, too. */
    hold: (isOn) => {
      isStopped = isOn;
    },
    /** Advances the clock at once, including long delays. */
    skip: async (ms) => {
      const tick = ticks;
      nowMs += ms;
      skippedMs += ms;
      await when(() => ticks > tick);
    },
  };
}
