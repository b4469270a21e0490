// Starts Chromium for all tests and measurements.

import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';

/** Timeout for a page that hangs; no result depends on it. */
export const LAST_RESORT_MS = 5 * 60_000;

/** Features that Playwright disables, from its chromiumSwitches.ts. */
const PLAYWRIGHT_DISABLES = ['AvoidUnnecessaryBeforeUnloadCheckSync', 'DestroyProfileOnBrowserClose', 'HttpsUpgrades',
  'HttpsFirstBalancedModeAutoEnable', 'LensOverlay', 'MediaRouter', 'PaintHolding', 'ThirdPartyStoragePartitioning',
  'AvoidCorsURLLoaderRestartOnRedirect', 'TcpPortRandomizationWin', 'OptimizationHints', 'NetworkTimeServiceQuerying',
  'AimEnabled', 'PreconnectToSearch'];
/** Internal pages of the browser that it loads for each tab, which takes a second. */
const NOT_FOR_TESTS = ['WebUIOmniboxPopup', 'WebUIOmniboxAimPopup', 'WebUIOmniboxFullPopup', 'PreloadTopChromeWebUI'];

/** V8 flags. Chromium uses only the last `--js-flags`. */
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
    // Software GL may deliver the frames of an animated scroll late.
    '--disable-smooth-scrolling',
    // Software drawing is the largest cost, and no test is about the browser's compositing.
    '--disable-gpu-compositing',
    // Chromium uses only the last list, so it includes Playwright's.
    `--disable-features=${[...PLAYWRIGHT_DISABLES, ...NOT_FOR_TESTS]}`,
    `--js-flags=${V8_FLAGS}`,
  ],
};

/** The browser of readers. */
const WITH_WINDOWS = '/usr/bin/chromium';
/** The same engine without windows takes a sixth less time. */
const WITHOUT_WINDOWS = '/usr/bin/chromium-headless-shell';

/** `CHROMIUM`, or the first path that exists. */
function oneOf(...paths) {
  return process.env.CHROMIUM ?? paths.find((path) => existsSync(path)) ?? WITH_WINDOWS;
}

const forTests = () => oneOf(WITHOUT_WINDOWS, WITH_WINDOWS);
/** Path of the browser for measurements. */
export const forTimes = () => oneOf(WITH_WINDOWS);

/** Connects to the Chromium of run.mjs; starts a separate one without run.mjs, or with extra flags. */
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
 * Starts a Chromium that all test files connect to, with settings for short-lived pages: pages of one site share a process,
 * and V8 optimizes WebAssembly much later. Each saves a fifteenth of the work. Measurements do not use them.
 */
export function launchServer() {
  const compiledLater = `--js-flags=${V8_FLAGS} --wasm-tiering-budget=100000000`;
  return chromium.launchServer({ ...HOW, executablePath: forTests(), args: [...HOW.args, '--process-per-site', compiledLater] });
}
