// Builds the pages of the companion in one directory: HTML with formulas as HTML and MathML, style, scripts, KaTeX's style
// and fonts, typefaces, and the page of licences and notices. Pages load nothing from other hosts.
//
//     node web/page/build.mjs <out-dir>

import { createHash } from 'node:crypto';
import { existsSync, readFileSync } from 'node:fs';
import { cp, mkdir, readFile, readdir, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

import { build } from 'esbuild';
import katex from 'katex';

import { oldestBrowsers } from '../browsers.mjs';
import { escapeHtml, withPolicy } from '../html.mjs';
import { endWithOneSentence } from '../licences/allowed.mjs';
import { partsOfPage, writeNoticesPage } from '../licences/notices.mjs';
import { colorStyle } from '../palette.mjs';
import { FONT_PRELOADS, copyFonts } from './fonts.mjs';
import { foldExercises, frameExercises, readExercises } from './exercises.mjs';
import { addGallery } from './gallery.mjs';
import { addListings } from './listings.mjs';
import { placesOf, readPages, withFrame } from './pages.mjs';
import { slidesPage } from './slides.mjs';
import { drawStills } from './stills.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const root = path.join(here, '..', '..');

const [outDir] = process.argv.slice(2);
if (outDir === undefined) {
  console.error('usage: node web/page/build.mjs <out-dir>');
  process.exit(2);
}

await mkdir(outDir, { recursive: true });
const pages = await readPages(root);
const places = placesOf(pages);
const source = pages.map(({ html }) => html).join('');
const exercises = readExercises(source);
// `ch16-mark` marks by the same questions.
await writeFile(path.join(root, 'teaching/mark/src/exercises.json'), `${JSON.stringify(exercises, null, 1)}\n`);
const frames = frameExercises(source, (html) => renderFormulas(html, 'mathml'));
await writeFile(path.join(outDir, 'exercises.json'), JSON.stringify(frames));
const scripts = await readFile(path.join(root, 'teaching/guide/widgets.md'), 'utf8');
const specOf = await widgetSpecs();
const template = (await readFile(path.join(here, 'template.html'), 'utf8')).replace('{fonts}', FONT_PRELOADS);
const pictured = pages.map((page) => ({ ...page, html: addPictures(renderFormulas(withFrame(template, page, pages, places)), page.source) }));
const { sketches, story, match, building, plan } = await drawStills(outDir);
const { names, metafiles } = await bundleScripts({
  LAP_STORY: story,
  BUILDING_FILE: `./${await writeHashed('building.json', building)}`,
  MATCH_ANSWER: match.answer,
});
const fonts = await copyFonts(outDir);
names.set('page.css', await copyStyle());
names.set('slides.css', await writeHashed('slides.css', fonts + (await style('slides.css'))));
const slides = slidesPage(pages, scripts, frames, (html) => renderFormulas(html));
await writeFile(path.join(outDir, 'slides.html'), withPolicy(withNames(slides)));
await cp(path.join(here, 'write/your-code.html'), path.join(outDir, 'your-code.html'));
await Promise.all([...pictured.map(renderPage), copyKatex()]);
await writeNotices(metafiles).catch(endWithOneSentence);

async function renderPage({ file, source, html }) {
  const page = await addListings(addSketches(addDrawings(addStills(addGallery(foldExercises(html)))), sketches, source), root);
  await writeFile(path.join(outDir, file), withPolicy(withNames(await addPreloads(page))));
}

/** Names in the head what scripts request later, in the order in which a reader needs it: the lap, then the widgets. */
async function addPreloads(html) {
  const element = (await readFile(path.join(outDir, 'slam-widget.js'), 'utf8')).match(/slam-widget-\w+\.js/)[0];
  const widgets = html.replace('</head>', `<link rel="modulepreload" href="${element}" fetchpriority="low">\n</head>`);
  return widgets.replace(/<figure class="lap"[\s\S]*?<\/figure>/, (figure) => `${figure}\n  <script src="lap.js"></script>`)
    .replace(/<link rel="preload"(?=[\s\S]*<figure class="lap")/, (first) => `<link rel="preload" href="lap.js" as="script" fetchpriority="high">\n${first}`);
}

/** Replaces the names of sources by those with a hash. */
function withNames(html) {
  return html.replace(/((?:href|src)=")([a-z]+\.(?:css|js))"/g, (whole, before, name) => {
    return names.has(name) ? `${before}${names.get(name)}"` : whole;
  });
}

/** Writes a file under a name with a hash of its content, which a browser may cache for ever; returns that name. */
async function writeHashed(name, content) {
  const { name: stem, ext } = path.parse(name);
  const hashed = `${stem}-${createHash('sha256').update(content).digest('hex').slice(0, 12)}${ext}`;
  await writeFile(path.join(outDir, hashed), content);
  return hashed;
}

/** The schema of each widget by its id, which web/build.mjs writes. */
async function widgetSpecs() {
  const file = path.join(outDir, 'schema.json');
  if (!existsSync(file)) throw new Error(`${file} is missing: run node web/build.mjs first, which draws the pictures`);
  const widgets = JSON.parse(await readFile(file, 'utf8'));
  return new Map(widgets.map((widget) => [widget.id, widget]));
}

/** Adds the fallback content of widgets without scripts; the element hides it once it is defined. */
function addPictures(html, source) {
  return html.replace(/(<slam-widget\b[^>]*>)\s*(<\/slam-widget>)/g, (_, open, close) => {
    const id = open.match(/\bname="([^"]*)"/)?.[1];
    const spec = specOf.get(id);
    if (spec === undefined) {
      throw new Error(`${source} has a widget ${id}, which does not exist: the widgets are ${[...specOf.keys()].join(', ')}`);
    }
    return `${open}
    <picture>
      <source media="(prefers-color-scheme: dark)" srcset="pictures/${id}-dark.svg">
      <img src="pictures/${id}-light.svg" ${sizeOf(`${id}-light.svg`)} alt="${escapeHtml(spec.summary)}" loading="lazy">
    </picture>
    <p>This is a still picture of “${escapeHtml(spec.title)}”: the widget needs JavaScript and WebAssembly, in ${oldestBrowsers()} or later.</p>
  ${close}`;
  });
}

/** The attributes by which a page reserves the place of a picture that has not arrived. */
function sizeOf(picture) {
  return readFileSync(path.join(outDir, 'pictures', picture), 'utf8').match(/width="[0-9.]+" height="[0-9.]+"/)[0];
}

/** Adds the still pictures of figures, shown until their scripts start: `<img data-still="lap" alt="…">`. */
function addStills(html) {
  return html.replace(/<img data-still="([a-z]+)"([^>]*)>/g, (_, name, rest) => `<picture>
      <source media="(prefers-color-scheme: dark)" srcset="pictures/${name}-dark.svg">
      <img src="pictures/${name}-light.svg"${rest}>
    </picture>`);
}

/** Adds the SVG of the matcher, and the walls of the Apartment. */
function addDrawings(html) {
  return html.replace('<div class="match-picture" data-drawing="match">', (open) => `${open}${match.svg}`)
    .replace('<g data-drawing="plan">', (open) => `${open}${plan}`);
}

/** Fills the small figures with their initial state: `<figure class="drawing sketch" data-sketch="gate">`. */
function addSketches(html, sketches, source) {
  return html.replace(/<figure [^>]*data-sketch="([a-z]+)"[^>]*>/g, (open, name) => {
    const sketch = sketches.get(name);
    if (sketch === undefined) {
      throw new Error(`${source} has a figure ${name}, which does not exist: the figures are ${[...sketches.keys()].join(', ')}`);
    }
    return `${open}\n    ${sketch}`;
  });
}

/**
 * Renders inline formulas, `<tex>…</tex>`, and display formulas, `<tex display>…</tex>`.
 *
 * @param {string} html
 * @param {katex.KatexOptions['output']} output
 */
function renderFormulas(html, output = 'htmlAndMathml') {
  return html.replace(/(\(?)<tex( display)?>([\s\S]*?)<\/tex>((?:&nbsp;[^\s<.,;:]+|[.,;:?!)°])*)/g, (_, before, display, escaped, after) => {
    const formula = katex.renderToString(dropFigureNames(unescapeHtml(escaped)), {
      displayMode: display !== undefined,
      output,
      throwOnError: true,
      strict: 'error',
    });
    if (display !== undefined) {
      return `${before}<div class="math" role="group" aria-label="Formula">${formula}</div>${after}`;
    }
    // Keeps brackets, units and punctuation on the line of the formula.
    const text = `${before}${formula}${after}`;
    return text === formula ? formula : `<span class="unbroken">${text}</span>`;
  });
}

/** `\fig{name}{text}` prints the text; a test compares it with the figure `name`. */
function dropFigureNames(tex) {
  return tex.replace(/\\fig\{[^{}]*\}\{([^{}]*)\}/g, '{$1}');
}

function unescapeHtml(text) {
  return text.replaceAll('&lt;', '<').replaceAll('&gt;', '>').replaceAll('&amp;', '&');
}

/** Writes the style with the colours, and copies the linked table. Returns the name of the style. */
async function copyStyle() {
  await cp(path.join(here, 'thousand-laps.csv'), path.join(outDir, 'thousand-laps.csv'));
  return writeHashed('page.css', colorStyle() + fonts + (await style('page.css')));
}

/** A style sheet with those that it imports. */
async function style(source) {
  const { outputFiles } = await build({ entryPoints: [path.join(here, source)], bundle: true, minify: true, write: false });
  return outputFiles[0].text;
}

/** Copies KaTeX with woff2 fonts only: all browsers with WebAssembly support them. */
async function copyKatex() {
  const dist = path.dirname(createRequire(import.meta.url).resolve('katex'));
  const target = path.join(outDir, 'katex');
  await mkdir(path.join(target, 'fonts'), { recursive: true });
  const style = await readFile(path.join(dist, 'katex.min.css'), 'utf8');
  const woff2Only = style.replace(/,url\([^)]*\.(?:woff|ttf)\) format\("(?:woff|truetype)"\)/g, '');
  await writeFile(path.join(target, 'katex.css'), woff2Only);
  await cp(path.join(dist, 'fonts'), path.join(target, 'fonts'), {
    recursive: true,
    filter: (source) => path.extname(source) === '' || source.endsWith('.woff2'),
  });
}

/** Bundles the scripts of the page and of its worker; returns their names and esbuild's metafiles. */
async function bundleScripts({ LAP_STORY, BUILDING_FILE, MATCH_ANSWER }) {
  const bundle = async (source, define, /** @type {import('esbuild').Format} */ format = 'esm', globalName = undefined, minify = true) => {
    const { outputFiles, metafile } = await build({
      entryPoints: [path.join(here, source)],
      // Comments of the marking's script name its sources, from here.
      absWorkingDir: root,
      bundle: true,
      external: ['./slam-widget.js', './write-yourself.js'],
      define,
      write: false,
      metafile: true,
      format,
      globalName,
      minify,
      target: 'es2022',
      logLevel: 'warning',
    });
    return { text: outputFiles[0].contents, metafile };
  };
  const worker = await bundle('laps/worker.ts', {});
  const workerFile = await writeHashed('laps-worker.js', worker.text);
  const widgets = (await readdir(outDir)).find((name) => /^slam_web-\w+\.wasm$/.test(name));
  const lap = await bundle('lap.ts', { LAP_STORY: JSON.stringify(LAP_STORY), WIDGETS_FILE: JSON.stringify(widgets) }, 'iife');
  const page = await bundle('page.ts', {
    BUILDING_FILE: JSON.stringify(BUILDING_FILE),
    MATCH_ANSWER,
    PLACES: JSON.stringify(places),
    LAPS_WORKER_FILE: JSON.stringify(`./${workerFile}`),
  });
  // A classic script in the head, which the browser runs before it paints.
  const early = await bundle('early.ts', { BROWSERS: JSON.stringify(oldestBrowsers()) }, 'iife');
  const slides = await bundle('slides.ts', {});
  // A stable name: the page imports it when a reader opens an editor.
  // `ch16-mark` runs the same tests. Readable, because it is committed.
  const marking = await bundle('write/marking.ts', {}, 'iife', undefined, false);
  await writeFile(path.join(root, 'teaching/mark/src/written.js'), marking.text);
  const core = await bundle('write/core-worker.ts', { 'import.meta.url': '""' }, 'iife', '__slamCore');
  const writing = await bundle('write/write-yourself.ts', {
    WRITE_WORKER_FILE: JSON.stringify(`./${await writeHashed('write-worker.js', core.text)}`),
  });
  await writeFile(path.join(outDir, 'write-yourself.js'), writing.text);
  const names = new Map([
    ['page.js', await writeHashed('page.js', page.text)],
    ['lap.js', await writeHashed('lap.js', lap.text)],
    ['early.js', await writeHashed('early.js', early.text)],
    ['slides.js', await writeHashed('slides.js', slides.text)],
  ]);
  return { names, metafiles: [worker.metafile, page.metafile, lap.metafile, early.metafile, core.metafile, writing.metafile, slides.metafile] };
}

/** Writes the notices of the widgets, from their build, and of the page. */
async function writeNotices(metafiles) {
  const ofWidgets = JSON.parse(await readFile(path.join(root, 'web', 'pkg', 'parts.json'), 'utf8'));
  await writeNoticesPage([...ofWidgets, ...(await partsOfPage(metafiles))], outDir, names.get('page.css'));
}
