// Violations found by axe-core, by the rules for all pages of this project.

import { readFileSync } from 'node:fs';

const AXE = readFileSync(new URL('./node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');

const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];

/** Rules that depend on colours: a page that satisfies all rules in light has to satisfy these in dark. */
export const OF_COLORS = ['color-contrast', 'link-in-text-block'];

/** Every violation of tags or rules with its elements; frames within the page are excluded. */
export async function violations(page, runOnly = TAGS) {
  if (!(await page.evaluate(() => 'axe' in window))) await page.evaluate(AXE);
  // axe checks the size of targets only on request.
  const options = { runOnly, rules: { 'target-size': { enabled: true } }, iframes: false };
  const found = await page.evaluate((given) => axe.run(document, given), options);
  return found.violations.map(({ id, nodes }) => [id, nodes.map((node) => node.html)]);
}
