// node web/size-table.mjs PAGE WHAT=FILE…: writes a table into PAGE that compares the sizes of builds of the module with
// the first one, which is published.

import { readFileSync } from 'node:fs';

import { writeGeneratedBlock } from './generated-block.mjs';
import { brotli, withoutNames } from './wasm-file.mjs';

const [page, ...named] = process.argv.slice(2);
if (page === undefined || named.length === 0) {
  throw new Error('usage: node web/size-table.mjs PAGE WHAT=FILE…');
}

/** @type {[string, Buffer][]} */
const builds = named.map((pair) => {
  const end = pair.indexOf('=');
  return [pair.slice(0, end), readFileSync(pair.slice(end + 1))];
});
/** @type {[string, number][]} */
const rows = builds.map(([what, module]) => [what, brotli(withoutNames(module))]);
const published = rows[0][1];
rows.splice(1, 0, ['with the names of its functions', brotli(builds[0][1])]);

const table = [
  '| build | brotli −11, bytes | more |',
  '|---|--:|--:|',
  ...rows.map(([what, bytes]) => {
    const more = (100 * (bytes / published - 1)).toFixed(1);
    return `| ${what} | ${bytes} | ${bytes === published ? '' : `${more} %`} |`;
  }),
].join('\n');
console.log(table);
await writeGeneratedBlock(page, 'sizes', table);
