// The chapter's SLAM system on a simulated drive, with the metrics of every tick.

import { VoxelMap, join, transform } from './cloud.mjs';
import { PoseGraph, quadratic } from './graph.mjs';
import { icp, information } from './icp.mjs';
import * as se2 from './se2.mjs';

/** Estimates a drive tick by tick. */
export class Slam {
  constructor(drive, { loops }) {
    const { truth, cloud } = drive.start;
    Object.assign(this, { drive, loops, estimate: truth });
    this.window = [{ pose: truth, cloud }];
    this.deviations = [];
    this.graph = new PoseGraph();
    this.graph.addNode(truth);
    this.keyframes = [{ truth, cloud }];
    this.lastAttempt = -Infinity;
    this.turnNode = null;
    this.disagreement = null;
    this.odometrySquares = 0;
    this.events = [];
    this.reports = [];
  }

  run() {
    for (const tick of this.drive.ticks) this.step(tick);
    return this;
  }

  step({ truth, odometry, deadReckoning, turned, cloud }) {
    if (turned) {
      this.turnNode = this.keyframes.length - 1;
      this.compareMaps();
    }
    const { inliers, rmse, iterations } = this.register(odometry, cloud);
    const keyframe = this.takeKeyframe(truth, cloud);
    if (keyframe && this.loops) this.closeLoop();

    const odometryError = se2.distance(deadReckoning, truth);
    this.odometrySquares += odometryError ** 2;
    this.reports.push({
      ...{ truth, deadReckoning, inliers, rmse, iterations, keyframe, odometryError },
      estimate: this.estimate,
      tau: this.tau(),
      odometryRms: Math.sqrt(this.odometrySquares / (this.reports.length + 1)),
      keyframeRms: rms(this.keyframeErrors()),
      chi2: this.chi2 ?? 0,
      mapDisagreement: this.disagreement?.value(),
    });
  }

  /** ICP on the last sweeps, from where the wheels say. */
  register(odometry, cloud) {
    const local = join(this.window.map(({ pose, cloud }) => transform(cloud, pose)));
    this.localMap = new VoxelMap(local, 0.25, 4);
    const prediction = se2.compose(this.estimate, odometry);
    const found = icp(cloud, this.localMap, prediction, { maxIterations: 15, tau: this.tau() });
    this.pairs = found.pairs;
    this.estimate = found.pairs.length >= 8 ? found.pose : prediction;

    const deviation = se2.between(prediction, this.estimate);
    const moved = se2.distance(deviation, se2.identity());
    const delta = moved + 2 * 6 * Math.sin(Math.abs(deviation.theta) / 2);
    if (delta >= 0.03) this.deviations.push(delta);
    if (this.window.length === 6) this.window.shift();
    this.window.push({ pose: this.estimate, cloud });
    return { inliers: found.pairs.length, rmse: found.rmse, iterations: found.iterations };
  }

  /** The adaptive threshold of KISS-ICP. */
  tau() {
    return this.deviations.length < 3 ? 0.5 : 3 * rms(this.deviations);
  }

  takeKeyframe(truth, cloud) {
    const last = this.keyframes.length - 1;
    const lastPose = this.graph.poses[last];
    const relative = se2.between(lastPose, this.estimate);
    const moved = se2.distance(relative, se2.identity());
    if (moved < 0.4 && Math.abs(relative.theta) < 0.35) return false;
    const node = this.graph.addNode(this.estimate);
    this.graph.addEdge(last, node, relative, information(this.pairs, 0.05, 12, lastPose.theta));
    this.keyframes.push({ truth, cloud });
    this.chi2 = this.graph.chi2();
    this.disagreement?.add(transform(cloud, this.estimate));
    return true;
  }

  closeLoop() {
    const node = this.keyframes.length - 1;
    if (node - this.lastAttempt < 4) return;
    this.lastAttempt = node;
    const { poses } = this.graph;
    let [to, nearest] = [-1, Infinity];
    for (let old = 0; old <= node - 22; old++) {
      const distance = se2.distance(poses[old], poses[node]);
      if (distance <= 2 && distance < nearest) [to, nearest] = [old, distance];
    }
    if (to < 0) return;

    const [first, last] = [Math.max(0, to - 3), Math.min(node, to + 3)];
    const near = this.keyframes.slice(first, last + 1);
    const world = join(near.map(({ cloud }, k) => transform(cloud, poses[first + k])));
    const map = new VoxelMap(transform(world, se2.inverse(poses[to])), 0.25, 6);
    const start = se2.between(poses[to], poses[node]);
    const found = icp(this.keyframes[node].cloud, map, start, { maxIterations: 30, tau: 1 });

    const [xy, theta] = [0.045, 0.012].map((sigma) => 1 / (sigma * sigma * (node - to)));
    const innovation = se2.log(se2.between(start, found.pose));
    const chi2 = quadratic([xy, 0, 0, 0, xy, 0, 0, 0, theta], innovation);
    const inliers = found.pairs.length;
    const accepted = found.rmse <= 0.16 && inliers >= 25 && chi2 <= 7.815;
    const event = { from: node, to, chi2, rmse: found.rmse, inliers, accepted };
    if (accepted) {
      const omega = information(found.pairs, 0.05, 25, poses[to].theta);
      Object.assign(event, this.correct(node, to, found.pose, omega));
    }
    this.events.push(event);
  }

  /** Adds the edge, optimizes, and moves the front end to where its node now is. */
  correct(node, to, measurement, omega) {
    const before = this.graph.poses;
    const rmsBefore = rms(this.keyframeErrors());
    this.graph.addEdge(to, node, measurement, omega);
    this.graph.optimize(15, 1e-7, 12);
    const after = this.graph.poses;
    this.chi2 = this.graph.chi2();
    const correction = se2.compose(after[node], se2.inverse(before[node]));
    this.estimate = se2.compose(correction, this.estimate);
    for (const sweep of this.window) sweep.pose = se2.compose(correction, sweep.pose);
    this.compareMaps();
    return {
      maxShift: Math.max(...after.map((pose, k) => se2.distance(pose, before[k]))),
      rmsBefore,
      rmsAfter: rms(this.keyframeErrors()),
    };
  }

  keyframeErrors() {
    return this.keyframes.map(({ truth }, node) => se2.distance(this.graph.poses[node], truth));
  }

  /** Map self-disagreement: the way back beside a map of the way out. */
  compareMaps() {
    if (this.turnNode === null) return;
    const seen = this.keyframes.map(({ cloud }, node) => transform(cloud, this.graph.poses[node]));
    const out = join(seen.slice(0, this.turnNode + 1));
    this.disagreement = new Disagreement(new VoxelMap(out, 0.2, 12));
    for (const cloud of seen.slice(this.turnNode + 1)) this.disagreement.add(cloud);
  }
}

class Disagreement {
  constructor(map) {
    Object.assign(this, { map, squares: 0, count: 0 });
  }

  add({ xs, ys }) {
    for (let k = 0; k < xs.length; k++) {
      const { index, squared } = this.map.nearest(xs[k], ys[k], 1.5);
      if (index < 0) continue;
      this.squares += squared;
      this.count += 1;
    }
  }

  value() {
    return this.count > 0 ? Math.sqrt(this.squares / this.count) : undefined;
  }
}

export const rms = (errors) =>
  Math.sqrt(errors.reduce((sum, error) => sum + error * error, 0) / errors.length);
