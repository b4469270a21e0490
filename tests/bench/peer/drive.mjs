// The simulated drive: truth, wheels and sweeps, tick by tick. No estimate takes part in it.

import { downsample, withNormals } from './cloud.mjs';
import { Rng } from './rng.mjs';
import * as se2 from './se2.mjs';
import { Lidar } from './world.mjs';

const START = se2.pose(1.35, 4.42, 0);
const WAY_POINTS = [
  { x: 10.6, y: 4.42 },
  { x: 1.35, y: 4.42 },
];
const ALPHA = [0.06, 0.02, 0.05, 0.02, 0.02, 0.01];
const [V_MAX, OMEGA_MAX, DT] = [0.62, 1.1, 0.25];

const clamp = (value, limit) => Math.min(Math.max(value, -limit), limit);

/** The drive of one seed: the start, and of each tick truth, odometry, dead reckoning and cloud. */
export function simulate(seed, noise) {
  const rng = new Rng(seed);
  const lidar = new Lidar({ beams: 120, maxRange: 6, sigma: 0.05 });
  const alpha = ALPHA.map((value) => noise * value);
  const sense = (truth) => withNormals(downsample(lidar.project(lidar.sense(truth, rng)), 0.12), 0.3);

  const start = { truth: START, deadReckoning: START, cloud: sense(START) };
  const ticks = [];
  let truth = START;
  let deadReckoning = START;
  let goal = 0;
  while (goal < WAY_POINTS.length) {
    const { v, omega, arrived } = command(truth, WAY_POINTS[goal]);
    if (arrived) goal += 1;
    const before = truth;
    truth = arc(before, v, omega, 1e-9);
    const odometry = se2.between(before, sampleWheels(before, v, omega, alpha, rng));
    deadReckoning = se2.compose(deadReckoning, odometry);
    ticks.push({ truth, odometry, deadReckoning, turned: arrived && goal === 1, cloud: sense(truth) });
  }
  return { start, ticks };
}

function command(truth, goal) {
  const distance = se2.distance(truth, goal);
  const error = se2.wrap(Math.atan2(goal.y - truth.y, goal.x - truth.x) - truth.theta);
  return {
    v: Math.abs(error) > 0.5 ? 0 : V_MAX * Math.min(1, distance / 0.6),
    omega: clamp(2.2 * error, OMEGA_MAX),
    arrived: distance < 0.3,
  };
}

/** Where a held command leads: along a circle, or straight where it hardly turns. */
function arc({ x, y, theta }, v, omega, straightBelow) {
  if (Math.abs(omega) < straightBelow) {
    return se2.pose(x + v * DT * Math.cos(theta), y + v * DT * Math.sin(theta), theta + omega * DT);
  }
  const [radius, turned] = [v / omega, theta + omega * DT];
  return se2.pose(
    x - radius * Math.sin(theta) + radius * Math.sin(turned),
    y + radius * Math.cos(theta) - radius * Math.cos(turned),
    turned,
  );
}

/** The velocity sampler of Thrun, Burgard & Fox 2005, Table 5.3. */
function sampleWheels(from, v, omega, alpha, rng) {
  const [v2, w2] = [v * v, omega * omega];
  const deviation = (k) => Math.sqrt(alpha[k] * v2 + alpha[k + 1] * w2);
  const sampledV = v + rng.normal(0, deviation(0));
  const sampledOmega = omega + rng.normal(0, deviation(2));
  const gamma = rng.normal(0, deviation(4));
  const { x, y, theta } = arc(from, sampledV, sampledOmega, 1e-6);
  return se2.pose(x, y, theta + gamma * DT);
}
