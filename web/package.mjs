// node web/package.mjs DIST OUT: builds installable packages in OUT from the site in DIST.
//
// 1. the npm archive, packed from DIST;
// 2. the Python wheel: `web/python` and the standalone anywidget module.

import { execFileSync } from 'node:child_process';
import { cp, mkdir, mkdtemp, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';
import { oldestBrowsers } from './browsers.mjs';

const WEB = dirname(fileURLToPath(import.meta.url));

/** Files with a hash in their names, by the names in the standalone module. */
const PROGRAMS = { program: /^slam_web-.*\.wasm$/, robot: /^slam_robot-.*\.wasm$/, worker: /^slam-robot-.*\.js$/ };
/** The samples of w16.10, in the same order as in `web/build.mjs`. */
const SAMPLES = ['samples/ring.log', 'samples/ring-truth.tum', 'samples/ring-another-day.log'];

const [dist, out] = process.argv.slice(2).map((path) => resolve(path));
if (dist === undefined || out === undefined) throw new Error('usage: node web/package.mjs DIST OUT');

await mkdir(out, { recursive: true });
npm();
await wheel();
for (const file of (await readdir(out)).sort()) console.log(join(basename(out), file));

function npm() {
  execFileSync('npm', ['pack', '--silent', dist, '--pack-destination', out], { stdio: ['ignore', 'ignore', 'inherit'] });
}

async function wheel() {
  const folder = await mkdtemp(join(tmpdir(), 'slam-wheel-'));
  try {
    await cp(join(WEB, 'python'), folder, { recursive: true });
    const assets = join(folder, 'slam_widgets', 'static');
    await mkdir(assets);
    await writeFile(join(assets, 'slam-widgets.js'), await standaloneModule());
    await cp(join(dist, 'schema.json'), join(assets, 'schema.json'));
    for (const text of ['LICENSE-MIT', 'LICENSE-APACHE', 'THIRD-PARTY-NOTICES.txt']) {
      await cp(join(dist, text), join(folder, text));
    }
    const python = process.env.PYTHON ?? 'python3';
    execFileSync(python, ['-m', 'pip', 'wheel', '--quiet', '--no-deps', '--wheel-dir', out, folder], { stdio: 'inherit' });
  } finally {
    await rm(folder, { recursive: true });
  }
}

/** A file of the site, gzipped, as base64. */
async function compressed(file) {
  return gzipSync(await readFile(join(dist, file)), { level: 9 }).toString('base64');
}

/** The anywidget module with the element, the programs and the samples in one file. */
async function standaloneModule() {
  const embedded = {};
  const files = await readdir(dist);
  for (const [name, pattern] of Object.entries(PROGRAMS)) {
    const file = files.find((one) => pattern.test(one));
    if (file === undefined) throw new Error(`${dist} has no ${name}; run cargo xtask build`);
    embedded[name] = await compressed(file);
  }
  for (const name of SAMPLES) embedded[name] = await compressed(name);
  const embed = {
    name: 'embed',
    setup(build) {
      build.onResolve({ filter: /^embedded-files$/ }, () => ({ path: 'embedded-files', namespace: 'embed' }));
      build.onLoad({ filter: /.*/, namespace: 'embed' }, () => ({
        contents: `export default ${JSON.stringify(embedded)};`,
      }));
      // The element is a separate bundle elsewhere.
      build.onResolve({ filter: /^\.\/slam-widget\.js$/ }, () => ({ path: join(WEB, 'ts', 'main.ts') }));
    },
  };
  const { outputFiles } = await esbuild.build({
    entryPoints: [join(WEB, 'ts', 'anywidget-standalone.ts')],
    bundle: true,
    format: 'esm',
    target: 'es2022',
    minify: true,
    // Names of embedded files. No URL is ever fetched.
    define: {
      BROWSERS: JSON.stringify(oldestBrowsers()),
      WASM_FILE: '"program"',
      ROBOT_WASM_FILE: '"robot"',
      ROBOT_WORKER_FILE: '"worker"',
      SAMPLE_FILES: JSON.stringify(SAMPLES),
      'import.meta.url': '""',
    },
    write: false,
    legalComments: 'none',
    logLevel: 'warning',
    plugins: [embed],
  });
  return outputFiles[0].text;
}
