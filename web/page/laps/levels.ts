// The laps of the chapter at four levels of odometry noise.

import type { Plan } from './laps';

/** Factors of the variances. */
const LEVELS = [0.25, 1, 2, 4];

export const LEVELS_PLAN: Plan = {
  rows: LEVELS.map((noise) => ({ name: `×${noise}`, label: `wheel noise ×${noise}`, at: `at noise ×${noise}`, state: `noise=${noise}` })),
  measure: ({ end }) => end,
  axis: { end: 2, unit: ' m', labels: ['0', '1', '≥ 2 m'] },
  lastTick: 129,
};
