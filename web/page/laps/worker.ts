// A worker that runs laps: it gets the module first, then one seed at a time.

import { createGlue } from '../../pkg/glue.js';
import { runLap, type LapRunner, type Order } from './protocol';

let runner: Promise<LapRunner> | undefined;

self.addEventListener('message', ({ data }: MessageEvent<Order>) => {
  if ('module' in data) runner = start(data.module);
  else void runSeed(data.seed, data.states);
});

async function start(module: WebAssembly.Module): Promise<LapRunner> {
  const glue = createGlue();
  await glue({ module_or_path: module });
  return new glue.LapOutcomes();
}

async function runSeed(seed: number, states: readonly string[]): Promise<void> {
  const laps = await runner;
  if (laps === undefined) throw new Error('a seed came before the module');
  self.postMessage(states.map((state, row) => runLap(laps, seed, row, state)));
}
