// A server, a browser, and tabs that record their errors.

import assert from 'node:assert/strict';
import { createReadStream, existsSync, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { after, before } from 'node:test';
import { fileURLToPath } from 'node:url';
import { LAST_RESORT_MS, launch } from './chromium.mjs';
import * as clock from './clock.mjs';
import { PAGES as pages } from '../../web/page/pages.mjs';

export { launch };

export const DIST = fileURLToPath(new URL('../../dist/', import.meta.url));

/** The pages of the companion, in reading order. */
export const PAGES = Object.freeze(pages.map(({ file }) => file));

/** The widgets of a page, in order. */
export function widgetsOf(page) {
  return [...readFileSync(join(DIST, page), 'utf8').matchAll(/<slam-widget name="([^"]+)"/g)].map(([, id]) => id);
}

/** The path of the page with that widget. */
export function pageOf(id) {
  return `/${PAGES.find((page) => widgetsOf(page).includes(id))}`;
}

/** The address of a page with its widgets on show: own-robot.html hides its widget until it is used. */
export function addressOf(page) {
  return `/${page}${page === 'own-robot.html' ? '?w=16.10' : ''}`;
}

/** The strictest content security policy under which the element has to work. */
export const STRICT_POLICY =
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; " +
  "img-src 'self' data:; style-src 'self' 'unsafe-inline'";

/** The type of a file by the end of its name. */
export const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.mjs': 'text/javascript; charset=utf-8',
  '.json': 'application/json',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml',
  '.woff2': 'font/woff2',
};

/**
 * Serves `dist/` and the pages given as text. `policy` is the Content-Security-Policy; `answer` gets the
 * path and the request, and returns true if it has answered itself.
 */
export async function serve({ pages = {}, policy, answer } = {}) {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    if (policy !== undefined) response.setHeader('Content-Security-Policy', policy);
    response.setHeader('Access-Control-Allow-Origin', '*');
    if (answer?.(pathname, response, request) === true) return;
    if (pages[pathname] !== undefined) {
      response.setHeader('Content-Type', TYPES['.html']);
      response.end(pages[pathname]);
      return;
    }
    const file = join(DIST, normalize(pathname), pathname.endsWith('/') ? 'index.html' : '');
    if (!existsSync(file) || !statSync(file).isFile()) {
      response.statusCode = 404;
      response.end('no such file');
      return;
    }
    response.setHeader('Content-Type', TYPES[extname(file)] ?? 'application/octet-stream');
    response.setHeader('Content-Length', statSync(file).size);
    createReadStream(file).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    url: `http://localhost:${server.address().port}`,
    close: () => {
      const closed = new Promise((resolve) => server.close(resolve));
      // Otherwise a response that the test never sent would block.
      server.closeAllConnections();
      return closed;
    },
  };
}

/** A screen with few pixels, because drawing is by software. */
const SCREEN = { viewport: { width: 1100, height: 900 }, deviceScaleFactor: 0.5 };

/**
 * Init script: turns antialiasing off, because software drawing would compute each pixel four times. If no test inspects
 * the pixels of a page, WebGL fills no triangles: that takes two thirds of a frame.
 */
function drawCheaply({ sees }) {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (type, given) {
    return getContext.call(this, type, type === 'webgl2' ? { antialias: false, ...given } : given);
  };
  if (!sees) WebGL2RenderingContext.prototype.drawElements = () => {};
}

/**
 * A tab that records errors, and requests to hosts other than `home`. A frame takes `stepMs` on the clock of its pages; a
 * test that inspects pixels sets `sees`; the other options are Playwright's.
 */
async function newTab(browser, { stepMs = clock.COARSE_MS, sees = false, ...options } = {}) {
  const context = await browser.newContext({ ...SCREEN, ...options });
  context.setDefaultTimeout(LAST_RESORT_MS);
  context.setDefaultNavigationTimeout(LAST_RESORT_MS);
  await context.addInitScript(clock.install, {
    pauseMs: clock.PAUSE_MS, stepMs, readingMs: clock.readingMs(stepMs), quickReadingMs: clock.QUICK_READING_MS, longDelayMs: clock.LONG_DELAY_MS,
  });
  await context.addInitScript(drawCheaply, { sees });
  const tab = await context.newPage();
  tab.troubles = [];
  tab.on('console', (message) => {
    if (message.type() === 'error') tab.troubles.push(`console: ${message.text()}`);
  });
  tab.on('pageerror', (error) => tab.troubles.push(`page: ${error.message}`));
  tab.on('request', (request) => {
    const { origin, protocol } = new URL(request.url());
    if (protocol.startsWith('http') && origin !== tab.home) {
      tab.troubles.push(`request: ${request.url()}`);
    }
  });
  return tab;
}

/** Resets a tab for its next test; storage needs no reset, because each visit has a new origin. */
async function tidy(tab) {
  await tab.mouse.move(0, 0);
  await tab.goto('about:blank');
}

/** Sets the options that an existing tab can change. */
async function prepare(tab, { viewport = SCREEN.viewport, colorScheme = null, reducedMotion = null }) {
  await tab.emulateMedia({ media: null, colorScheme, reducedMotion });
  await tab.setViewportSize(viewport);
}

/** A page with only `body` and the element. */
export function bare(body, head = '') {
  return `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Test</title>
<link rel="icon" href="data:,">${head}
<script type="module" src="/slam-widget.js"></script></head><body>${body}</body></html>`;
}

/**
 * Returns a function, one for each test file, that opens a page for a test: a bare page with `body` at /t.html, or any
 * other `path` of the server. The browser starts with the first page and is closed after the last test.
 *
 * Tests share a tab if it can change to their options, because a new one costs more than most tests. A test may request a
 * `fresh` tab, or a browser `with` other flags.
 */
export function visitor() {
  const tabs = new Map();
  let shared;
  after(async () => (await shared)?.close());

  const tabFor = async ({ options = {}, fresh = false, with: other }) => {
    const browser = other ?? (await (shared ??= launch()));
    const { viewport, colorScheme, reducedMotion, ...forGood } = options;
    const isShared = !fresh && other === undefined;
    const key = JSON.stringify(forGood);
    const kept = isShared ? tabs.get(key) : undefined;
    const tab = kept ?? (await newTab(browser, forGood));
    if (isShared) tabs.set(key, tab);
    await prepare(tab, { viewport, colorScheme, reducedMotion });
    return { tab, isShared };
  };

  const arrive = async (body, how) => {
    const { head, path = '/t.html', server: its } = how;
    const { tab, isShared } = await tabFor(how);
    const server = await serve({ ...its, pages: { '/t.html': bare(body, head), ...its?.pages } });
    const leave = async () => {
      if (isShared) await tidy(tab);
      else await tab.context().close();
      await server.close();
    };
    tab.troubles = [];
    tab.home = server.url;
    await tab.goto(`${server.url}${path}`);
    return { tab, server, leave };
  };

  const visit = async (body, test, how = {}) => {
    const { tab, server, leave } = await arrive(body, how);
    try {
      await test(tab, server);
      if (how.quiet ?? true) assert.deepEqual(tab.troubles, []);
    } finally {
      await leave();
    }
  };

  /** One page for all tests of a group, because starting a widget costs more than most of them. */
  visit.once = (body, how = {}) => {
    const stay = {};
    before(async () => Object.assign(stay, await arrive(body, how)));
    after(async () => {
      const { troubles } = stay.tab;
      await stay.leave();
      assert.deepEqual(troubles, []);
    });
    return stay;
  };
  return visit;
}

/** Opens the exercise that an element is in, if it is in one. */
export function unfold(page, selector) {
  return page.locator(selector).evaluate((element) => element.closest('details')?.setAttribute('open', ''));
}

/** Removes the figures that drive a thousand laps once they are in view: a test that waits for quiet waits for them, too. */
export function withoutLaps(page) {
  return page.evaluate(() => {
    for (const figure of document.querySelectorAll('figure.laps')) figure.remove();
  });
}

/** Waits until a widget has drawn its first frame. */
export function ready(page, selector = 'slam-widget') {
  return page.waitForFunction((css) => document.querySelector(css)?.state === 'running'
    && document.querySelector(css).shadowRoot.querySelector('.stage.live') !== null, selector);
}

/** Waits until a widget has drawn `count` more frames. */
export function moreFrames(page, count, selector = 'slam-widget') {
  return page.evaluate(([css, more]) => {
    const widget = document.querySelector(css);
    const goal = widget.frames + more;
    return frameClock.until(() => {
      void widget.snapshot().then((picture) => picture.close());
      return widget.frames >= goal;
    });
  }, [selector, count]);
}

/** Converts a point of a panel to page coordinates. */
export function pointOf(page, panel, x, y, selector = 'slam-widget') {
  return page.evaluate(
    ([css, panelId, px, py]) => {
      const widget = document.querySelector(css);
      const at = widget.panelToScreen(panelId, px, py);
      const box = widget.shadowRoot.querySelector('canvas').getBoundingClientRect();
      return at === null ? null : [box.left + at[0], box.top + at[1]];
    },
    [selector, panel, x, y],
  );
}

/** The widgets' schema from the build. */
export const schema = JSON.parse(readFileSync(join(DIST, 'schema.json'), 'utf8'));

/** Counts the animation frames that a page requests during a time on its clock. */
export function countFrames(page, milliseconds) {
  return page.evaluate((ms) => frameClock.pass(ms), milliseconds);
}

/** Waits until the page has requested no frame for a second of its clock; returns the number of earlier requests. */
export function quiet(page) {
  return page.evaluate(() => frameClock.quiet(1000));
}

/** The bytes of a download. */
export async function bytesOf(download) {
  const chunks = [];
  for await (const chunk of await download.createReadStream()) chunks.push(chunk);
  return Buffer.concat(chunks);
}

/** The most frequent colour of a widget, the share of pixels of other colours, and the number of colours. */
export async function painted(page, selector = 'slam-widget') {
  return page.evaluate(async (css) => {
    const widget = document.querySelector(css);
    const picture = await widget.snapshot();
    const copy = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
    copy.drawImage(picture, 0, 0, picture.width, picture.height);
    const { data } = copy.getImageData(0, 0, picture.width, picture.height);
    const pixels = new Uint32Array(data.buffer);
    const counts = new Map();
    for (const color of pixels) counts.set(color, (counts.get(color) ?? 0) + 1);
    const [[paper, most]] = [...counts].sort(([, a], [, b]) => b - a);
    return {
      share: 1 - most / pixels.length,
      colors: counts.size,
      paper: [paper & 255, (paper >> 8) & 255, (paper >> 16) & 255],
    };
  }, selector);
}
