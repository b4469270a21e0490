// The Apartment, and a LiDAR in it.

const horizontal = (y, ...spans) => spans.map(([x1, x2]) => ({ x1, y1: y, x2, y2: y }));
const vertical = (x, ...spans) => spans.map(([y1, y2]) => ({ x1: x, y1, x2: x, y2 }));

/** Walls with their ends, in metres. */
const WALLS = [
  ...horizontal(0, [0, 12]),
  ...horizontal(9, [0, 12]),
  ...vertical(0, [0, 9]),
  ...vertical(12, [0, 9]),
  ...horizontal(3.8, [0, 1.6], [2.5, 5.5], [6.5, 9.5], [10.4, 12]),
  ...horizontal(5, [0, 2.8], [3.7, 7.4], [8.3, 12]),
  ...vertical(4, [0, 3.8]),
  ...vertical(8, [0, 3.8]),
  ...vertical(6, [5, 9]),
  ...horizontal(1.4, [4, 6.2]),
  ...vertical(2, [7.6, 9]),
  ...vertical(9.6, [7.4, 9]),
  ...horizontal(7.4, [9.6, 10.9]),
];

/** Range from `(x, y)` along `angle` to the nearest wall, at most `maxRange`. */
function cast(x, y, angle, maxRange) {
  const dx = Math.cos(angle);
  const dy = Math.sin(angle);
  let best = maxRange;
  for (const { x1, y1, x2, y2 } of WALLS) {
    const ex = x2 - x1;
    const ey = y2 - y1;
    const denominator = dx * ey - dy * ex;
    if (Math.abs(denominator) < 1e-12) continue;
    const ox = x1 - x;
    const oy = y1 - y;
    const t = (ox * ey - oy * ex) / denominator;
    const u = (ox * dy - oy * dx) / denominator;
    if (t >= 0 && u >= 0 && u <= 1 && t < best) best = t;
  }
  return best;
}

/** A full circle of beams. */
export class Lidar {
  constructor({ beams, maxRange, sigma }) {
    Object.assign(this, { maxRange, sigma });
    this.bearings = Array.from({ length: beams }, (_, k) => -Math.PI + k * ((2 * Math.PI) / beams));
  }

  measure({ x, y, theta }) {
    return this.bearings.map((bearing) => cast(x, y, theta + bearing, this.maxRange));
  }

  /** Three draws a beam: one that would decide on a dropout, two for the noise. */
  sense(at, rng) {
    return this.measure(at).map((range) => {
      rng.uniform();
      const noisy = range + rng.normal(0, this.sigma);
      return Math.min(Math.max(noisy, 0), this.maxRange);
    });
  }

  /** The returns as points in the sensor's frame. */
  project(ranges) {
    const [xs, ys] = [[], []];
    ranges.forEach((range, k) => {
      if (range >= 0.995 * this.maxRange) return;
      xs.push(range * Math.cos(this.bearings[k]));
      ys.push(range * Math.sin(this.bearings[k]));
    });
    return { xs, ys };
  }
}
