// Chromium as every test and every measurement starts it.

import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';

/** Ends a wait that will never end, in a page that hangs; nothing is judged by it. */
export const LAST_RESORT_MS = 5 * 60_000;

/** What the Chromium of Playwright does without, from its chromiumSwitches.ts. */
const PLAYWRIGHT_DISABLES = ['AvoidUnnecessaryBeforeUnloadCheckSync', 'DestroyProfileOnBrowserClose', 'HttpsUpgrades',
  'HttpsFirstBalancedModeAutoEnable', 'LensOverlay', 'MediaRouter', 'PaintHolding', 'ThirdPartyStoragePartitioning',
  'AvoidCorsURLLoaderRestartOnRedirect', 'TcpPortRandomizationWin', 'OptimizationHints', 'NetworkTimeServiceQuerying',
  'AimEnabled', 'PreconnectToSearch'];
/** Pages of the browser's own, loaded beside each tab: a second of work for what nobody sees. */
const NOT_FOR_TESTS = ['WebUIOmniboxPopup', 'WebUIOmniboxAimPopup', 'WebUIOmniboxFullPopup', 'PreloadTopChromeWebUI'];

/** What V8 is told in every Chromium; only the last list of its flags counts. */
const V8_FLAGS = '--expose-gc';

const HOW = {
  timeout: LAST_RESORT_MS,
  args: [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
    // A scroll that is animated needs frames, and software GL may owe them for long.
    '--disable-smooth-scrolling',
    // Drawing by software costs the most here, and no test is about how the browser puts a page together.
    '--disable-gpu-compositing',
    // The last list counts, so it starts with Playwright's own.
    `--disable-features=${[...PLAYWRIGHT_DISABLES, ...NOT_FOR_TESTS]}`,
    `--js-flags=${V8_FLAGS}`,
  ],
};

/** The browser that readers have. */
const WITH_WINDOWS = '/usr/bin/chromium';
/** The same engine without the windows around it: a page takes a sixth less there. */
const WITHOUT_WINDOWS = '/usr/bin/chromium-headless-shell';

/** The first of these that is there, unless the environment names one. */
function oneOf(...paths) {
  return process.env.CHROMIUM ?? paths.find((path) => existsSync(path)) ?? WITH_WINDOWS;
}

const forTests = () => oneOf(WITHOUT_WINDOWS, WITH_WINDOWS);
/** What is measured with: its path. */
export const forTimes = () => oneOf(WITH_WINDOWS);

/** The Chromium that run.mjs started for all files, else one of this file's own; so with flags. */
export function launch(extra = []) {
  const shared = process.env.SLAM_CHROMIUM;
  if (shared !== undefined && extra.length === 0) return chromium.connect(shared, { timeout: LAST_RESORT_MS });
  return chromium.launch({ ...HOW, executablePath: forTests(), args: [...HOW.args, ...extra] });
}

/** A Chromium to measure in. */
export function launchForTimes() {
  return chromium.launch({ ...HOW, executablePath: forTimes() });
}

/**
 * A Chromium that the files of the tests connect to, with what pays where pages are visited for seconds. Pages of one
 * site share a process there, and WebAssembly is compiled to its end much later: each saves a fifteenth of their work. A
 * measurement of first frames or of drags starts each page as a reader's browser does.
 */
export function launchServer() {
  const compiledLater = `--js-flags=${V8_FLAGS} --wasm-tiering-budget=100000000`;
  return chromium.launchServer({ ...HOW, executablePath: forTests(), args: [...HOW.args, '--process-per-site', compiledLater] });
}
