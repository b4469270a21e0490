// Measures the script time of a frame in Chromium while a slider changes in every frame: `node
// tests/bench/changing.mjs [PAGE.md] [FRAMES]`. Prints a table, and writes it into the page.

import { writeGeneratedBlock } from '../../web/generated-block.mjs';
import { launchForTimes } from '../browser/chromium.mjs';
import { bare, schema, serve } from '../browser/harness.mjs';
import { machine, quantile } from './in_chromium.mjs';

/** The project's own limit: a frame of a display at 60 Hz. */
const LIMIT_MS = 16;
/** Widgets whose laps take longer than a frame, and the slider that requests another one. */
const SLIDERS = [['w16.2', 'noise'], ['w16.4', 'noise']];

const [page, frames = '200'] = process.argv.slice(2);

/** Runs before the page's own scripts: sums up the time of frame callbacks. */
const WATCH = `<script>
  window.scriptMs = 0;
  window.nextFrame = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => nextFrame((now) => {
    const before = performance.now();
    callback(now);
    scriptMs += performance.now() - before;
  });
</script>`;

const text = table(await measure(Number(frames)));
console.log(text);
if (page !== undefined) await writeGeneratedBlock(page, 'changing', text);

/** The script time of each frame in which the slider's value changes, ms, for each slider. */
async function measure(count) {
  const pages = {};
  for (const [id] of SLIDERS) pages[`/${id}.html`] = bare(`<slam-widget name="${id}"></slam-widget>`, WATCH);
  const server = await serve({ pages });
  const browser = await launchForTimes();
  const rows = [];
  try {
    const context = await browser.newContext({ viewport: { width: 1100, height: 900 } });
    const tab = await context.newPage();
    for (const [id, parameter] of SLIDERS) {
      await tab.goto(`${server.url}/${id}.html`);
      await tab.waitForFunction(() => document.querySelector('slam-widget').state === 'running');
      const { min, max, step } = schema.find((widget) => widget.id === id).params.find((param) => param.id === parameter);
      // A first run without measurement, because the browser compiles code on first use.
      await tab.evaluate(drag, { parameter, min, max, step, count });
      rows.push([`${parameter} of ${id}`, await tab.evaluate(drag, { parameter, min, max, step, count })]);
    }
  } finally {
    await browser.close();
    await server.close();
  }
  return rows;
}

/** In the page: back and forth over the whole slider, a step per frame. */
function drag({ parameter, min, max, step, count }) {
  const widget = document.querySelector('slam-widget');
  const steps = Math.round((max - min) / step);
  const found = [];
  return new Promise((resolve) => {
    const frame = (at) => {
      if (at > 0) found.push(scriptMs);
      if (at === count) {
        resolve(found);
        return;
      }
      scriptMs = 0;
      const before = performance.now();
      const to = at % (2 * steps);
      widget.set(parameter, min + step * Math.min(to, 2 * steps - to));
      scriptMs += performance.now() - before;
      nextFrame(() => frame(at + 1));
    };
    nextFrame(() => frame(0));
  });
}

function table(rows) {
  const told = (ms) => `${ms.toFixed(1)} ms`;
  const cells = rows.map(([what, ms]) => {
    const times = [0.5, 0.9, 0.99].map((share) => told(quantile(ms, share)));
    return `| ${[what, ...times, ms.filter((one) => one > LIMIT_MS).length].join(' | ')} |`;
  });
  return [
    `Measured on ${machine()}, ${frames} frames each.`,
    '',
    `| slider | median | 90 % | 99 % | above ${LIMIT_MS} ms |`,
    '|---|--:|--:|--:|--:|',
    ...cells,
  ].join('\n');
}
