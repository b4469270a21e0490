// The scenes of the basin explorer and of the cost terrains.

import { VoxelMap, downsample, transform, withNormals } from './cloud.mjs';
import { icp } from './icp.mjs';
import { NdtMap } from './ndt.mjs';
import { Rng } from './rng.mjs';
import * as se2 from './se2.mjs';
import { Lidar } from './world.mjs';

/** Two sweeps of room A; the second is registered on the first. */
export class BasinScene {
  constructor() {
    const rng = new Rng(0x1c9);
    const lidar = new Lidar({ beams: 180, maxRange: 6, sigma: 0.012 });
    const [a, b] = [se2.pose(2, 1.9, 0), se2.pose(2.5, 1.55, 0.35)];
    this.target = withNormals(downsample(lidar.project(lidar.sense(a, rng)), 0.06), 0.3);
    this.source = downsample(lidar.project(lidar.sense(b, rng)), 0.09);
    this.truth = se2.between(a, b);
    this.map = new VoxelMap(this.target, 0.25, 8);
  }

  /** Registers from the truth moved by `(dx, dy)` and turned by `headingDeg`. */
  register({ variant, headingDeg, dx, dy, tau }) {
    const { x, y, theta } = this.truth;
    const start = se2.pose(x + dx, y + dy, theta + (headingDeg * Math.PI) / 180);
    const found = icp(this.source, this.map, start, { variant, tau, maxIterations: 30 });
    const [vx, vy, omega] = se2.log(se2.between(this.truth, found.pose));
    const errorDeg = (Math.abs(omega) * 180) / Math.PI;
    return { ...found, errorM: Math.sqrt(vx * vx + vy * vy), errorDeg };
  }

  /** One registration for each whole degree. */
  sweep(variant) {
    const headings = Array.from({ length: 361 }, (_, k) => k - 180);
    return headings.map((headingDeg) =>
      this.register({ variant, headingDeg, dx: 0.55, dy: 0.45, tau: 0.7 }),
    );
  }
}

const TERRAIN_POSES = { room: se2.pose(2, 1.9, 0), corridor: se2.pose(6, 4.42, 0) };

/** One sweep, and what ICP and NDT think of it when it is shifted. */
export class TerrainScene {
  constructor(kind) {
    const at = TERRAIN_POSES[kind];
    const lidar = new Lidar({ beams: 180, maxRange: 3, sigma: 0.01 });
    const sweep = downsample(lidar.project(lidar.sense(at, new Rng(0x5c0))), 0.08);
    this.cloud = transform(sweep, at);
    this.map = new VoxelMap(this.cloud, 0.3, 8);
    this.ndt = new NdtMap(this.cloud, 0.55, 4);
  }

  /** Both objectives on an n × n grid over ± `span`, row by row, y outer. */
  terrain({ n, span, tau }) {
    const { xs, ys } = this.cloud;
    const [icpCost, ndtScore] = [[], []];
    for (let i = 0; i < n; i++) {
      for (let j = 0; j < n; j++) {
        const dx = -span + (2 * span * j) / (n - 1);
        const dy = -span + (2 * span * i) / (n - 1);
        let cost = 0;
        let score = 0;
        for (let k = 0; k < xs.length; k++) {
          cost += this.map.nearest(xs[k] + dx, ys[k] + dy, tau).squared;
          score += this.ndt.score(xs[k] + dx, ys[k] + dy);
        }
        icpCost.push(cost / xs.length);
        ndtScore.push(score / xs.length);
      }
    }
    return { icpCost, ndtScore };
  }
}
