// node web/size-table.mjs PAGE WHAT=FILE…: what builds of the module weigh beside the first of them,
// as a table in PAGE.

import { readFile } from 'node:fs/promises';

import { writeMarked } from './marked.mjs';
import { brotli, withoutNames } from './wasm-file.mjs';

const [page, ...named] = process.argv.slice(2);
if (page === undefined || named.length === 0) {
  throw new Error('usage: node web/size-table.mjs PAGE WHAT=FILE…');
}

const rows = [];
for (const pair of named) {
  const end = pair.indexOf('=');
  const what = pair.slice(0, end);
  const module = await readFile(pair.slice(end + 1));
  if (rows.length === 0) rows.push(['as published', brotli(withoutNames(module))]);
  rows.push([what, brotli(rows.length === 1 ? module : withoutNames(module))]);
}

const published = rows[0][1];
const table = [
  '| build | brotli −11, bytes | more |',
  '|---|--:|--:|',
  ...rows.map(([what, bytes]) => {
    const more = (100 * (bytes / published - 1)).toFixed(1);
    return `| ${what} | ${bytes} | ${bytes === published ? '' : `${more} %`} |`;
  }),
].join('\n');
console.log(table);
await writeMarked(page, 'sizes', table);
