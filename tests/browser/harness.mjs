// A server that can misbehave on purpose, a browser, and pages that remember their errors.

import { createReadStream, existsSync, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

export const DIST = fileURLToPath(new URL('../../dist/', import.meta.url));

/** The strictest policy under which the element has to work. */
export const STRICT_POLICY =
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; " +
  "img-src 'self' data:; style-src 'self' 'unsafe-inline'";

const TYPES = {
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
 * Serves `dist/` and the pages given as text. `policy` is the Content-Security-Policy, `answer`
 * may answer a request itself and say so with true.
 */
export async function serve({ pages = {}, policy, answer } = {}) {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    if (policy !== undefined) response.setHeader('Content-Security-Policy', policy);
    response.setHeader('Access-Control-Allow-Origin', '*');
    if (answer?.(pathname, response) === true) return;
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
      // A response that was held back on purpose must not hold the test as well.
      server.closeAllConnections();
      return closed;
    },
  };
}

export function launch(extra = []) {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
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
      '--js-flags=--expose-gc',
      ...extra,
    ],
  });
}

/** A page that collects what a careful host would not want: errors, and requests elsewhere. */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1100, height: 900 }, ...options });
  const page = await context.newPage();
  page.troubles = [];
  const home = new URL(url).origin;
  page.on('console', (message) => {
    if (message.type() === 'error') page.troubles.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => page.troubles.push(`page: ${error.message}`));
  page.on('request', (request) => {
    const { origin, protocol } = new URL(request.url());
    if (protocol.startsWith('http') && origin !== home) {
      page.troubles.push(`request: ${request.url()}`);
    }
  });
  await page.goto(url);
  return page;
}

/** A page with nothing but what stands in `body` and the element. */
export function bare(body, head = '') {
  return `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Test</title>
<link rel="icon" href="data:,">${head}
<script type="module" src="/slam-widget.js"></script></head><body>${body}</body></html>`;
}

/** Waits until a widget has drawn its first frame. */
export function ready(page, selector = 'slam-widget') {
  return page.waitForFunction((css) => document.querySelector(css)?.state === 'running'
    && document.querySelector(css).shadowRoot.querySelector('.stage.live') !== null, selector);
}

/** Waits until a widget that has a reason to draw has drawn so many frames more. */
export async function moreFrames(page, count, selector = 'slam-widget') {
  const before = await page.evaluate((css) => document.querySelector(css).frames, selector);
  await page.waitForFunction(
    ([css, goal]) => {
      const widget = document.querySelector(css);
      void widget.snapshot().then((picture) => picture.close());
      return widget.frames >= goal;
    },
    [selector, before + count],
  );
}

/** The page's coordinates of a point of a panel of the widget. */
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

/** The widgets' own lists, as the build wrote them. */
export const schema = JSON.parse(readFileSync(join(DIST, 'schema.json'), 'utf8'));

/** Counts the animation frames that a page asks for from now on. */
export async function countFrames(page, milliseconds) {
  return page.evaluate(async (duration) => {
    const real = window.requestAnimationFrame;
    let asked = 0;
    window.requestAnimationFrame = (callback) => {
      asked += 1;
      return real.call(window, callback);
    };
    await new Promise((resolve) => setTimeout(resolve, duration));
    window.requestAnimationFrame = real;
    return asked;
  }, milliseconds);
}

/** Waits until no frame has been asked for during a second. */
export async function quiet(page) {
  for (let tries = 0; tries < 60; tries += 1) {
    if ((await countFrames(page, 1000)) === 0) return;
  }
  throw new Error('frames are asked for again and again');
}

/** The share of pixels of a widget that are not its commonest colour. */
export async function paintedShare(page, selector = 'slam-widget') {
  return page.evaluate(async (css) => {
    const widget = document.querySelector(css);
    const canvas = widget.shadowRoot.querySelector('canvas');
    const picture = await widget.snapshot();
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
    copy.drawImage(picture, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    const counts = new Map();
    for (let at = 0; at < data.length; at += 4) {
      const color = (data[at] << 16) | (data[at + 1] << 8) | data[at + 2];
      counts.set(color, (counts.get(color) ?? 0) + 1);
    }
    const total = data.length / 4;
    return { share: 1 - Math.max(...counts.values()) / total, colors: counts.size };
  }, selector);
}
