// node web/package.mjs DIST OUT: from the built site in DIST to the installable packages in OUT.
//
// 1. the npm archive, packed from DIST;
// 2. the Python wheel: the anywidget module as one file with the program inside, beside `web/python`.

import { execFileSync } from 'node:child_process';
import { cp, mkdir, mkdtemp, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';

const WEB = dirname(fileURLToPath(import.meta.url));

/** The programs by their names in the module: the widgets, the worker's, and its script. */
const PROGRAMS = { program: /^slam_web-.*\.wasm$/, robot: /^slam_robot-.*\.wasm$/, worker: /^slam-robot-.*\.js$/ };
/** The samples of w16.10, in the order of `web/build.mjs`. */
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
    const inside = join(folder, 'slam_widgets', 'static');
    await mkdir(inside);
    await writeFile(join(inside, 'slam-widgets.js'), await wholeModule());
    await cp(join(dist, 'schema.json'), join(inside, 'schema.json'));
    for (const text of ['LICENSE-MIT', 'LICENSE-APACHE', 'THIRD-PARTY-NOTICES.txt']) {
      await cp(join(dist, text), join(folder, text));
    }
    const python = process.env.PYTHON ?? 'python3';
    execFileSync(python, ['-m', 'pip', 'wheel', '--quiet', '--no-deps', '--wheel-dir', out, folder], { stdio: 'inherit' });
  } finally {
    await rm(folder, { recursive: true });
  }
}

/** A file of the site, compressed, as text. */
async function packed(file) {
  return gzipSync(await readFile(join(dist, file)), { level: 9 }).toString('base64');
}

/** The element, the programs, the samples and the anywidget module, in one file of text. */
async function wholeModule() {
  const carried = {};
  const files = await readdir(dist);
  for (const [name, pattern] of Object.entries(PROGRAMS)) {
    const file = files.find((one) => pattern.test(one));
    if (file === undefined) throw new Error(`${dist} holds no ${name}; run cargo xtask build`);
    carried[name] = await packed(file);
  }
  for (const name of SAMPLES) carried[name] = await packed(name);
  const inside = {
    name: 'inside',
    setup(build) {
      build.onResolve({ filter: /^embedded-files$/ }, () => ({ path: 'carried', namespace: 'inside' }));
      build.onLoad({ filter: /.*/, namespace: 'inside' }, () => ({
        contents: `export default ${JSON.stringify(carried)};`,
      }));
      // Files that are beside this one elsewhere are inside it here.
      build.onResolve({ filter: /^\.\/slam-widget\.js$/ }, () => ({ path: join(WEB, 'ts', 'main.ts') }));
    },
  };
  const { outputFiles } = await esbuild.build({
    entryPoints: [join(WEB, 'ts', 'anywidget-standalone.ts')],
    bundle: true,
    format: 'esm',
    target: 'es2022',
    minify: true,
    // No address is ever requested.
    define: {
      WASM_FILE: '"program"',
      ROBOT_WASM_FILE: '"robot"',
      ROBOT_WORKER_FILE: '"worker"',
      SAMPLE_FILES: JSON.stringify(SAMPLES),
      'import.meta.url': '""',
    },
    write: false,
    legalComments: 'none',
    logLevel: 'warning',
    plugins: [inside],
  });
  return outputFiles[0].text;
}
