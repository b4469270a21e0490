// A worker that runs laps: it gets the program first, then one seed after the other.

import { createGlue } from '../../pkg/glue.js';
import { driven, LEVELS, type Driver, type Order } from './protocol';

let driver: Promise<Driver> | undefined;

self.addEventListener('message', ({ data }: MessageEvent<Order>) => {
  if ('module' in data) driver = start(data.module);
  else void drive(data.seed);
});

async function start(module: WebAssembly.Module): Promise<Driver> {
  const glue = createGlue({ request: () => 0, cancel: () => {}, pixelRatio: () => 1, deviceSize: () => [] });
  await glue({ module_or_path: module });
  return new glue.Laps();
}

async function drive(seed: number): Promise<void> {
  const laps = await driver;
  if (laps === undefined) throw new Error('a seed came before the program');
  self.postMessage(LEVELS.map((_, level) => driven(laps, seed, level)));
}
