// A pool of workers that run laps. Without workers it runs one lap at a time between frames on the main thread.

import { runLap, type LapRunner, type Lap } from './protocol';

/** More workers heat the machine and save little time. */
const MAX_WORKERS = 4;

/** Set by the build: the worker's file, with a hash of its content in the name. */
declare const LAPS_WORKER_FILE: string;

export interface Core {
  module(): Promise<WebAssembly.Module>;
  runner(): Promise<LapRunner>;
}

export class WorkerPool {
  readonly #core: Core;
  readonly #lastSeed: number;
  readonly #states: readonly string[];
  readonly #onLaps: (laps: Lap[]) => void;
  #nextSeed = 1;
  #isActive = false;
  #hasStarted = false;
  #workers: Worker[] = [];
  #idle: Worker[] = [];
  /** The seed that each busy worker runs. */
  readonly #assigned = new Map<Worker, number>();
  /** Seeds of workers that failed. */
  #retries: number[] = [];
  #mainThread: Promise<void> | undefined;
  #isClosed = false;

  /** Runs the seeds from 1 to `lastSeed` in every state of w16.2 once active; `onLaps` gets the laps of each seed. */
  constructor(core: Core, lastSeed: number, states: readonly string[], onLaps: (laps: Lap[]) => void) {
    this.#core = core;
    this.#lastSeed = lastSeed;
    this.#states = states;
    this.#onLaps = onLaps;
  }

  /** Resumes or pauses; running laps are finished. */
  setActive(isActive: boolean): void {
    this.#isActive = isActive && !this.#isClosed;
    if (!this.#isActive) return;
    // Without the program the figure stays as it is, and the widgets report why.
    if (!this.#hasStarted) void this.#start().catch(() => this.close());
    else this.#schedule();
  }

  async #start(): Promise<void> {
    this.#hasStarted = true;
    const module = await this.#core.module();
    if (this.#isClosed) return;
    const count = Math.min(Math.max((navigator.hardwareConcurrency ?? 2) - 1, 1), MAX_WORKERS);
    try {
      for (let started = 0; started < count; started += 1) this.#addWorker(module);
    } catch {
      // A sandboxed page may start no workers.
    }
    this.#schedule();
  }

  #addWorker(module: WebAssembly.Module): void {
    const worker = new Worker(new URL(LAPS_WORKER_FILE, import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }: MessageEvent<Lap[]>) => {
      this.#assigned.delete(worker);
      this.#onLaps(data);
      this.#idle.push(worker);
      this.#schedule();
    });
    worker.addEventListener('error', () => this.#removeWorker(worker));
    worker.postMessage({ module });
    this.#workers.push(worker);
    this.#idle.push(worker);
  }

  /** Removes a worker that failed; its seed is retried. */
  #removeWorker(worker: Worker): void {
    const seed = this.#assigned.get(worker);
    if (seed !== undefined) this.#retries.push(seed);
    this.#assigned.delete(worker);
    this.#workers = this.#workers.filter((other) => other !== worker);
    this.#idle = this.#idle.filter((other) => other !== worker);
    worker.terminate();
    this.#schedule();
  }

  #schedule(): void {
    if (!this.#isActive) return;
    if (this.#workers.length === 0) {
      this.#mainThread ??= this.#runOnMainThread().catch(() => this.close()).finally(() => (this.#mainThread = undefined));
      return;
    }
    for (let worker = this.#idle.pop(); worker !== undefined; worker = this.#idle.pop()) {
      const seed = this.#takeSeed();
      if (seed === undefined) {
        if (this.#assigned.size === 0) this.close();
        return;
      }
      this.#assigned.set(worker, seed);
      worker.postMessage({ seed, states: this.#states });
    }
  }

  #takeSeed(): number | undefined {
    const retry = this.#retries.pop();
    if (retry !== undefined) return retry;
    if (this.#nextSeed > this.#lastSeed) return undefined;
    this.#nextSeed += 1;
    return this.#nextSeed - 1;
  }

  /** Frees the memory after the last seed, or if its laps are not needed any more. */
  close(): void {
    this.#isClosed = true;
    for (const worker of this.#workers) worker.terminate();
    this.#isActive = false;
  }

  async #runOnMainThread(): Promise<void> {
    const runner = await this.#core.runner();
    while (this.#isActive) {
      const seed = this.#takeSeed();
      if (seed === undefined) return;
      const laps: Lap[] = [];
      for (const [row, state] of this.#states.entries()) {
        // A timer started in an animation frame fires after the frame was painted.
        await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
        laps.push(runLap(runner, seed, row, state));
      }
      if (this.#isClosed) return;
      this.#onLaps(laps);
    }
  }
}
