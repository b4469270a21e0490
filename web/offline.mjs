// node web/offline.mjs DIST FILE: the site as a zip whose pages open from the disk by a double click.
//
// For file URLs browsers block fetch and module scripts. So each page gets its modules as one classic script, and a second
// script with the files that they fetch.

import { readFile, readdir } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';
import { POLICY_TAG } from './html.mjs';
import { writeZip } from './zip.mjs';

/** Files that scripts fetch: wasm, data, and workers. */
const FETCHED = /\.(wasm|json|log|tum)$|worker-\w+\.js$|^slam-robot-\w+\.js$/;
/** Files of the npm package, and examples that need a server. */
const EXCLUDED = /^(examples\/|package\.json$|.*\.d\.ts$|slam-anywidget\.js$)/;
/** Preloaded files, which a page from the disk cannot fetch. */
const PRELOAD = /<link rel="(?:module)?preload"[^>]*>\n/g;
/** Scripts that fetch, or import. */
const MODULE = /<script(?: type="module")? src="([^"]+)"[^>]*><\/script>\n?/g;

const [from, target] = process.argv.slice(2);
if (from === undefined || target === undefined) throw new Error('usage: node web/offline.mjs DIST FILE');
const dist = resolve(from);

const all = (await readdir(dist, { recursive: true, withFileTypes: true })).filter((entry) => entry.isFile())
  .map((entry) => join(entry.parentPath, entry.name).slice(dist.length + 1).replaceAll('\\', '/')).sort();
const files = all.filter((name) => !EXCLUDED.test(name));
const contents = {};
for (const name of files) {
  // The script of the head is a classic one, and stays.
  if (!FETCHED.test(name) && (!name.endsWith('.js') || name.startsWith('early-'))) contents[name] = await readFile(join(dist, name));
}
contents['offline-files.js'] = Buffer.from(await embeddedFiles());
for (const name of files.filter((one) => one.endsWith('.html'))) await convert(name);
console.log(`${target}: ${await writeZip(target, contents)} bytes`);

/** The script with the fetched files: workers as text, because they are started synchronously; others compressed. */
async function embeddedFiles() {
  const embedded = {};
  for (const name of files.filter((one) => FETCHED.test(one))) {
    const bytes = await readFile(join(dist, name));
    embedded[name] = name.endsWith('.js') ? bytes.toString() : gzipSync(bytes, { level: 9 }).toString('base64');
  }
  return `globalThis.slamFiles = ${JSON.stringify(embedded)};\n`;
}

/** Bundles the modules of a page into one classic script. */
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
  // A file has no origin whose scripts a policy could allow.
  contents[name] = Buffer.from(html.replace(POLICY_TAG, '').replace(PRELOAD, '').replace(MODULE, '').replace('</head>', `${tags}</head>`));
}
