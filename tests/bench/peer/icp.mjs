// Registration: pairs, the two increments, the loop, and what the pairs are worth to a graph.

import * as se2 from './se2.mjs';

const DEFAULTS = {
  variant: 'point-to-point',
  maxIterations: 25,
  tau: 0.6,
  tolerance: 1e-4,
  minPairs: 8,
};

/** Registers `cloud` on `map` from the guess `start`. */
export function icp(cloud, map, start, options = {}) {
  const { variant, maxIterations, tau, tolerance, minPairs } = { ...DEFAULTS, ...options };
  const increment = variant === 'point-to-plane' ? pointToPlane : pointToPoint;
  let pose = start;
  let pairs = associate(cloud, map, pose, tau);
  let iterations = 0;
  let converged = false;
  while (!converged && iterations < maxIterations && pairs.length >= minPairs) {
    const step = increment(pairs);
    pose = se2.compose(step, pose);
    pairs = associate(cloud, map, pose, tau);
    iterations += 1;
    converged = se2.size(se2.log(step)) < tolerance;
  }
  return { pose, pairs, iterations, converged, rmse: rmse(pairs, variant) };
}

function associate(cloud, map, pose, tau) {
  const { x, y, theta } = pose;
  const cos = Math.cos(theta);
  const sin = Math.sin(theta);
  const pairs = [];
  for (let k = 0; k < cloud.xs.length; k++) {
    const px = cos * cloud.xs[k] - sin * cloud.ys[k] + x;
    const py = sin * cloud.xs[k] + cos * cloud.ys[k] + y;
    const { index } = map.nearest(px, py, tau);
    if (index < 0) continue;
    const normal = map.normals?.[index] ?? null;
    pairs.push({ px, py, qx: map.xs[index], qy: map.ys[index], normal });
  }
  return pairs;
}

/** The best rigid motion for the pairs, in closed form: Arun, Huang & Blostein 1987 in the plane. */
function pointToPoint(pairs) {
  const n = pairs.length;
  let [mpx, mpy, mqx, mqy] = [0, 0, 0, 0];
  for (const { px, py, qx, qy } of pairs) {
    mpx += px;
    mpy += py;
    mqx += qx;
    mqy += qy;
  }
  mpx /= n;
  mpy /= n;
  mqx /= n;
  mqy /= n;
  let [dot, cross] = [0, 0];
  for (const { px, py, qx, qy } of pairs) {
    const [ax, ay, bx, by] = [px - mpx, py - mpy, qx - mqx, qy - mqy];
    dot += ax * bx + ay * by;
    cross += ax * by - ay * bx;
  }
  const theta = Math.atan2(cross, dot);
  const cos = Math.cos(theta);
  const sin = Math.sin(theta);
  return se2.pose(mqx - (cos * mpx - sin * mpy), mqy - (sin * mpx + cos * mpy), theta);
}

/** One Gauss–Newton step along the normals, about the centroid: Chen & Medioni 1992. */
function pointToPlane(pairs) {
  const planes = pairs.filter(({ normal }) => normal !== null);
  if (planes.length < 3) return se2.identity();
  let [cx, cy] = [0, 0];
  for (const { px, py } of planes) {
    cx += px;
    cy += py;
  }
  cx /= planes.length;
  cy /= planes.length;
  const h = [0, 0, 0, 0, 0, 0, 0, 0, 0];
  const g = [0, 0, 0];
  for (const { px, py, qx, qy, normal } of planes) {
    const [nx, ny] = normal;
    const row = [nx, ny, (px - cx) * ny - (py - cy) * nx];
    addOuter(h, row, 1);
    const residual = nx * (px - qx) + ny * (py - qy);
    for (let i = 0; i < 3; i++) g[i] -= row[i] * residual;
  }
  const ridge = (1e-4 * (h[0] + h[4] + h[8])) / 3 + 1e-12;
  for (const i of [0, 4, 8]) h[i] += ridge;
  const [vx, vy, omega] = solve3(h, g);
  const cos = Math.cos(omega);
  const sin = Math.sin(omega);
  return se2.pose(cx + vx - (cos * cx - sin * cy), cy + vy - (sin * cx + cos * cy), omega);
}

function rmse(pairs, variant) {
  if (pairs.length === 0) return Infinity;
  let sum = 0;
  for (const { px, py, qx, qy, normal } of pairs) {
    const [dx, dy] = [px - qx, py - qy];
    const alongNormal = variant === 'point-to-plane' && normal !== null;
    sum += alongNormal ? (normal[0] * dx + normal[1] * dy) ** 2 : dx * dx + dy * dy;
  }
  return Math.sqrt(sum / pairs.length);
}

/** Information of a registration, 3×3 row by row, in a body frame of heading `theta`. */
export function information(pairs, sigma, inflate, theta) {
  const cos = Math.cos(theta);
  const sin = Math.sin(theta);
  let [cx, cy] = [0, 0];
  for (const { px, py } of pairs) {
    cx += px / pairs.length;
    cy += py / pairs.length;
  }
  const h = [0, 0, 0, 0, 0, 0, 0, 0, 0];
  const weight = 1 / (sigma * sigma * inflate);
  for (const { px, py, normal } of pairs) {
    for (const [nx, ny] of normal === null ? [[1, 0], [0, 1]] : [normal]) {
      const lever = (px - cx) * ny - (py - cy) * nx;
      addOuter(h, [cos * nx + sin * ny, cos * ny - sin * nx, lever], weight);
    }
  }
  return regularize(h);
}

/** A ridge on the diagonal, then a scale that keeps its largest entry at 2500 or below. */
function regularize(h) {
  const ridged = h.map((value, k) => (k % 4 === 0 ? value + 1 : value));
  const largest = Math.max(ridged[0], ridged[4], ridged[8]);
  return largest > 2500 ? ridged.map((value) => value * (2500 / largest)) : ridged;
}

function addOuter(h, row, weight) {
  for (let i = 0; i < 3; i++) {
    for (let j = 0; j < 3; j++) h[3 * i + j] += weight * row[i] * row[j];
  }
}

/** Solves `h x = g` for a symmetric positive definite 3×3 matrix by Cholesky. */
export function solve3(h, g) {
  const l00 = Math.sqrt(h[0]);
  const l10 = h[3] / l00;
  const l20 = h[6] / l00;
  const l11 = Math.sqrt(h[4] - l10 * l10);
  const l21 = (h[7] - l20 * l10) / l11;
  const l22 = Math.sqrt(h[8] - l20 * l20 - l21 * l21);
  const y0 = g[0] / l00;
  const y1 = (g[1] - l10 * y0) / l11;
  const y2 = (g[2] - l20 * y0 - l21 * y1) / l22;
  const x2 = y2 / l22;
  const x1 = (y1 - l21 * x2) / l11;
  return [(y0 - l10 * x1 - l20 * x2) / l00, x1, x2];
}
