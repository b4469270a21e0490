// Messages between the page and a worker that runs laps.

/** One estimate of a lap, m. */
export interface Estimate {
  /** Position error of the last keyframe. */
  end: number;
  /** Root mean square error of all keyframes. */
  rms: number;
  /** Position error in the middle of the path, and the graph's standard deviation of it. */
  middle: number;
  sigma: number;
}

/** The result of a lap. */
export interface Lap {
  seed: number;
  /** Its row in the figure. */
  row: number;
  frontEnd: Estimate;
  withLoops: Estimate;
  closed: number;
  wrong: number;
}

/** To a worker: first the module, then seeds with the state of w16.2 in each row: `noise=4&matcher=p2l`. */
export type Order = { module: WebAssembly.Module } | { seed: number; states: readonly string[] };

/** The module's `LapOutcomes`. */
export interface LapRunner {
  drive(seed: number, state: string): ArrayLike<number>;
}

/** Runs the lap of a seed in a row. */
export function runLap(runner: LapRunner, seed: number, row: number, state: string): Lap {
  // The order of the module's `LapOutcomes.drive`.
  const numbers = Array.from(runner.drive(seed, state));
  const estimate = (from: number): Estimate => {
    const [end = NaN, rms = NaN, middle = NaN, sigma = NaN] = numbers.slice(from, from + 4);
    return { end, rms, middle, sigma };
  };
  const [closed = 0, wrong = 0] = numbers.slice(8);
  return { seed, row, frontEnd: estimate(0), withLoops: estimate(4), closed, wrong };
}
