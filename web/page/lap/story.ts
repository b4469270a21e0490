// The recorded lap, and its state at each second of the replay.

import type { Point, Pose } from '../world/surfaces';

/** The output of the module's `lapStory`. */
export interface Story {
  walls: [number, number, number, number][];
  ticks: { wheels: Pose; estimate: Pose; sweep: number[] }[];
  /** The tick of each keyframe. */
  keyframes: number[];
  /** Poses of all keyframes, valid from a tick on. */
  epochs: { tick: number; poses: Pose[] }[];
  loops: { tick: number; from: number; to: number; shift: number }[];
  /** The last keyframe of the way out. */
  turn: number;
}

/** A part of the replay: the robot drives, or a loop closure corrects the keyframes. */
interface Segment {
  act: number;
  fromS: number;
  toS: number;
  fromTick: number;
  toTick: number;
  /** The epoch with the poses; during a loop closure, the one before it. */
  epoch: number;
  closes: boolean;
}

/** Everything that the picture of one moment needs. */
export interface Moment {
  act: number;
  tick: number;
  robot: Pose;
  keyframes: readonly Pose[];
  /** The path by odometry so far. */
  wheels: readonly Pose[];
  /** The closed loops, as indices of keyframes. */
  closed: readonly { from: number; to: number }[];
  /** The poses before the last correction; `strength` fades out after it. */
  moved: { from: readonly Pose[]; strength: number };
  /** The poses before the first loop, drawn at the end; `strength` fades in. */
  before: { poses: readonly Pose[]; strength: number };
  /** Zoom: 0 for the whole corridor, 1 for the place where the walls meet again. */
  closeness: number;
}

/** Durations: way out, way back, each loop closure, the first in slow motion, and the drive between two of them. */
const OUT_S = 2.6;
const BACK_S = 2;
const SNAP_S = [2.6, 0.5, 0.5];
const BETWEEN_S = 0.4;
/** Pauses on the doubled walls before the first loop, and on the corrected map at the end. */
const PAUSE_S = 0.5;
const END_S = 1.2;
/** On the way back the picture zooms in while both robots drive `overM` to the left of `fromX`. */
const ZOOM = { fromX: 9.6, overM: 1.2 };
/** Fade-in of the walls before the first loop, at the end. */
const FADE_IN_S = 0.6;
/** Fade-out of the arrows of a correction. */
const FADE_OUT_S = 0.5;

/** A drag reaches what the robot passes on this length of its path: while it stands, time goes by at once. */
const DRAG_RANGE_M = 3;
const DRAG_STEP_S = 0.04;
/** Preference for the direction of the drag: the ways out and back overlap. */
const DRAG_BIAS_M = 0.15;

export class Replay {
  readonly #story: Story;
  readonly #segments: Segment[] = [];

  constructor(story: Story) {
    this.#story = story;
    const { ticks, keyframes, turn, loops } = story;
    const turnTick = keyframes[turn] ?? 0;
    this.#drive(0, OUT_S, 0, turnTick, 0);
    let tick = turnTick;
    loops.forEach((loop, epoch) => {
      this.#drive(epoch === 0 ? 1 : 2, epoch === 0 ? BACK_S : BETWEEN_S, tick, loop.tick, epoch);
      if (epoch === 0) this.#drive(1, PAUSE_S, loop.tick, loop.tick, epoch);
      this.#add({ act: 2, fromTick: loop.tick, toTick: loop.tick, epoch, closes: true }, SNAP_S[epoch] ?? BETWEEN_S);
      tick = loop.tick;
    });
    this.#drive(2, BETWEEN_S, tick, ticks.length - 1, loops.length);
    this.#drive(2, END_S, ticks.length - 1, ticks.length - 1, loops.length);
  }

  /** Duration. */
  get lengthS(): number {
    return this.#segments.at(-1)?.toS ?? 0;
  }

  /** Start of each act. */
  get actsS(): number[] {
    return [0, 1, 2].map((act) => this.#segments.find((segment) => segment.act === act)?.fromS ?? 0);
  }

  /** The last moment before the first loop closes, with every wall twice. */
  get doubledS(): number {
    return (this.#segments.find((segment) => segment.closes)?.fromS ?? 0) - 0.01;
  }

  /** The state at a second of the replay. */
  at(seconds: number): Moment {
    const segment = this.#segments.find(({ toS }) => seconds < toS) ?? this.#segments.at(-1);
    if (segment === undefined) throw new RangeError('a lap without ticks');
    const share = clamp((seconds - segment.fromS) / (segment.toS - segment.fromS));
    const tick = segment.fromTick + share * (segment.toTick - segment.fromTick);
    const { ticks, loops } = this.#story;
    const wheels = ticks.slice(0, Math.floor(tick) + 1).map(({ wheels: pose }) => pose);
    const last = between(this.#tickAt(tick).wheels, this.#tickAt(tick + 1).wheels, tick % 1);
    const started = segment.epoch + (segment.closes ? 1 : 0);
    const robot = this.#robot(tick, segment, share);
    const toLeft = ZOOM.fromX - Math.max(last[0], robot[0]);
    return {
      act: segment.act,
      tick: Math.floor(tick + 1e-9),
      robot,
      keyframes: this.#poses(segment, tick, share),
      wheels: [...wheels, last],
      closed: loops.slice(0, started),
      moved: this.#moved(segment, seconds, tick),
      before: { poses: this.#story.epochs[0]?.poses ?? [], strength: ease((seconds - (this.lengthS - END_S)) / FADE_IN_S) },
      closeness: segment.act === 0 ? 0 : ease(toLeft / ZOOM.overM),
    };
  }

  /** The time near `seconds` at which the robot is nearest to a point; prefers later (`ahead` = 1) or earlier (−1) ones. */
  nearest([x, y]: Point, seconds: number, ahead: number): number {
    const here = this.at(seconds).robot;
    let best = { cost: Math.hypot(here[0] - x, here[1] - y), at: seconds };
    for (const direction of [1, -1]) {
      let [last, pathM] = [here, 0];
      for (let at = seconds + direction * DRAG_STEP_S; at >= 0 && at <= this.lengthS && pathM < DRAG_RANGE_M; at += direction * DRAG_STEP_S) {
        const { robot } = this.at(at);
        pathM += Math.hypot(robot[0] - last[0], robot[1] - last[1]);
        last = robot;
        const cost = Math.hypot(robot[0] - x, robot[1] - y) - DRAG_BIAS_M * direction * ahead;
        if (cost < best.cost) best = { cost, at };
      }
    }
    return best.at;
  }

  #drive(act: number, seconds: number, fromTick: number, toTick: number, epoch: number): void {
    this.#add({ act, fromTick, toTick, epoch, closes: false }, seconds);
  }

  #add(segment: Omit<Segment, 'fromS' | 'toS'>, seconds: number): void {
    const fromS = this.lengthS;
    this.#segments.push({ ...segment, fromS, toS: fromS + seconds });
  }

  #tickAt(tick: number): Story['ticks'][number] {
    const { ticks } = this.#story;
    const found = ticks[Math.min(Math.floor(tick), ticks.length - 1)];
    if (found === undefined) throw new RangeError('a lap without ticks');
    return found;
  }

  #countAt(tick: number): number {
    return this.#story.keyframes.filter((taken) => taken <= tick + 1e-9).length;
  }

  #poses({ epoch, closes }: Segment, tick: number, share: number): Pose[] {
    const { epochs } = this.#story;
    const before = epochs[epoch]?.poses.slice(0, this.#countAt(tick)) ?? [];
    if (!closes) return before;
    const after = epochs[epoch + 1]?.poses ?? [];
    return before.map((pose, node) => between(pose, after[node] ?? pose, snap(share)));
  }

  /** The estimated pose; at the tick of a loop, the pose of the corrected keyframe. */
  #robot(tick: number, segment: Segment, share: number): Pose {
    const isAtLoop = this.#story.loops[segment.epoch]?.tick === Math.floor(tick + 1e-9);
    const newest = () => this.#poses(segment, tick, share).at(-1) ?? this.#tickAt(tick).estimate;
    if (segment.closes || isAtLoop) return newest();
    const goal = this.#story.loops[segment.epoch];
    const next = goal?.tick === Math.floor(tick) + 1
      ? this.#story.epochs[segment.epoch]?.poses[this.#countAt(goal.tick) - 1]
      : undefined;
    return between(this.#tickAt(tick).estimate, next ?? this.#tickAt(tick + 1).estimate, tick % 1);
  }

  #moved(segment: Segment, seconds: number, tick: number): Moment['moved'] {
    const last = this.#segments.findLast(({ closes, fromS }) => closes && fromS <= seconds);
    if (last === undefined) return { from: [], strength: 0 };
    const from = this.#story.epochs[last.epoch]?.poses.slice(0, this.#countAt(Math.min(tick, last.toTick))) ?? [];
    const strength = segment === last ? 1 : 1 - clamp((seconds - last.toS) / FADE_OUT_S);
    return { from, strength };
  }
}

function clamp(share: number): number {
  return Math.min(Math.max(share, 0), 1);
}

function ease(share: number): number {
  const part = clamp(share);
  return part * part * (3 - 2 * part);
}

/** A late transition: first both walls are seen. */
function snap(share: number): number {
  return ease((share - 0.25) / 0.5);
}

/** Interpolates between two poses; the heading takes the shorter turn. */
export function between(from: Pose, to: Pose, share: number): Pose {
  const turn = Math.atan2(Math.sin(to[2] - from[2]), Math.cos(to[2] - from[2]));
  return [
    from[0] + share * (to[0] - from[0]),
    from[1] + share * (to[1] - from[1]),
    from[2] + share * turn,
  ];
}
