// Maps a large log in w16.10 and prints the peak memory of the renderer process, with page and worker:
//
//     node tests/browser/large-log.mjs LOG [CANCEL_AT_PERCENT]
//
// Takes minutes, and so is no test. `crates/robots/robot_io/recordings/long.py` writes the log. Needs Linux and a finished
// `cargo xtask build`.

import { readFileSync } from 'node:fs';
import { launch } from './chromium.mjs';
import * as h from './harness.mjs';

const [, , log, cancelAt = '101'] = process.argv;
const STEP = 5;
const seconds = (from) => ((performance.now() - from) / 1000).toFixed(1);

const browser = await launch(['--no-first-run']);
const server = await h.serve({ pages: { '/t.html': h.bare('<slam-widget name="w16.10"></slam-widget>') } });
try {
  const tab = await browser.newPage({ viewport: { width: 1100, height: 900 }, deviceScaleFactor: 0.5 });
  tab.setDefaultTimeout(0);
  // Software drawing would take CPU time from the worker.
  await tab.addInitScript(() => { WebGL2RenderingContext.prototype.drawElements = () => {}; });
  await tab.goto(`${server.url}/t.html`);
  await h.ready(tab);
  const { processInfo } = await (await browser.newBrowserCDPSession()).send('SystemInfo.getProcessInfo');
  let maxMb = 0;
  /** Peak memory of a renderer, MB. Chromium resets the kernel's counter now and then. */
  const peakMb = () => {
    for (const { id } of processInfo.filter(({ type }) => type === 'renderer')) {
      const [, kilobytes] = /VmHWM:\s+(\d+)/.exec(readFileSync(`/proc/${id}/status`, 'utf8'));
      maxMb = Math.max(maxMb, Math.round(Number(kilobytes) / 1000));
    }
    return maxMb;
  };
  console.log(`before: ${peakMb()} MB`);
  const isOver = () => /^(mapped|no map)$|in doubt$/.test(document.querySelector('slam-widget').outcome.verdict);
  const reaches = ([share, over]) => new Function(`return (${over})()`)()
    || document.querySelector('slam-widget').outcome.facts.done_percent >= share;
  const outcome = () => tab.evaluate(() => document.querySelector('slam-widget').outcome);
  const press = (id) => tab.evaluate((name) => document.querySelector('slam-widget').press(name), id);

  const chosen = tab.waitForEvent('filechooser');
  await press('open');
  const start = performance.now();
  await (await chosen).setFiles(log);
  for (let share = STEP; share <= 100; share += STEP) {
    await tab.waitForFunction(reaches, [Math.min(share, Number(cancelAt)), isOver.toString()]);
    const { facts } = await outcome();
    console.log(`${facts.done_percent} % after ${seconds(start)} s: ${facts.scans} scans, ${facts.keyframes} keyframes, ${peakMb()} MB`);
    if (facts.done_percent >= Number(cancelAt)) {
      const pressed = performance.now();
      await press('cancel');
      await tab.waitForFunction(() => /Stopped after/.test(document.querySelector('slam-widget').outcome.sentence));
      console.log(`stopped in ${seconds(pressed)} s`);
      break;
    }
  }
  await tab.waitForFunction(isOver);
  console.log(`${(await outcome()).sentence}\nafter ${seconds(start)} s: ${peakMb()} MB at most`);
} finally {
  await browser.close();
  await server.close();
}
