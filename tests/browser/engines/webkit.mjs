// WebKit over WebDriver, as plain HTTP requests: Playwright drives only its own build of it.

import { spawn } from 'node:child_process';
import { existsSync, readdirSync } from 'node:fs';
import { createServer } from 'node:net';
import { join } from 'node:path';
import { LAST_RESORT_MS } from '../chromium.mjs';
import { HOW, ended, openDisplay, pathOf } from './display.mjs';
import { actions } from './keys.mjs';

/** The browser of WebKitGTK lies in the folder of its library. */
function miniBrowser() {
  const folders = existsSync('/usr/lib') ? readdirSync('/usr/lib') : [];
  const paths = folders.flatMap((folder) => ['4.1', '6.0'].map((version) => join('/usr/lib', folder, `webkit2gtk-${version}`, 'MiniBrowser')));
  return paths.find((path) => existsSync(path));
}

/** A free port: the driver cannot be asked to choose one. */
function freePort() {
  return new Promise((resolve) => {
    const server = createServer();
    server.listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

/** One request of the protocol; its error has the driver's sentence. */
async function request(base, method, path, body) {
  const response = await fetch(`${base}${path}`, {
    method,
    body: body === undefined ? null : JSON.stringify(body),
    headers: { 'Content-Type': 'application/json' },
    signal: AbortSignal.timeout(LAST_RESORT_MS),
  });
  const { value } = await response.json();
  if (!response.ok) throw new Error(`${path}: ${value?.error}: ${value?.message}`);
  return value;
}

/** Resolves once the driver answers. */
async function answering(base, driver) {
  for (;;) {
    if (driver.exitCode !== null) throw new Error(`WebKitWebDriver ended with ${driver.exitCode}`);
    try {
      return await request(base, 'GET', '/status');
    } catch (error) {
      if (error.cause?.code !== 'ECONNREFUSED') throw error;
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }
}

/** Opens WebKit with one page. */
export async function openWebKit() {
  const display = await openDisplay();
  const port = await freePort();
  const env = { ...display.env, WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS: '1', NO_AT_BRIDGE: '1' };
  const driver = spawn('WebKitWebDriver', ['-p', String(port)], { env, stdio: 'ignore' });
  const base = `http://127.0.0.1:${port}`;
  await answering(base, driver);
  const options = { binary: miniBrowser(), args: ['--automation'] };
  const { sessionId } = await request(base, 'POST', '/session', {
    capabilities: { alwaysMatch: { 'webkitgtk:browserOptions': options, timeouts: { script: LAST_RESORT_MS, pageLoad: LAST_RESORT_MS } } },
  });
  const send = (method, path, body) => request(base, method, `/session/${sessionId}${path}`, body);
  const act = (sources) => send('POST', '/actions', { actions: sources });
  return {
    goto: (url) => send('POST', '/url', { url }),
    back: () => send('POST', '/back', {}),
    evaluate: async (source) => {
      const script = `const done = arguments[0]; Promise.resolve().then(() => (${source})).then((value) => done({ value }), (error) => done({ error: String(error) }));`;
      const { value, error } = await send('POST', '/execute/async', { script, args: [] });
      if (error !== undefined) throw new Error(error);
      return value;
    },
    move: (x, y) => act(actions.move(x, y)),
    down: () => act(actions.down()),
    up: () => act(actions.up()),
    press: (key) => act(actions.press(key)),
    /** The window has its title bar and tool bar above the page. */
    resize: async (width, height) => {
      const [outerWidth, outerHeight, innerWidth, innerHeight] = await send('POST', '/execute/sync', { script: 'return [outerWidth, outerHeight, innerWidth, innerHeight]', args: [] });
      await send('POST', '/window/rect', { width: width + outerWidth - innerWidth, height: height + outerHeight - innerHeight });
    },
    screenshot: async () => Buffer.from(await send('GET', '/screenshot'), 'base64'),
    close: async () => {
      await send('DELETE', '').catch(() => {});
      await ended(driver);
      await display.close();
    },
  };
}

/** What is missing for WebKit; undefined if nothing is. */
export function webkitProblem() {
  const isHere = miniBrowser() !== undefined && pathOf('WebKitWebDriver') !== undefined && pathOf('Xvfb') !== undefined;
  return isHere ? undefined : `is missing: ${HOW}`;
}
