// Runs many laps without blocking the page: on workers or, if there are none, one lap at a time between frames.

import { driven, LEVELS, type Driver, type Lap } from './protocol';

/** More would heat the machine for little. */
const MOST_WORKERS = 4;

/** Set by the build: the worker's name holds a hash of its content. */
declare const LAPS_WORKER_FILE: string;

export interface Core {
  module(): Promise<WebAssembly.Module>;
  driver(): Promise<Driver>;
}

export class Pool {
  readonly #core: Core;
  readonly #last: number;
  readonly #told: (laps: Lap[]) => void;
  #next = 1;
  #isOn = false;
  #isReady = false;
  #workers: Worker[] = [];
  #idle: Worker[] = [];
  /** Seeds that a worker has and has not answered. */
  readonly #asked = new Map<Worker, number>();
  #returned: number[] = [];
  #slices: Promise<void> | undefined;

  /** Will drive the seeds from 1 to `last` at every level, and tell the laps of each. */
  constructor(core: Core, last: number, told: (laps: Lap[]) => void) {
    this.#core = core;
    this.#last = last;
    this.#told = told;
  }

  /** Goes on, or rests: what is under way is finished. */
  turn(isOn: boolean): void {
    this.#isOn = isOn;
    if (!isOn) return;
    if (!this.#isReady) void this.#begin();
    else this.#handOut();
  }

  async #begin(): Promise<void> {
    this.#isReady = true;
    const module = await this.#core.module();
    const count = Math.min(Math.max((navigator.hardwareConcurrency ?? 2) - 1, 1), MOST_WORKERS);
    try {
      for (let made = 0; made < count; made += 1) this.#hire(module);
    } catch {
      // A page in a sandbox gets no workers.
    }
    this.#handOut();
  }

  #hire(module: WebAssembly.Module): void {
    const worker = new Worker(new URL(LAPS_WORKER_FILE, import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }: MessageEvent<Lap[]>) => {
      this.#asked.delete(worker);
      this.#told(data);
      this.#idle.push(worker);
      this.#handOut();
    });
    worker.addEventListener('error', () => this.#dismiss(worker));
    worker.postMessage({ module });
    this.#workers.push(worker);
    this.#idle.push(worker);
  }

  /** It could not start, or broke: its seed goes to another one. */
  #dismiss(worker: Worker): void {
    const seed = this.#asked.get(worker);
    if (seed !== undefined) this.#returned.push(seed);
    this.#asked.delete(worker);
    this.#workers = this.#workers.filter((other) => other !== worker);
    this.#idle = this.#idle.filter((other) => other !== worker);
    worker.terminate();
    this.#handOut();
  }

  #handOut(): void {
    if (!this.#isOn) return;
    if (this.#workers.length === 0) {
      this.#slices ??= this.#slice().finally(() => (this.#slices = undefined));
      return;
    }
    for (let worker = this.#idle.pop(); worker !== undefined; worker = this.#idle.pop()) {
      const seed = this.#take();
      if (seed === undefined) {
        if (this.#asked.size === 0) this.#retire();
        return;
      }
      this.#asked.set(worker, seed);
      worker.postMessage({ seed });
    }
  }

  #take(): number | undefined {
    const again = this.#returned.pop();
    if (again !== undefined) return again;
    if (this.#next > this.#last) return undefined;
    this.#next += 1;
    return this.#next - 1;
  }

  /** All is driven: memory goes back. */
  #retire(): void {
    for (const worker of this.#workers) worker.terminate();
    this.#isOn = false;
  }

  async #slice(): Promise<void> {
    const driver = await this.#core.driver();
    while (this.#isOn) {
      const seed = this.#take();
      if (seed === undefined) return;
      const laps: Lap[] = [];
      for (let level = 0; level < LEVELS.length; level += 1) {
        // After a frame has been painted, not before.
        await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
        laps.push(driven(driver, seed, level));
      }
      this.#told(laps);
    }
  }
}
