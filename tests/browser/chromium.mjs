// Starts Chromium for all tests and measurements.

import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';

/** Ends a wait in a page that hangs; no result depends on it. */
export const LAST_RESORT_MS = 5 * 60_000;

/** Features that Playwright turns off, from its chromiumSwitches.ts. */
const PLAYWRIGHT_DISABLES = ['AvoidUnnecessaryBeforeUnloadCheckSync', 'DestroyProfileOnBrowserClose', 'HttpsUpgrades',
  'HttpsFirstBalancedModeAutoEnable', 'LensOverlay', 'MediaRouter', 'PaintHolding', 'ThirdPartyStoragePartitioning',
  'AvoidCorsURLLoaderRestartOnRedirect', 'TcpPortRandomizationWin', 'OptimizationHints', 'NetworkTimeServiceQuerying',
  'AimEnabled', 'PreconnectToSearch'];
/** Internal pages of the browser, loaded beside each tab: a second of needless work. */
const NOT_FOR_TESTS = ['WebUIOmniboxPopup', 'WebUIOmniboxAimPopup', 'WebUIOmniboxFullPopup', 'PreloadTopChromeWebUI'];

/** V8's flags in every Chromium; only the last list of flags counts. */
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
    // An animated scroll needs frames, which software GL may deliver late.
    '--disable-smooth-scrolling',
    // Software drawing is the largest cost, and no test is about the browser's compositing.
    '--disable-gpu-compositing',
    // The last list counts, so it starts with Playwright's own.
    `--disable-features=${[...PLAYWRIGHT_DISABLES, ...NOT_FOR_TESTS]}`,
    `--js-flags=${V8_FLAGS}`,
  ],
};

/** The browser of readers. */
const WITH_WINDOWS = '/usr/bin/chromium';
/** The same engine without windows: a page takes a sixth less time there. */
const WITHOUT_WINDOWS = '/usr/bin/chromium-headless-shell';

/** The first of these that exists, unless the environment names one. */
function oneOf(...paths) {
  return process.env.CHROMIUM ?? paths.find((path) => existsSync(path)) ?? WITH_WINDOWS;
}

const forTests = () => oneOf(WITHOUT_WINDOWS, WITH_WINDOWS);
/** Path of the browser for measurements. */
export const forTimes = () => oneOf(WITH_WINDOWS);

/** The Chromium that run.mjs started for all files, else a separate one, also if there are flags. */
export function launch(extra = []) {
  const shared = process.env.SLAM_CHROMIUM;
  if (shared !== undefined && extra.length === 0) return chromium.connect(shared, { timeout: LAST_RESORT_MS });
  return chromium.launch({ ...HOW, executablePath: forTests(), args: [...HOW.args, ...extra] });
}

/** Starts a Chromium for measurements. */
export function launchForTimes() {
  return chromium.launch({ ...HOW, executablePath: forTimes() });
}

/**
 * A Chromium for the test files to connect to, with settings that pay off for pages that live for seconds:
 * pages of one site share a process, and WebAssembly is optimized much later. Each saves a fifteenth of the
 * work. Measurements of first frames or of drags start each page like a reader's browser.
 */
export function launchServer() {
  const compiledLater = `--js-flags=${V8_FLAGS} --wasm-tiering-budget=100000000`;
  return chromium.launchServer({ ...HOW, executablePath: forTests(), args: [...HOW.args, '--process-per-site', compiledLater] });
}
