// The stock Firefox over WebDriver BiDi. Playwright 1.65 emulates media features that Firefox ESR 153 does not know.

import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import WebSocket from 'ws';
import { LAST_RESORT_MS } from '../chromium.mjs';
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

/** Time after which a page that was being left is asked again, ms. */
const ASK_AGAIN_MS = 2000;

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
  const evaluate = async (source, patience_ms) => {
    const expression = `Promise.resolve(${source}).then((value) => JSON.stringify(value === undefined ? null : value))`;
    const { type, result, exceptionDetails } = await session.send('script.evaluate', { expression, target: { context }, awaitPromise: true }, patience_ms);
    if (type === 'exception') throw new Error(exceptionDetails.text);
    return JSON.parse(result.value);
  };
  // Firefox may say too early that it has left a page, and a page that it leaves never answers. A page to which Back returns
  // may still have the mark of an earlier leave.
  let leaves = 0;
  const leave = async (command, params) => {
    leaves += 1;
    const mark = leaves;
    await evaluate(`void (window.leaves = ${mark})`);
    await session.send(command, { context, ...params });
    const isLeft = () => evaluate(`window.leaves !== ${mark}`, ASK_AGAIN_MS).catch(() => false);
    while (!(await isLeft()));
  };
  return {
    goto: (url) => leave('browsingContext.navigate', { url, wait: 'complete' }),
    back: () => leave('browsingContext.traverseHistory', { delta: -1 }),
    evaluate,
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
    if (type === 'success') waiting?.resolve(result);
    else if (type === 'error') waiting?.reject(new Error(`${error}: ${message}`));
  });
  const fail = () => {
    for (const { reject } of pending.values()) reject(new Error('Firefox has gone'));
  };
  socket.on('close', fail);
  let last = 0;
  return {
    send: async (method, params, patience_ms = LAST_RESORT_MS) => {
      last += 1;
      const id = last;
      let timer;
      try {
        return await new Promise((resolve, reject) => {
          timer = setTimeout(() => reject(new Error(`${method}: no answer for ${patience_ms / 1000} s`)), patience_ms);
          pending.set(id, { resolve, reject });
          socket.send(JSON.stringify({ id, method, params }));
        });
      } finally {
        clearTimeout(timer);
        pending.delete(id);
      }
    },
    close: () => socket.close(),
  };
}
