// Normal distributions, one a cell: building them and scoring points against them.

import { eigenvalues } from './cloud.mjs';

const key = (i, j) => (i << 16) | (j & 0xffff);

export class NdtMap {
  constructor({ xs, ys }, cell, minPoints) {
    this.cell = cell;
    this.cells = new Map();
    const members = new Map();
    for (let k = 0; k < xs.length; k++) {
      const [i, j] = [Math.floor(xs[k] / cell), Math.floor(ys[k] / cell)];
      const at = key(i, j);
      if (!members.has(at)) members.set(at, { i, j, points: [] });
      members.get(at).points.push(k);
    }
    for (const [at, { i, j, points }] of members) {
      if (points.length >= minPoints) this.cells.set(at, gaussian(i, j, points, xs, ys));
    }
  }

  /** Σ exp(−½ dᵀ Σ⁻¹ d) over the 3×3 cells around the point. */
  score(x, y) {
    const ci = Math.floor(x / this.cell);
    const cj = Math.floor(y / this.cell);
    let sum = 0;
    for (let i = ci - 1; i <= ci + 1; i++) {
      for (let j = cj - 1; j <= cj + 1; j++) {
        const gauss = this.cells.get(key(i, j));
        if (gauss === undefined) continue;
        const dx = x - gauss.mx;
        const dy = y - gauss.my;
        const square = dx * (gauss.wxx * dx + gauss.wxy * dy) + dy * (gauss.wxy * dx + gauss.wyy * dy);
        sum += Math.exp(-0.5 * square);
      }
    }
    return sum;
  }
}

/** Mean, clamped covariance and its inverse `w` of one cell's points. */
function gaussian(i, j, points, xs, ys) {
  const n = points.length;
  let [mx, my, xx, xy, yy] = [0, 0, 0, 0, 0];
  for (const k of points) {
    mx += xs[k] / n;
    my += ys[k] / n;
  }
  for (const k of points) {
    const [dx, dy] = [xs[k] - mx, ys[k] - my];
    xx += (dx * dx) / (n - 1);
    xy += (dx * dy) / (n - 1);
    yy += (dy * dy) / (n - 1);
  }
  const { smallest, largest } = eigenvalues(xx, xy, yy);
  const high = Math.max(largest, 1e-4);
  const low = Math.max(smallest, 0.01 * high);
  // Unit eigenvector of the larger eigenvalue; the other one is orthogonal to it.
  const theta = 0.5 * Math.atan2(2 * xy, xx - yy);
  const [cos, sin] = [Math.cos(theta), Math.sin(theta)];
  const compose = (a, b) => ({
    xx: a * cos * cos + b * sin * sin,
    xy: (a - b) * cos * sin,
    yy: a * sin * sin + b * cos * cos,
  });
  const covariance = compose(high, low);
  const w = compose(1 / high, 1 / low);
  return { i, j, count: n, mx, my, covariance, wxx: w.xx, wxy: w.xy, wyy: w.yy };
}
