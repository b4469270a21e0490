// What axe-core finds on a page, by the rules that all pages of this project keep.

import { readFileSync } from 'node:fs';

const AXE = readFileSync(new URL('./node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');

const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];

/** Every violation with the elements it is about; frames within the page are not looked into. */
export async function violations(page) {
  await page.evaluate(AXE);
  // axe leaves the size of targets out unless asked.
  const options = { runOnly: TAGS, rules: { 'target-size': { enabled: true } }, iframes: false };
  const found = await page.evaluate((given) => axe.run(document, given), options);
  return found.violations.map(({ id, nodes }) => [id, nodes.map((node) => node.html)]);
}
