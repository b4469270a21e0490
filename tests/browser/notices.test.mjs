// The page of licences and notices, linked from the footer.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';

const visit = h.visitor();
const reading = (test, options) =>
  visit('', test, { path: '/notices.html', server: { policy: `${h.STRICT_POLICY}; font-src 'self'` }, options });

describe('the page of notices', () => {
  for (const colorScheme of ['light', 'dark']) {
    it(`satisfies axe-core, ${colorScheme}`, async () => {
      await reading(async (tab) => assert.deepEqual(await violations(tab), []), { colorScheme });
    });
  }

  it('fits a phone: nothing is wider than the screen', async () => {
    await reading(async (tab) => {
      assert.equal(await tab.evaluate(() => document.documentElement.scrollWidth), 390);
      const cut = await tab.evaluate(() =>
        [...document.querySelectorAll('pre')].filter((text) => text.scrollWidth > text.clientWidth).length);
      assert.equal(cut, 0, 'every text is broken into lines that fit');
    }, { viewport: { width: 390, height: 800 } });
  });

  it('links from a crate to its licence text', async () => {
    await reading(async (tab) => {
      // Each list with the crate links to the same text.
      const row = tab.locator('li', { has: tab.getByRole('link', { name: 'nalgebra', exact: true }) }).first();
      await row.getByRole('link', { name: 'Apache-2.0', exact: true }).click();
      const text = await tab.evaluate(() => document.querySelector(location.hash).parentElement.textContent);
      assert.match(text, /For .*nalgebra /);
    });
  });
});
