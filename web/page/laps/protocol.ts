// Messages between the page and a worker that runs laps.

/** Levels of odometry noise, as factors of the variances. */
export const LEVELS = [0.25, 1, 2, 4] as const;

/** The result of a lap; fields in the order of the module's `Laps.drive`. */
export interface Lap {
  seed: number;
  level: number;
  /** Position errors of the last keyframe, m. */
  frontEnd: number;
  withLoops: number;
  closed: number;
  wrong: number;
}

/** To a worker: first the module, then seeds. */
export type Order = { module: WebAssembly.Module } | { seed: number };

/** The module's `Laps`. */
export interface LapRunner {
  drive(seed: number, noise: number): ArrayLike<number>;
}

/** Runs the lap of a seed at one level. */
export function runLap(runner: LapRunner, seed: number, level: number): Lap {
  const [, frontEnd = NaN, withLoops = NaN, closed = 0, wrong = 0] = Array.from(runner.drive(seed, LEVELS[level] ?? 1));
  return { seed, level, frontEnd, withLoops, closed, wrong };
}
