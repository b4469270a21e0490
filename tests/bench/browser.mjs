// Measures the workloads as WebAssembly in Chromium: `node tests/bench/browser.mjs FOLDER [SECONDS]`.
// FOLDER holds what wasm-pack built; the answer is JSON on standard output.

import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { launch } from '../browser/harness.mjs';

const [folder, seconds = '0.5'] = process.argv.slice(2);
const files = {
  '/': ['text/html', '<!doctype html><title>Bench</title>'],
  '/glue.js': ['text/javascript', readFileSync(join(folder, 'slam2d_bench.js'))],
  '/slam2d_bench_bg.wasm': ['application/wasm', readFileSync(join(folder, 'slam2d_bench_bg.wasm'))],
};
const server = createServer(({ url }, response) => {
  const [type, body] = files[url] ?? ['text/plain', ''];
  response.setHeader('Content-Type', type);
  response.end(body);
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));

const browser = await launch();
try {
  const page = await browser.newPage();
  await page.goto(`http://localhost:${server.address().port}/`);
  const measured = await page.evaluate(async (budget) => {
    const glue = await import('/glue.js');
    await glue.default();
    // A browser compiles what runs often a second time, and better, while it runs; and a window
    // that has just opened loads the browser's own parts on the same cores.
    glue.measure_all(budget / 2);
    return glue.measure_all(budget);
  }, Number(seconds));
  console.log(measured);
} finally {
  await browser.close();
  server.close();
}
