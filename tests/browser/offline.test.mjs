// The site as a zip: its pages open from a folder, without any server.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { LAST_RESORT_MS } from './chromium.mjs';
import * as h from './harness.mjs';
import { unpackOffline } from './unpacked.mjs';

let folder;
let browser;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'offline-'));
  unpackOffline(join(folder, 'site.zip'), join(folder, 'site'));
  browser = await h.launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

/** Opens a page of the folder, which must cause neither errors nor network requests. */
async function opened(page, test) {
  const context = await browser.newContext({ viewport: { width: 1100, height: 900 } });
  context.setDefaultTimeout(LAST_RESORT_MS);
  const tab = await context.newPage();
  const troubles = [];
  tab.on('console', (message) => message.type() === 'error' && troubles.push(message.text()));
  tab.on('pageerror', (error) => troubles.push(error.message));
  tab.on('request', (request) => /^(https?|wss?):/.test(request.url()) && troubles.push(request.url()));
  try {
    await tab.goto(`${pathToFileURL(join(folder, 'site')).href}/${page}`);
    await test(tab);
    assert.deepEqual(troubles, []);
  } finally {
    await context.close();
  }
}

it('a page from the disk runs a widget, replays the lap, and runs laps in workers', async () => {
  await opened('index.html', async (tab) => {
    await tab.waitForSelector('#lap.live');
    await tab.locator('slam-widget[name="w16.1"]').scrollIntoViewIfNeeded();
    await h.ready(tab, 'slam-widget[name="w16.1"]');
    const verdict = await tab.evaluate(() => {
      const one = document.querySelector('slam-widget[name="w16.1"]');
      one.value = { heading: 90, dx: 0, dy: 0 };
      return one.outcome.verdict;
    });
    assert.equal(verdict, 'quarter turn');
    const [worker] = await Promise.all([tab.waitForEvent('worker'), tab.locator('#laps').scrollIntoViewIfNeeded()]);
    assert.match(worker.url(), /^data:text\/javascript,/);
    await tab.waitForFunction(() => /^[1-9]\d* of \d+ seeds/.test(document.querySelector('#laps .laps-count')?.textContent ?? ''));
  });
});

it('a page from the disk runs a written function, which drives w16.1', async () => {
  await opened('index.html', async (tab) => {
    await tab.locator('details[data-write="svd_align"]').evaluate((one) => {
      for (let at = one; at !== null; at = at.parentElement?.closest('details') ?? null) at.open = true;
    });
    for (let step = 0; step < 4; step += 1) await tab.getByRole('button', { name: /^Help/ }).click();
    await tab.getByRole('button', { name: 'Run', exact: true }).click();
    await tab.getByText('All 5 tests pass').waitFor();
    await tab.getByRole('button', { name: 'Drive the registration of w16.1 with it' }).click();
    const driven = () => document.querySelector('slam-widget[name="w16.1"]').outcome?.sentence.includes('your svd_align ends');
    await tab.waitForFunction(driven);
  });
});

it('a page from the disk maps the sample log', async () => {
  await opened('own-robot.html', async (tab) => {
    const robot = 'slam-widget[name="w16.10"]';
    await tab.getByRole('button', { name: 'Map the sample' }).click();
    await tab.waitForFunction((css) => document.querySelector(css).outcome?.facts.keyframes > 3, robot);
  });
});

it('a page from the disk shows a single exercise, and checks its answer', async () => {
  await opened('embed.html?exercise=16.1', async (tab) => {
    const question = tab.locator('slam-predict');
    await question.locator('input').nth(2).check();
    await question.getByRole('button', { name: 'Commit and see' }).click();
    await question.getByText(/^As you predicted/).waitFor();
  });
});
