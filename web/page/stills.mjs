// Still pictures of the page's figures, drawn in the build by the same code and core.

import { readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

import { build } from 'esbuild';

import { shades } from '../palette.mjs';
import { card } from './card.mjs';
import { GALLERY } from './gallery.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const PKG = path.join(here, '..', 'pkg');
/** Seed of the canonical lap. */
const CANONICAL_SEED = 12648430;

/**
 * Writes `pictures/lap-light.svg` and its dark sister, `pictures/card.png` for links to the site, and those of the small figures. Returns the figures' HTML by name,
 * the lap as the page replays it, as JSON, the first figure: its two sweeps as SVG, where one belongs as JSON,
 * and the walls of the Apartment as SVG in metres.
 */
export async function drawStills(outDir) {
  const core = await instantiate();
  const story = JSON.parse(core.lapStory(CANONICAL_SEED, 1));
  await drawStory('lap', story, outDir);
  const { drawDoubled } = await load('lap/still.ts');
  const picture = card((surface, width) => drawDoubled(story, surface, width), shades('light'));
  await writeFile(path.join(outDir, 'pictures', 'card.png'), picture);
  const building = await readFile(path.join(here, 'building/building.json'), 'utf8');
  await drawStory('building', JSON.parse(building), outDir);
  await drawGallery(core, outDir);
  const { drawing } = await load('match/drawing.ts');
  const scene = JSON.parse(new core.PageMatcher('room').scene());
  return {
    sketches: await drawSketches(core, outDir),
    building,
    story: JSON.stringify(withShortSweeps(story)),
    plan: await drawPlan(story),
    match: { svg: drawing(scene), answer: JSON.stringify({ truth: scene.truth, home: scene.home }) },
  };
}

/** Leaves out the true poses, which the page does not draw, and rounds sweeps, most of the file, to centimetres, a pixel. */
function withShortSweeps(story) {
  const ticks = story.ticks.map(({ truth, sweep, ...tick }) => ({ ...tick, sweep: sweep.map((metres) => Number(metres.toFixed(2))) }));
  return { ...story, ticks };
}

/** The walls of the lap's world, in metres that point up. */
async function drawPlan({ walls: segments }) {
  const [{ ground, walls }, { inMetres, METRES }] = await Promise.all(['world/plan.ts', 'world/svg.ts'].map(load));
  const ends = segments.map(([x0, y0, x1, y1]) => [[x0, y0], [x1, y1]]);
  return inMetres((surface) => {
    ground(surface, METRES, ends);
    walls(surface, METRES, ends);
  });
}

async function drawStory(name, story, outDir) {
  const { still } = await load(`${name}/still.ts`);
  for (const theme of ['light', 'dark']) {
    await writeFile(path.join(outDir, 'pictures', `${name}-${theme}.svg`), still(story, shades(theme)));
  }
}

/** Draws a picture of each lap of the gallery, for both themes. */
async function drawGallery(core, outDir) {
  const { drawing } = await load('gallery/drawing.ts');
  for (const { id, state } of GALLERY) {
    const widget = new core.Widget('w16.2');
    for (const [name, text] of new URLSearchParams(state)) widget.set(name, text);
    widget.finish();
    const { facts } = JSON.parse(widget.outcome());
    await writeFile(path.join(outDir, 'pictures', `break-${id}.svg`), drawing(JSON.parse(widget.tables()), facts));
  }
}

/** Draws the initial state of each small figure for both themes and both widths; returns its HTML by name. */
async function drawSketches(core, outDir) {
  const { NARROW, WIDTHS, formatValue } = await load('sketch.ts');
  const html = new Map();
  for (const sketch of JSON.parse(core.sketchSchemas())) {
    const sizes = {};
    let says = '';
    for (const [width, pixels] of Object.entries(WIDTHS)) {
      for (const theme of ['light', 'dark']) {
        const { svg, sentence } = JSON.parse(core.drawSketch(sketch.name, sketch.default, pixels, theme));
        await writeFile(path.join(outDir, 'pictures', `${sketch.name}-${width}-${theme}.svg`), svg);
        sizes[width] = svg.match(/ width="\d+" height="\d+"/)[0];
        says = sentence;
      }
    }
    const source = (width, theme, media) =>
      `<source media="${media}" srcset="pictures/${sketch.name}-${width}-${theme}.svg"${sizes[width]}>`;
    const value = formatValue(sketch, sketch.default);
    html.set(sketch.name, `<div class="sketch-picture"><picture>
      ${source('narrow', 'dark', `${NARROW} and (prefers-color-scheme: dark)`)}
      ${source('narrow', 'light', NARROW)}
      ${source('wide', 'dark', '(prefers-color-scheme: dark)')}
      <img src="pictures/${sketch.name}-wide-light.svg"${sizes.wide} alt="${sketch.title}. ${says}" loading="lazy">
    </picture></div>
    <label class="sketch-slider"><span>${sketch.label}</span>
      <input type="range" disabled min="${sketch.min}" max="${sketch.max}" step="${sketch.step}" value="${sketch.default}"
        aria-valuetext="${value}"><output>${value}</output></label>
    <p class="sketch-says" role="status">${says}</p>`);
  }
  return html;
}

/** Bundles and imports a TypeScript module of the page. */
async function load(file) {
  const { outputFiles } = await build({
    entryPoints: [path.join(here, file)],
    bundle: true,
    format: 'esm',
    write: false,
    logLevel: 'warning',
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
}

async function instantiate() {
  const { createGlue } = await import(pathToFileURL(path.join(PKG, 'glue.js')).href);
  const core = createGlue();
  core.initSync({ module: await readFile(path.join(PKG, 'slam_web_bg.wasm')) });
  return core;
}
