// The stock Firefox over WebDriver BiDi. Playwright 1.65 emulates media features that Firefox ESR 153 does not know.

import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import WebSocket from 'ws';
import { HOW, ended, openDisplay, pathOf } from './display.mjs';
import { actions } from './keys.mjs';

/** Without the first two, Firefox refuses WebGL on a software renderer. */
const PREFERENCES = {
  'webgl.force-enabled': true,
  'webgl.disable-fail-if-major-performance-caveat': true,
  'browser.aboutwelcome.enabled': false,
  'browser.shell.checkDefaultBrowser': false,
  'browser.startup.page': 0,
  'datareporting.policy.dataSubmissionEnabled': false,
  'toolkit.telemetry.reportingpolicy.firstRun': false,
  'app.update.disabledForTesting': true,
};

/** Opens Firefox with one page. */
export async function openFirefox() {
  const display = await openDisplay();
  const profile = mkdtempSync(join(tmpdir(), 'slam-firefox-'));
  const lines = Object.entries({ ...PREFERENCES, 'browser.download.folderList': 2, 'browser.download.dir': profile });
  writeFileSync(join(profile, 'user.js'), lines.map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});\n`).join(''));
  const browser = spawn(firefox(), ['--remote-debugging-port=0', '--no-remote', '--profile', profile, 'about:blank'], {
    env: { ...display.env, HOME: profile, MOZ_CRASHREPORTER_DISABLE: '1' },
    stdio: ['ignore', 'ignore', 'pipe'],
  });
  const session = await connect(await listening(browser));
  await session.send('session.new', { capabilities: {} });
  const { contexts: [{ context }] } = await session.send('browsingContext.getTree', {});
  const act = (sources) => session.send('input.performActions', { context, actions: sources });
  return {
    goto: (url) => session.send('browsingContext.navigate', { context, url, wait: 'complete' }),
    back: () => session.send('browsingContext.traverseHistory', { context, delta: -1 }),
    evaluate: async (source) => {
      const expression = `Promise.resolve(${source}).then((value) => JSON.stringify(value === undefined ? null : value))`;
      const { type, result, exceptionDetails } = await session.send('script.evaluate', { expression, target: { context }, awaitPromise: true });
      if (type === 'exception') throw new Error(exceptionDetails.text);
      return JSON.parse(result.value);
    },
    move: (x, y) => act(actions.move(x, y)),
    down: () => act(actions.down()),
    up: () => act(actions.up()),
    press: (key) => act(actions.press(key)),
    resize: (width, height) => session.send('browsingContext.setViewport', { context, viewport: { width, height } }),
    screenshot: async () => Buffer.from((await session.send('browsingContext.captureScreenshot', { context })).data, 'base64'),
    close: async () => {
      session.close();
      await ended(browser);
      await display.close();
      rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
    },
  };
}

/** `FIREFOX`, or the one on the path. */
function firefox() {
  return process.env.FIREFOX ?? pathOf('firefox-esr', 'firefox');
}

/** What is missing for Firefox; undefined if nothing is. */
export function firefoxProblem() {
  return firefox() === undefined || pathOf('Xvfb') === undefined ? `is missing: ${HOW}` : undefined;
}

/** The address that Firefox prints once it listens. */
function listening(browser) {
  return new Promise((resolve, reject) => {
    let printed = '';
    browser.stderr.on('data', (bytes) => {
      printed += bytes;
      const address = /WebDriver BiDi listening on (ws:\S+)/.exec(printed)?.[1];
      if (address !== undefined) resolve(`${address}/session`);
    });
    browser.once('error', reject);
    browser.once('exit', (code) => reject(new Error(`Firefox ended with ${code}: ${printed}`)));
  });
}

/** Sends commands, and resolves each with its answer. */
async function connect(address) {
  const socket = new WebSocket(address);
  await new Promise((resolve, reject) => socket.once('open', resolve).once('error', reject));
  const pending = new Map();
  socket.on('message', (text) => {
    const { id, type, result, error, message } = JSON.parse(text);
    const waiting = pending.get(id);
    pending.delete(id);
    if (type === 'success') waiting?.resolve(result);
    else if (type === 'error') waiting?.reject(new Error(`${error}: ${message}`));
  });
  const fail = () => {
    for (const { reject } of pending.values()) reject(new Error('Firefox has gone'));
  };
  socket.on('close', fail);
  let last = 0;
  return {
    send: (method, params) => new Promise((resolve, reject) => {
      last += 1;
      pending.set(last, { resolve, reject });
      socket.send(JSON.stringify({ id: last, method, params }));
    }),
    close: () => socket.close(),
  };
}
