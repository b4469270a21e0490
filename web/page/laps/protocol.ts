// Messages between the page and a worker that runs laps, and the result of a lap.

/** Levels of the wheels' noise, as factors of their variances. */
export const LEVELS = [0.25, 1, 2, 4] as const;

/** What came out of one lap: `Laps.drive` of the module, in its order. */
export interface Lap {
  seed: number;
  level: number;
  /** Position errors of the last keyframe, m. */
  frontEnd: number;
  withLoops: number;
  closed: number;
  wrong: number;
}

/** To a worker: first the program, then seeds. */
export type Order = { module: WebAssembly.Module } | { seed: number };

/** What drives laps: an instance of the module. */
export interface Driver {
  drive(seed: number, noise: number): ArrayLike<number>;
}

/** The lap of a seed at one level. */
export function driven(driver: Driver, seed: number, level: number): Lap {
  const [, frontEnd = NaN, withLoops = NaN, closed = 0, wrong = 0] = Array.from(driver.drive(seed, LEVELS[level] ?? 1));
  return { seed, level, frontEnd, withLoops, closed, wrong };
}
