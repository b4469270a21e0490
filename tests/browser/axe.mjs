// Accessibility violations, by axe-core.

import { readFileSync } from 'node:fs';

const AXE = readFileSync(new URL('./node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');

const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];

/** Rules that depend on colours: a page that satisfies all rules in light only needs these in dark. */
export const OF_COLORS = ['color-contrast', 'link-in-text-block'];

/** Every violation of tags or rules with its elements, without frames. */
export async function violations(page, runOnly = TAGS) {
  if (!(await page.evaluate(() => 'axe' in window))) await page.evaluate(AXE);
  // Off by default in axe.
  const options = { runOnly, rules: { 'target-size': { enabled: true } }, iframes: false };
  const results = await page.evaluate((settings) => axe.run(document, settings), options);
  return results.violations.map(({ id, nodes }) => [id, nodes.map((node) => node.html)]);
}
