// Measures the first frame of each widget in Chromium, beside a bare canvas with the same WebGL start:
// `node tests/bench/first_frame.mjs [PAGE.md] [ROUNDS]`. Prints a table, and writes it into the page.

import { writeGeneratedBlock } from '../../web/generated-block.mjs';
import { launchForTimes } from '../browser/chromium.mjs';
import { bare, schema, serve } from '../browser/harness.mjs';
import { machine, quantile } from './in_chromium.mjs';

/** The project's limit from the navigation to the first frame of a widget. */
const LIMIT_MS = 1500;

const [page, rounds = '7'] = process.argv.slice(2);

/** The lower bound for any widget: a context, one program, one triangle, in the next frame. */
const BARE_CANVAS = `<!doctype html><html lang="en"><title>Bare</title><link rel="icon" href="data:,">
<canvas width="1098" height="700"></canvas><script type="module">
  const gl = document.querySelector('canvas').getContext('webgl2');
  const program = gl.createProgram();
  for (const [type, source] of [
    [gl.VERTEX_SHADER, 'attribute vec2 at; void main() { gl_Position = vec4(at, 0.0, 1.0); }'],
    [gl.FRAGMENT_SHADER, 'void main() { gl_FragColor = vec4(0.2, 0.4, 0.8, 1.0); }'],
  ]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 3, -1, -1, 3]), gl.STATIC_DRAW);
  const at = gl.getAttribLocation(program, 'at');
  gl.enableVertexAttribArray(at);
  gl.vertexAttribPointer(at, 2, gl.FLOAT, false, 0, 0);
  requestAnimationFrame(() => {
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    window.readyMs = performance.now();
  });
</script></html>`;
const WATCH = '<script>document.addEventListener("slam-ready", () => (window.readyMs ??= performance.now()));</script>';

const pages = { '/bare.html': BARE_CANVAS };
for (const { id } of schema) pages[`/${id}.html`] = bare(`<slam-widget name="${id}"></slam-widget>`, WATCH);

const times = await measure(Object.keys(pages), Number(rounds));
const text = table(times);
console.log(text);
if (page !== undefined) await writeGeneratedBlock(page, 'first frame', text);

/** Milliseconds from the navigation to the first frame, of each page in turns. */
async function measure(paths, count) {
  const server = await serve({ pages });
  const browser = await launchForTimes();
  const found = new Map(paths.map((path) => [path, []]));
  try {
    const context = await browser.newContext({ viewport: { width: 1100, height: 900 } });
    const tab = await context.newPage();
    const devTools = await context.newCDPSession(tab);
    await devTools.send('Network.enable');
    await devTools.send('Network.setCacheDisabled', { cacheDisabled: true });
    // A new window still loads parts of the browser: the first round does not count.
    for (let round = 0; round <= count; round += 1) {
      for (const path of paths) {
        await tab.goto('about:blank');
        await tab.goto(server.url + path);
        await tab.waitForFunction(() => window.readyMs !== undefined, undefined, { timeout: 0 });
        if (round > 0) found.get(path).push(await tab.evaluate(() => readyMs));
      }
    }
  } finally {
    await browser.close();
    await server.close();
  }
  return found;
}

function table(found) {
  const reference = found.get('/bare.html');
  const rows = [...found].map(([path, ms]) => {
    const isBare = path === '/bare.html';
    const what = isBare ? 'a bare canvas: one program, one triangle' : path.slice(1, -'.html'.length);
    // Round by round, because background load affects both alike.
    const over = median(ms.map((time, round) => time - reference[round]));
    const cells = [what, ...[Math.min(...ms), median(ms)].map(told), isBare ? '–' : told(over), isBare ? '–' : told(LIMIT_MS)];
    return `| ${cells.join(' | ')} |`;
  });
  return [
    `Measured on ${machine()}, ${rounds} rounds.`,
    '',
    '| page | fastest | median | over the bare canvas | limit |',
    '|---|--:|--:|--:|--:|',
    ...rows,
  ].join('\n');
}

function median(values) {
  return quantile(values, 0.5);
}

function told(ms) {
  return `${Math.round(ms)} ms`;
}
