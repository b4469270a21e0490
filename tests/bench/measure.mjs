// Measures the workloads in turns, natively and as WebAssembly in Node and in Chromium: `node
// tests/bench/measure.mjs SLAM2D_BENCH FOLDER [ROUNDS] [MILLISECONDS] [ID,ID]`. FOLDER contains wasm-pack's
// output; the result is JSON on standard output.

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launchForTimes } from '../browser/chromium.mjs';
import { native } from './native.mjs';

/** Rounds that do not count, because an engine recompiles frequently used code with more optimization. */
const WARM_UP = 3;

const [program, folder, rounds = '15', budgetMs = '25', only] = process.argv.slice(2);
const glue = join(resolve(folder), 'slam2d_bench.js');
const module = readFileSync(join(folder, 'slam2d_bench_bg.wasm'));

/** Each engine runs a workload for some milliseconds and returns the time; one at a time. */
const engines = { native: native(program), node: await inNode(), chromium: await inChromium() };
try {
  console.log(JSON.stringify(await measure()));
} finally {
  for (const { close } of Object.values(engines)) await close();
}

async function measure() {
  const all = JSON.parse(execFileSync(program, ['names'], { encoding: 'utf8' }));
  const names = all.filter((id) => !only || only.split(',').includes(id));
  const nothing = () => ({ ms: [], digest: '' });
  const entries = names.map((id) => ({ id, native: nothing(), node: nothing(), chromium: nothing() }));
  for (let round = -WARM_UP; round < Number(rounds); round += 1) {
    for (const entry of entries) {
      for (const [name, engine] of Object.entries(engines)) {
        const { ms, digest } = await engine.turn(entry.id, Number(budgetMs));
        if (round < 0) continue;
        entry[name].ms.push(ms);
        entry[name].digest = digest;
      }
    }
  }
  return entries;
}

async function inNode() {
  const exports = await import(pathToFileURL(glue));
  exports.initSync({ module });
  return { turn: (id, ms) => JSON.parse(exports.turn(id, ms)), close() {} };
}

async function inChromium() {
  const files = {
    '/': ['text/html', '<!doctype html><title>Bench</title>'],
    '/glue.js': ['text/javascript', readFileSync(glue)],
    '/slam2d_bench_bg.wasm': ['application/wasm', module],
  };
  const server = createServer(({ url }, response) => {
    const [type, body] = files[url] ?? ['text/plain', ''];
    response.setHeader('Content-Type', type);
    // An isolated page has a clock of 5 µs, any other one of 100.
    response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
    response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
    response.end(body);
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  const browser = await launchForTimes();
  const page = await browser.newPage();
  await page.goto(`http://localhost:${server.address().port}/`);
  await page.evaluate(async () => {
    window.glue = await import('/glue.js');
    await glue.default();
  });
  return {
    turn: async (id, ms) => JSON.parse(await page.evaluate(([id, ms]) => glue.turn(id, ms), [id, ms])),
    async close() {
      await browser.close();
      server.close();
    },
  };
}
