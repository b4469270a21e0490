// The oldest browsers of the project, declared once: `browserslist` in web/package.json.

import { readFileSync } from 'node:fs';

/** Name and version of each: `['Chrome', '109']`. */
function declared() {
  const { browserslist } = JSON.parse(readFileSync(new URL('package.json', import.meta.url), 'utf8'));
  return browserslist.map((/** @type {string} */ line) => line.split(' >= '));
}

/** As in a sentence: `Chrome 109, Firefox 121 or Safari 16.4`. */
export function oldestBrowsers() {
  const named = declared().filter(([/** @type {string} */ name]) => ['Chrome', 'Firefox', 'Safari'].includes(name));
  return named.map((/** @type {string[]} */ parts) => parts.join(' ')).join(', ').replace(/, (?=[^,]*$)/, ' or ');
}

/** The versions by the names of MDN's compatibility data. */
export function oldestVersions() {
  return Object.fromEntries(declared().map(([name, version]) => [name === 'iOS' ? 'safari_ios' : name.toLowerCase(), version]));
}
