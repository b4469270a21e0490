// node web/offline.mjs DIST FILE: the site as a zip whose pages open from a folder by a double click.
//
// A browser that shows a file from the disk fetches nothing beside it and runs no module script. So each page gets one
// classic script of its modules, and a second one that holds the files which they would fetch.

import { readFile, readdir } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';
import { writeZip } from './zip.mjs';

/** What scripts fetch: programs, data, and the scripts of workers. */
const FETCHED = /\.(wasm|json|log|tum)$|worker-\w+\.js$|^slam-robot-\w+\.js$/;
/** What only programs of other authors use: the package, and examples that need a server. */
const LEFT_OUT = /^(examples\/|package\.json$|.*\.d\.ts$|slam-anywidget\.js$)/;
const MODULE = /<script type="module" src="([^"]+)"[^>]*><\/script>\n?/g;

const [from, target] = process.argv.slice(2);
if (from === undefined || target === undefined) throw new Error('usage: node web/offline.mjs DIST FILE');
const dist = resolve(from);

const all = (await readdir(dist, { recursive: true, withFileTypes: true })).filter((entry) => entry.isFile())
  .map((entry) => join(entry.parentPath, entry.name).slice(dist.length + 1).replaceAll('\\', '/')).sort();
const files = all.filter((name) => !LEFT_OUT.test(name));
const contents = {};
for (const name of files) {
  if (!FETCHED.test(name) && !name.endsWith('.js')) contents[name] = await readFile(join(dist, name));
}
contents['offline-files.js'] = Buffer.from(await carried());
for (const name of files.filter((one) => one.endsWith('.html'))) await convert(name);
console.log(`${target}: ${await writeZip(target, contents)} bytes`);

/** Scripts of workers as text, because a worker starts at once; all else compressed. */
async function carried() {
  const held = {};
  for (const name of files.filter((one) => FETCHED.test(one))) {
    const bytes = await readFile(join(dist, name));
    held[name] = name.endsWith('.js') ? bytes.toString() : gzipSync(bytes, { level: 9 }).toString('base64');
  }
  return `globalThis.slamFiles = ${JSON.stringify(held)};\n`;
}

/** Puts the modules of a page into one classic script. */
async function convert(name) {
  const html = contents[name].toString();
  const modules = [...html.matchAll(MODULE)].map(([, src]) => src);
  if (modules.length === 0) return;
  const script = `offline-${name.replace('.html', '')}.js`;
  const { outputFiles } = await esbuild.build({
    stdin: { contents: ["import 'from-disk';", ...modules.map((src) => `import './${src}';`)].join('\n'), resolveDir: dist },
    bundle: true,
    format: 'iife',
    target: 'es2022',
    minify: true,
    define: { 'import.meta.url': 'document.baseURI' },
    write: false,
    logLevel: 'warning',
    alias: { 'from-disk': fileURLToPath(new URL('ts/from-disk.ts', import.meta.url)) },
  });
  contents[script] = Buffer.from(outputFiles[0].contents);
  const tags = `<script defer src="offline-files.js"></script>\n<script defer src="${script}"></script>\n`;
  contents[name] = Buffer.from(html.replace(MODULE, '').replace('</head>', `${tags}</head>`));
}
