// node web/build.mjs DIST PROFILE: from wasm-pack's output to the element and its files in DIST.
//
// 1. wraps the glue in a function: a page then has an instance for each widget;
// 2. runs the module in Node, which writes its schema, the height of each widget at each width, and the static pictures;
// 3. bundles the element. For cache busting, wasm files, bundle and worker have a hash of their content in their names;
// 4. writes our licences and the notices of third parties;
// 5. measures the size of the downloads.

import { createHash } from 'node:crypto';
import { cp, mkdir, readFile, rm, writeFile } from 'node:fs/promises';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';

import { oldestBrowsers } from './browsers.mjs';
import { writeModels, writeParameterTables, writeTypes } from './generate.mjs';
import { heightTable } from './heights.mjs';
import { POLICY } from './html.mjs';
import { endWithOneSentence } from './licences/allowed.mjs';
import { partsOfWidgets, writePackageNotices } from './licences/notices.mjs';
import { brotli, withBuildId, withoutNames } from './wasm-file.mjs';

const WEB = dirname(fileURLToPath(import.meta.url));
const PKG = join(WEB, 'pkg');
const ROBOT_PKG = join(WEB, 'pkg-robot');
const PICTURE_WIDTH_PX = 900;
/** For wasm and glue of all widgets, brotli −11. */
const BUDGET_BYTES = 1_150_000;

const [dist, profile] = process.argv.slice(2);
if (dist === undefined || profile === undefined) {
  throw new Error('usage: node web/build.mjs DIST PROFILE');
}

const wasm = withoutNames(await readFile(join(PKG, 'slam_web_bg.wasm')));
await wrapGlue();
const glue = await instantiate(wasm);
const schema = JSON.parse(glue.widgetSchemas());
const finished = new Map(schema.map(({ id }) => [id, finish(id)]));
for (const widget of schema) widget.heights = heightTable((width) => finished.get(widget.id).heightAt(width));
await writeFile(join(PKG, 'schema.json'), JSON.stringify(schema));
await writeTypes(schema, join(WEB, 'slam-widget.d.ts'));

await rm(dist, { recursive: true, force: true });
await mkdir(join(dist, 'pictures'), { recursive: true });
for (const { id } of schema) await drawPictures(id);

const robotWasm = withoutNames(await readFile(join(ROBOT_PKG, 'slam_robot_bg.wasm')));
const wasmFile = await writeModule('slam_web', wasm);
const robotWasmFile = await writeModule('slam_robot', robotWasm);
const sampleFiles = await writeSample();
let robotWorker;
const metafiles = await bundle();
await writeNotices(metafiles).catch(endWithOneSentence);
await copyExamples();
await writePackage();
await writeFile(join(dist, 'schema.json'), JSON.stringify(schema, null, 1));
await writeParameterTables(schema, join(WEB, '..', 'docs', 'parameters.md'));
await writeModels(schema, join(WEB, '..', 'widgets', 'src'), join(WEB, '..', 'docs', 'model.md'));
await measure();

/** Writes the glue as a module that exports one function; its arguments stand in place of the globals that eframe uses. */
async function wrapGlue() {
  const text = await readFile(join(PKG, 'slam_web.js'), 'utf8');
  const head = 'export function createGlue(self = globalThis, ResizeObserver = self.ResizeObserver) {';
  await writeFile(join(PKG, 'glue.js'), `${head}\n${text}\nreturn wasm_bindgen;\n}\n`);
  await cp(join(WEB, 'glue.template.d.ts'), join(PKG, 'glue.d.ts'));
}

async function instantiate(bytes) {
  const { createGlue } = await import(pathToFileURL(join(PKG, 'glue.js')).href);
  const core = createGlue();
  core.initSync({ module: bytes });
  return core;
}

/** A widget with default values and all work finished. */
function finish(id) {
  const widget = new glue.Widget(id);
  widget.finish();
  return widget;
}

async function drawPictures(id) {
  const widget = finished.get(id);
  for (const theme of ['light', 'dark']) {
    const svg = widget.picture(PICTURE_WIDTH_PX, theme);
    await writeFile(join(dist, 'pictures', `${id}-${theme}.svg`), svg);
  }
}

/** Writes a module with a build id in its name and content: a cache may serve another build under the same name. */
async function writeModule(name, bytes) {
  const id = hash(bytes);
  const file = `${name}-${id}.wasm`;
  await writeFile(join(dist, file), withBuildId(bytes, id));
  return file;
}

/** The sample for readers without a log: a simulated ring, its ground truth, and a log of another day. */
async function writeSample() {
  const robot = await import(pathToFileURL(join(ROBOT_PKG, 'slam_robot.js')).href);
  robot.initSync({ module: robotWasm });
  const names = ['samples/ring.log', 'samples/ring-truth.tum', 'samples/ring-another-day.log'];
  await mkdir(join(dist, 'samples'), { recursive: true });
  for (const [at, bytes] of robot.sampleFiles().entries()) await writeFile(join(dist, names[at]), bytes);
  return names.map((name) => `./${name}`);
}

/** Bundles the worker into a separate file; its name is a constant of the element. */
async function bundleWorker(shared) {
  const { outputFiles, metafile } = await esbuild.build({
    ...shared,
    entryPoints: [join(WEB, 'ts', 'robot', 'worker.ts')],
    outfile: join(dist, 'slam-robot-worker.js'),
  });
  const [code] = outputFiles.filter((file) => file.path.endsWith('.js'));
  const file = `slam-robot-${hash(code.contents)}.js`;
  await writeFile(join(dist, file), code.contents);
  return { file, metafile, code };
}

async function bundle() {
  const shared = /** @satisfies {esbuild.BuildOptions} */ ({
    bundle: true,
    format: 'esm',
    target: 'es2022',
    minify: profile === 'web',
    sourcemap: profile === 'web' ? false : 'inline',
    define: { WASM_FILE: JSON.stringify(`./${wasmFile}`), BROWSERS: JSON.stringify(oldestBrowsers()), POLICY: JSON.stringify(POLICY) },
    write: false,
    metafile: true,
    legalComments: 'none',
    logLevel: 'warning',
  });
  robotWorker = await bundleWorker(shared);
  const built = await esbuild.build({
    ...shared,
    define: {
      ...shared.define,
      ROBOT_WASM_FILE: JSON.stringify(`./${robotWasmFile}`),
      ROBOT_WORKER_FILE: JSON.stringify(`./${robotWorker.file}`),
      SAMPLE_FILES: JSON.stringify(sampleFiles),
    },
    entryPoints: [join(WEB, 'ts', 'main.ts')],
    outfile: join(dist, 'slam-widget-core.js'),
  });
  const [code] = built.outputFiles.filter((file) => file.path.endsWith('.js'));
  const coreFile = `slam-widget-${hash(code.contents)}.js`;
  await writeFile(join(dist, coreFile), code.contents);
  // Pages load this small file, whose name is stable, and revalidate it each time.
  await writeFile(join(dist, 'slam-widget.js'), `export * from './${coreFile}';\n`);
  const metafiles = [robotWorker.metafile, built.metafile];
  for (const entry of ['embed', 'predict', 'anywidget']) {
    const { metafile } = await esbuild.build({
      ...shared,
      entryPoints: [join(WEB, 'ts', `${entry}.ts`)],
      external: ['./slam-widget.js', './slam-predict.js'],
      outfile: join(dist, `slam-${entry}.js`),
      write: true,
    });
    metafiles.push(metafile);
  }
  const embed = await readFile(join(WEB, 'embed.html'), 'utf8');
  await writeFile(join(dist, 'embed.html'), embed.replace('{browsers}', oldestBrowsers()));
  for (const types of ['slam-widget.d.ts', 'slam-predict.d.ts', 'slam-anywidget.d.ts']) {
    await cp(join(WEB, types), join(dist, types));
  }
  return metafiles;
}

/** Writes the notices for the package; the page, which is built later, reads the same parts. */
async function writeNotices(metafiles) {
  const parts = await partsOfWidgets(metafiles);
  await writePackageNotices(parts, dist);
  await writeFile(join(PKG, 'parts.json'), JSON.stringify(parts));
}

/** Writes the manifest of the npm package, which is `dist/`: `npm pack ./dist`. */
async function writePackage() {
  const source = JSON.parse(await readFile(join(WEB, 'package.json'), 'utf8'));
  for (const key of ['//', 'private', 'engines', 'browserslist', 'scripts', 'devDependencies']) delete source[key];
  await writeFile(join(dist, 'package.json'), `${JSON.stringify(source, null, 2)}\n`);
}

/** Copies the examples, except the slides: they need reveal.js, which the site does not have. */
async function copyExamples() {
  const worksOnSite = (file) => !basename(file).startsWith('reveal');
  await cp(join(WEB, 'examples'), join(dist, 'examples'), { recursive: true, filter: worksOnSite });
}

/** Measures the downloads; the published profile fails above the budget. */
async function measure() {
  const glueBundle = await esbuild.build({
    stdin: { contents: "export { createGlue } from './glue.js';", resolveDir: PKG },
    bundle: true,
    minify: true,
    format: 'esm',
    write: false,
  });
  const files = {
    wasm: await readFile(join(dist, wasmFile)),
    glue: Buffer.from(glueBundle.outputFiles[0].contents),
    // Fetched when a reader opens a log.
    'wasm of the worker': await readFile(join(dist, robotWasmFile)),
    'script of the worker': Buffer.from(robotWorker.code.contents),
  };
  const sizes = {};
  for (const [name, bytes] of Object.entries(files)) {
    sizes[name] = {
      raw: bytes.length,
      gzip: gzipSync(bytes, { level: 9 }).length,
      brotli: profile === 'web' ? brotli(bytes) : null,
    };
  }
  await writeFile(join(PKG, 'sizes.json'), JSON.stringify({ profile, ...sizes }, null, 2));
  if (profile !== 'web') return;
  const total = sizes.wasm.brotli + sizes.glue.brotli;
  console.log(`wasm + glue: ${total} bytes brotli -11, budget ${BUDGET_BYTES}`);
  if (total > BUDGET_BYTES) throw new Error(`${total} bytes are over the budget`);
}

function hash(bytes) {
  return createHash('sha256').update(bytes).digest('hex').slice(0, 12);
}
