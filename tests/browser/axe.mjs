// What axe-core finds on a page, by the rules that all pages of this project keep.

import { readFileSync } from 'node:fs';

const AXE = readFileSync(new URL('./node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');

const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];

/** Of their rules, what depends on the colours: a page that keeps all rules in light has to keep these in dark. */
export const OF_COLORS = ['color-contrast', 'link-in-text-block'];

/** Every violation of tags or rules with the elements it is about; frames within the page are not looked into. */
export async function violations(page, runOnly = TAGS) {
  if (!(await page.evaluate(() => 'axe' in window))) await page.evaluate(AXE);
  // axe leaves the size of targets out unless asked.
  const options = { runOnly, rules: { 'target-size': { enabled: true } }, iframes: false };
  const found = await page.evaluate((given) => axe.run(document, given), options);
  return found.violations.map(({ id, nodes }) => [id, nodes.map((node) => node.html)]);
}
