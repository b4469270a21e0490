// The peer in JavaScript: `node tests/bench/peer/main.mjs [SECONDS_EACH]` checks the port beside the
// reference, times it, and prints one JSON object on standard output.

import * as checks from './check.mjs';
import { simulate } from './drive.mjs';
import { Slam } from './lap.mjs';
import { BasinScene, TerrainScene } from './scenes.mjs';

const SEED = 0xc0ffee;

const terrain = new TerrainScene('room');

/** The workloads, by the names that `slam2d_bench` gives to its own. */
const WORKLOADS = {
  lap() {
    const drive = simulate(SEED, 1);
    return [true, false].map((loops) => new Slam(drive, { loops }).run());
  },
  'sweep-p2p': () => new BasinScene().sweep('point-to-point'),
  'sweep-p2l': () => new BasinScene().sweep('point-to-plane'),
  'terrain-49': () => terrain.terrain({ n: 49, span: 1.3, tau: 0.6 }),
};

/** The median of as many runs as fit into the budget, three at least, in milliseconds. */
function median(work, budget) {
  const samples = [];
  const started = performance.now();
  while (samples.length < 3 || performance.now() - started < budget) {
    const start = performance.now();
    work();
    samples.push(performance.now() - start);
  }
  samples.sort((a, b) => a - b);
  return samples[Math.floor(samples.length / 2)];
}

for (const check of Object.values(checks)) check();
const budget = 1000 * Number(process.argv[2] ?? 3);
const measured = Object.entries(WORKLOADS).map(([id, work]) => {
  // Half of the budget is for the engine, which compiles what runs often a second time.
  median(work, budget / 2);
  return { id, median_ms: median(work, budget) };
});
console.log(JSON.stringify({ runtime: `Node ${process.version}`, workloads: measured }));
