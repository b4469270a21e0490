// Measures the start of the first page on a phone with a slow line and a slow processor:
// `node tests/bench/slow_line.mjs [PAGE.md] [ROUNDS]`. Prints a table, and writes it into the page.

import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { extname, join } from 'node:path';
import { brotliCompressSync } from 'node:zlib';
import { writeGeneratedBlock } from '../../web/generated-block.mjs';
import { launchForTimes } from '../browser/chromium.mjs';
import { DIST, TYPES, serve } from '../browser/harness.mjs';
import { machine, quantile } from './in_chromium.mjs';

const LINE = { offline: false, latency: 150, downloadThroughput: 1.6e6 / 8, uploadThroughput: 0.75e6 / 8 };
const SLOWER = 4;
const SCREEN = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true };
/** What is measured, and the project's limits, ms. */
const STEPS = {
  'first paint': [() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime],
  'the lap under the title moves': [() => Number(document.querySelector('#lap input')?.value) > 0 && performance.now(), 2500],
  'the first widget draws': [() => document.querySelector('slam-widget').shadowRoot?.querySelector('.stage.live') && performance.now()],
  'the first widget answers': [() => window.answeredMs, 8000],
};

const [page, rounds = '3'] = process.argv.slice(2);
const found = await measure(Number(rounds));
const text = table(found);
console.log(text);
if (page !== undefined) await writeGeneratedBlock(page, 'slow line', text);

/** Serves the site compressed, as hosts do. */
function compressed() {
  const packed = new Map();
  const pack = (file) => packed.get(file) ?? packed.set(file, brotliCompressSync(readFileSync(file))).get(file);
  // This one takes longer than a page waits.
  pack(join(DIST, readdirSync(DIST).find((name) => /^slam_web-.*wasm$/.test(name))));
  return (pathname, response) => {
    const file = join(DIST, pathname);
    if (!existsSync(file) || !['.html', '.css', '.js', '.json', '.wasm', '.svg'].includes(extname(file))) return false;
    const bytes = pack(file);
    response.writeHead(200, { 'Content-Type': TYPES[extname(file)], 'Content-Encoding': 'br', 'Content-Length': bytes.length });
    response.end(bytes);
    return true;
  };
}

/** A reader who looks at the lap until it moves, goes to the first widget, and presses its first button. */
async function visit(browser, url) {
  const context = await browser.newContext(SCREEN);
  try {
    const tab = await context.newPage();
    const devTools = await context.newCDPSession(tab);
    await devTools.send('Network.enable');
    await devTools.send('Network.setCacheDisabled', { cacheDisabled: true });
    await devTools.send('Network.emulateNetworkConditions', LINE);
    await devTools.send('Emulation.setCPUThrottlingRate', { rate: SLOWER });
    await tab.goto(`${url}/index.html`, { waitUntil: 'commit' });
    const times = {};
    const reach = async (name) => {
      const [condition] = STEPS[name];
      const handle = await tab.waitForFunction(condition, undefined, { timeout: 0 });
      times[name] = await handle.jsonValue();
    };
    await reach('first paint');
    await reach('the lap under the title moves');
    await tab.evaluate(() => document.querySelector('slam-widget').scrollIntoView());
    await reach('the first widget draws');
    await tab.evaluate(() => {
      const widget = document.querySelector('slam-widget');
      const { frames } = widget;
      widget.shadowRoot.querySelector('.transport button, .first button').click();
      const look = () => {
        if (widget.frames > frames) window.answeredMs = performance.now();
        else requestAnimationFrame(look);
      };
      look();
    });
    await reach('the first widget answers');
    const requests = await tab.evaluate(() => performance.getEntriesByType('resource')
      .map(({ name, startTime, responseEnd, encodedBodySize }) => [name.split('/').slice(3).join('/'), Math.round(startTime), Math.round(responseEnd), encodedBodySize]));
    return { times, requests };
  } finally {
    await context.close().catch(() => {});
  }
}

async function measure(count) {
  const answer = compressed();
  const server = await serve({ answer });
  const browser = await launchForTimes();
  const times = new Map(Object.keys(STEPS).map((name) => [name, []]));
  try {
    // The first visit compresses the files.
    for (let round = 0; round <= count; round += 1) {
      const { times: all, requests } = await visit(browser, server.url);
      if (process.env.SLOW_REQUESTS !== undefined) console.log(all, requests.map((one) => one.join('  ')).join('\n'));
      if (round > 0) for (const [name, ms] of Object.entries(all)) times.get(name).push(ms);
    }
  } finally {
    await browser.close();
    await server.close();
  }
  return times;
}

function table(times) {
  const told = (ms) => (ms === undefined ? '–' : `${(ms / 1000).toFixed(1)} s`);
  const rows = [...times].map(([name, ms]) => `| ${[name, told(Math.min(...ms)), told(quantile(ms, 0.5)), told(STEPS[name][1])].join(' | ')} |`);
  return [`Measured on ${machine()}, ${rounds} rounds.`, '', '| from the navigation until | fastest | median | limit |', '|---|--:|--:|--:|', ...rows].join('\n');
}
