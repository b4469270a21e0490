// The peer in JavaScript: `node tests/bench/peer/main.mjs SLAM2D_BENCH [ROUNDS]` checks the port beside
// the reference, times it by turns with our native build, and prints one JSON object.

import * as checks from './check.mjs';
import { native } from '../native.mjs';
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

/** Rounds that nobody counts: the engine compiles what runs often a second time. */
const WARM_UP = 1;
/** What our turn lasts; a run of the port lasts longer. */
const BUDGET_MS = 50;

for (const check of Object.values(checks)) check();
const [program, rounds = '7'] = process.argv.slice(2);
const ours = native(program);
const entries = Object.keys(WORKLOADS).map((id) => ({ id, native: [], javascript: [] }));
for (let round = -WARM_UP; round < Number(rounds); round += 1) {
  for (const entry of entries) {
    const { ms } = await ours.turn(entry.id, BUDGET_MS);
    const start = performance.now();
    WORKLOADS[entry.id]();
    const javascript = performance.now() - start;
    if (round < 0) continue;
    entry.native.push(ms);
    entry.javascript.push(javascript);
  }
}
ours.close();
console.log(JSON.stringify({ runtime: `Node ${process.version}`, workloads: entries }));
