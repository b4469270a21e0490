// The port beside `tests/reference/*.json`, which an independent implementation computed.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { downsample, transform } from './cloud.mjs';
import { simulate } from './drive.mjs';
import { Slam, rms } from './lap.mjs';
import { NdtMap } from './ndt.mjs';
import { Rng } from './rng.mjs';
import { BasinScene, TerrainScene } from './scenes.mjs';
import { pose, wrap } from './se2.mjs';
import { Lidar } from './world.mjs';

const reference = (name) =>
  JSON.parse(readFileSync(new URL(`../../reference/${name}.json`, import.meta.url)));

/** Single registrations and grids. */
const TIGHT = 1e-9;
/** Whole laps: hundreds of registrations in a row pass on the last bits of each. */
const LAP = 1e-6;

function close(what, actual, expected, tolerance) {
  const apart = Math.abs(actual - expected);
  assert.ok(apart <= tolerance, `${what}: ${actual} is not ${expected}`);
}

function closePose(what, actual, [x, y, theta], tolerance) {
  close(`x of ${what}`, actual.x, x, tolerance);
  close(`y of ${what}`, actual.y, y, tolerance);
  close(`heading of ${what}`, wrap(actual.theta - theta), 0, tolerance);
}

function closeAll(what, actual, expected, tolerance) {
  assert.equal(actual.length, expected.length, what);
  actual.forEach((value, k) => close(`${what} ${k}`, value, expected[k], tolerance));
}

export function checkDraws() {
  for (const { seed, uniform, normal } of reference('rng')) {
    let rng = new Rng(seed);
    closeAll(`draws of ${seed}`, uniform.map(() => rng.uniform()), uniform, 0);
    rng = new Rng(seed);
    closeAll(`normals of ${seed}`, normal.map(() => rng.normal(0, 1)), normal, TIGHT);
  }
}

export function checkScans() {
  for (const scan of reference('scan')) {
    const [x, y, theta] = scan.pose;
    const lidar = new Lidar({
      beams: scan.beams,
      maxRange: scan.max_range,
      sigma: scan.noisy_sigma,
    });
    const noisy = lidar.sense(pose(x, y, theta), new Rng(scan.noisy_seed));
    closeAll('true ranges', lidar.measure(pose(x, y, theta)), scan.true_ranges, TIGHT);
    closeAll('noisy ranges', noisy, scan.noisy_ranges, TIGHT);
  }
}

export function checkBasin() {
  const basin = reference('basin');
  const scene = new BasinScene();
  const flat = (points, axis) => points.map((point) => point[axis]);
  for (const [name, cloud] of [['target', scene.target], ['source', scene.source]]) {
    closeAll(`x of ${name}`, cloud.xs, flat(basin[name], 0), TIGHT);
    closeAll(`y of ${name}`, cloud.ys, flat(basin[name], 1), TIGHT);
  }
  for (const run of basin.runs) {
    const { variant, heading_deg: headingDeg, dx, dy, tau } = run;
    const found = scene.register({ variant, headingDeg, dx, dy, tau });
    const name = `${variant} from ${headingDeg}° (${dx}, ${dy}) with τ ${tau}`;
    closePose(name, found.pose, run.pose, TIGHT);
    close(`rmse of ${name}`, found.rmse, run.rmse, TIGHT);
    assert.equal(found.iterations, run.iterations, name);
    assert.equal(found.converged, run.converged, name);
    assert.equal(found.pairs.length, run.inliers, name);
  }
}

export function checkTerrains() {
  for (const expected of reference('terrain')) {
    const scene = new TerrainScene(expected.scene);
    const { n, span_m: span, tau } = expected;
    const { icpCost, ndtScore } = scene.terrain({ n, span, tau });
    assert.equal(scene.ndt.cells.size, expected.ndt_cells);
    closeAll(`cost of the ${expected.scene}`, icpCost, expected.icp_cost_m2, TIGHT);
    closeAll(`score of the ${expected.scene}`, ndtScore, expected.ndt_score, TIGHT);
  }
}

export function checkLaps() {
  for (const expected of reference('lap')) {
    const { seed, noise, loops } = expected;
    const slam = new Slam(simulate(seed, noise), { loops }).run();
    const name = `seed ${seed} ×${noise}${loops ? '' : ' without loops'}`;
    assert.equal(slam.reports.length, expected.ticks, name);
    slam.reports.forEach((report, k) => {
      const tick = expected.per_tick[k];
      const at = `${name} tick ${k + 1}`;
      closePose(`the truth, ${at}`, report.truth, tick.truth, LAP);
      closePose(`dead reckoning, ${at}`, report.deadReckoning, tick.dead_reckoning, LAP);
      closePose(`the estimate, ${at}`, report.estimate, tick.estimate, LAP);
      for (const key of ['tau', 'rmse']) close(`${key}, ${at}`, report[key], tick[key], LAP);
      for (const key of ['inliers', 'iterations', 'keyframe']) {
        assert.equal(report[key], tick[key], `${key}, ${at}`);
      }
    });
    checkEvents(name, slam.events, expected.events);
    expected.keyframe_poses.forEach((node, k) => {
      closePose(`${name} keyframe ${k}`, slam.graph.poses[k], node, LAP);
    });
    const last = slam.reports.at(-1);
    assert.equal(slam.keyframes.length, expected.keyframes, name);
    assert.equal(slam.turnNode, expected.turn_node, name);
    close(`odometry at the end, ${name}`, last.odometryError, expected.odometry_end_error, LAP);
    close(`odometry rms, ${name}`, last.odometryRms, expected.odometry_rms, LAP);
    close(`keyframe rms, ${name}`, rms(slam.keyframeErrors()), expected.keyframe_rms, LAP);
    close(`disagreement, ${name}`, last.mapDisagreement, expected.map_disagreement, LAP);
    close(`χ², ${name}`, last.chi2, expected.chi2, LAP);
  }
}

function checkEvents(name, events, expected) {
  assert.equal(events.length, expected.length, `loop attempts, ${name}`);
  events.forEach((event, k) => {
    const wanted = expected[k];
    const at = `${name} loop ${wanted.from} to ${wanted.to}`;
    for (const key of ['from', 'to', 'inliers', 'accepted']) assert.equal(event[key], wanted[key], at);
    for (const key of ['chi2', 'rmse']) close(`${key}, ${at}`, event[key], wanted[key], LAP);
    if (!event.accepted) return;
    close(`shift, ${at}`, event.maxShift, wanted.max_shift, LAP);
    close(`rms before, ${at}`, event.rmsBefore, wanted.ate_before, LAP);
    close(`rms after, ${at}`, event.rmsAfter, wanted.ate_after, LAP);
  });
}

/** The Gaussians of one sweep. */
export function checkGaussians() {
  const expected = reference('ndt');
  const at = pose(...expected.pose);
  const lidar = new Lidar({ beams: 180, maxRange: 6, sigma: 0.01 });
  const sweep = lidar.project(lidar.sense(at, new Rng(expected.seed)));
  const map = new NdtMap(transform(downsample(sweep, 0.08), at), expected.cell, expected.min_points);
  const order = (a, b) => a.i - b.i || a.j - b.j;
  const cells = [...map.cells.values()].sort(order);
  assert.equal(cells.length, expected.cells.length);
  expected.cells.sort(order).forEach(({ i, j, count, mean, cov }, k) => {
    const cell = cells[k];
    const { xx, xy, yy } = cell.covariance;
    assert.deepEqual([cell.i, cell.j, cell.count], [i, j, count]);
    closeAll(`mean of cell ${i}, ${j}`, [cell.mx, cell.my], mean, TIGHT);
    closeAll(`covariance of cell ${i}, ${j}`, [xx, xy, xy, yy], cov.flat(), TIGHT);
  });
}
