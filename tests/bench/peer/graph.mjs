// The pose graph: Gauss–Newton on SE(2) with Huber weights and a skyline Cholesky.

import * as se2 from './se2.mjs';

export class PoseGraph {
  constructor() {
    this.poses = [];
    this.edges = [];
  }

  addNode(pose) {
    return this.poses.push(pose) - 1;
  }

  addEdge(from, to, measurement, information) {
    this.edges.push({ from, to, measurement, information });
  }

  /** Σ eᵀ Ω e, without Huber's weights. */
  chi2() {
    return this.edges.reduce((sum, edge) => sum + quadratic(edge.information, this.residual(edge)), 0);
  }

  residual({ from, to, measurement }) {
    return se2.log(se2.between(measurement, se2.between(this.poses[from], this.poses[to])));
  }

  optimize(iterations, tolerance, huber) {
    for (let k = 0; k < iterations; k++) {
      const delta = this.solve(huber);
      let largest = 0;
      this.poses = this.poses.map((pose, node) => {
        const twist = [delta[3 * node], delta[3 * node + 1], delta[3 * node + 2]];
        largest = Math.max(largest, se2.size(twist));
        return se2.compose(pose, se2.exp(twist));
      });
      if (largest < tolerance) return;
    }
  }

  /** The step of the normal equations, node 0 held fixed. */
  solve(huber) {
    const system = new Skyline(3 * this.poses.length, this.profile());
    for (const edge of this.edges) {
      const e = this.residual(edge);
      const norm = Math.sqrt(quadratic(edge.information, e));
      const weight = norm > huber ? huber / norm : 1;
      const omega = edge.information.map((value) => weight * value);
      // The Jacobians are −Ad(Z⁻¹) at `from` and I at `to`.
      const a = negativeAdjoint(se2.inverse(edge.measurement));
      const omegaA = multiply(omega, a);
      if (edge.from > 0) {
        system.addBlock(edge.from, edge.from, multiply(transpose(a), omegaA));
        system.addBlock(edge.to, edge.from, omegaA);
        system.subtract(edge.from, apply(transpose(omegaA), e));
      }
      system.addBlock(edge.to, edge.to, omega);
      system.subtract(edge.to, apply(omega, e));
    }
    for (let i = 0; i < system.size; i++) system.rows[i][i - system.first[i]] += 1e-9;
    for (let i = 0; i < 3; i++) system.rows[i][i - system.first[i]] = 1;
    return system.solve();
  }

  /** The first node to which each node is tied. */
  profile() {
    const first = this.poses.map((_, node) => node);
    for (const { from, to } of this.edges) {
      if (from > 0) first[to] = Math.min(first[to], from);
    }
    return first;
  }
}

/** A symmetric positive definite system whose rows are kept from their first entry on. */
class Skyline {
  constructor(size, firstNodes) {
    this.size = size;
    this.first = Array.from({ length: size }, (_, i) => 3 * firstNodes[Math.floor(i / 3)]);
    this.rows = this.first.map((first, i) => new Float64Array(i - first + 1));
    this.right = new Float64Array(size);
  }

  /** Adds a 3×3 block in the lower triangle. */
  addBlock(row, column, block) {
    for (let i = 0; i < 3; i++) {
      for (let j = 0; j < 3; j++) {
        const [at, left] = [3 * row + i, 3 * column + j];
        if (left <= at) this.rows[at][left - this.first[at]] += block[3 * i + j];
      }
    }
  }

  subtract(node, vector) {
    for (let i = 0; i < 3; i++) this.right[3 * node + i] -= vector[i];
  }

  /** Cholesky in place, then both triangles. */
  solve() {
    const { size, first, rows, right } = this;
    for (let i = 0; i < size; i++) {
      const row = rows[i];
      for (let j = first[i]; j <= i; j++) {
        const other = rows[j];
        let sum = row[j - first[i]];
        for (let k = Math.max(first[i], first[j]); k < j; k++) {
          sum -= row[k - first[i]] * other[k - first[j]];
        }
        row[j - first[i]] = i === j ? Math.sqrt(sum) : sum / other[j - first[j]];
      }
    }
    for (let i = 0; i < size; i++) {
      for (let k = first[i]; k < i; k++) right[i] -= rows[i][k - first[i]] * right[k];
      right[i] /= rows[i][i - first[i]];
    }
    for (let i = size - 1; i >= 0; i--) {
      right[i] /= rows[i][i - first[i]];
      for (let k = first[i]; k < i; k++) right[k] -= rows[i][k - first[i]] * right[i];
    }
    return right;
  }
}

function negativeAdjoint({ x, y, theta }) {
  const cos = Math.cos(theta);
  const sin = Math.sin(theta);
  return [-cos, sin, -y, -sin, -cos, x, 0, 0, -1];
}

/** eᵀ Ω e. */
export const quadratic = (omega, e) =>
  apply(omega, e).reduce((sum, value, k) => sum + value * e[k], 0);

const apply = (m, [x, y, z]) =>
  [0, 3, 6].map((row) => m[row] * x + m[row + 1] * y + m[row + 2] * z);

const transpose = ([a, b, c, d, e, f, g, h, i]) => [a, d, g, b, e, h, c, f, i];

function multiply(a, b) {
  const product = [];
  for (let i = 0; i < 9; i += 3) {
    for (let j = 0; j < 3; j++) {
      product.push(a[i] * b[j] + a[i + 1] * b[j + 3] + a[i + 2] * b[j + 6]);
    }
  }
  return product;
}
