// The lap as the module computes it, and what its replay shows at each second.

/** `[x, y, θ]`, metres and radians, in the frame of the world. */
export type Pose = readonly [number, number, number];
/** `[x, y]` in metres. */
export type Point = readonly [number, number];

/** What `lapStory` of the module writes. */
export interface Story {
  walls: [number, number, number, number][];
  ticks: { truth: Pose; wheels: Pose; estimate: Pose; sweep: number[] }[];
  /** The tick of each keyframe. */
  keyframes: number[];
  /** Poses of all keyframes from a tick on. */
  epochs: { tick: number; poses: Pose[] }[];
  loops: { tick: number; from: number; to: number; shift: number }[];
  /** The last keyframe of the way out. */
  turn: number;
}

/** Either the robot drives, or a loop moves what is behind it. */
interface Stretch {
  act: number;
  fromS: number;
  toS: number;
  fromTick: number;
  toTick: number;
  /** The epoch whose poses hold; while a loop closes, the one before it. */
  epoch: number;
  closes: boolean;
}

/** Everything that a picture of one moment needs. */
export interface Moment {
  act: number;
  tick: number;
  robot: Pose;
  keyframes: readonly Pose[];
  /** The wheels' way so far. */
  wheels: readonly Point[];
  /** The loops that are closed, as numbers of keyframes. */
  closed: readonly { from: number; to: number }[];
  /** Where keyframes came from that a loop has just moved; stronger where it was just now. */
  moved: { from: readonly Pose[]; strength: number };
  /** At the end the walls stand as they did before the first loop, too; stronger as it comes. */
  before: { poses: readonly Pose[]; strength: number };
  /** How close the picture looks: 0 at the whole flat, 1 at where the walls meet again. */
  closeness: number;
}

/** Seconds of the replay: out, back, and what each loop and each way to the next one takes. */
const OUT_S = 3.4;
const BACK_S = 2.5;
const SNAP_S = [1.1, 0.6, 0.6];
const BETWEEN_S = 0.5;
/** Before the first loop the doubled walls stand for a moment, and at the end the mended map. */
const PAUSE_S = 0.5;
const END_S = 1.2;
/** On the way back the picture comes closer, from where both robots are left of this, over so many metres. */
const APPROACH = { fromX: 9.6, overM: 1.2 };
/** At the end the walls of before appear over so long. */
const GHOST_S = 0.6;
/** So long one sees whence the keyframes came. */
const TRACE_S = 0.5;

/** A hand moves the robot by so much of the replay at once; out and back lie on each other, so it goes on as it went. */
const HAND_S = 0.8;
const HAND_STEP_S = 0.04;
const HAND_BIAS_M = 0.15;

export class Replay {
  readonly #story: Story;
  readonly #stretches: Stretch[] = [];

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

  /** How long it takes, in seconds. */
  get lengthS(): number {
    return this.#stretches.at(-1)?.toS ?? 0;
  }

  /** When each of the acts begins, in seconds. */
  get actsS(): number[] {
    return [0, 1, 2].map((act) => this.#stretches.find((stretch) => stretch.act === act)?.fromS ?? 0);
  }

  /** The last moment at which every wall still stands twice. */
  get doubledS(): number {
    return (this.#stretches.find((stretch) => stretch.closes)?.fromS ?? 0) - 0.01;
  }

  /** What stands at a second of the replay. */
  at(seconds: number): Moment {
    const stretch = this.#stretches.find(({ toS }) => seconds < toS) ?? this.#stretches.at(-1);
    if (stretch === undefined) throw new RangeError('a lap without ticks');
    const share = clamp((seconds - stretch.fromS) / (stretch.toS - stretch.fromS));
    const tick = stretch.fromTick + share * (stretch.toTick - stretch.fromTick);
    const { ticks, loops } = this.#story;
    const wheels = ticks.slice(0, Math.floor(tick) + 1).map(({ wheels: [x, y] }): Point => [x, y]);
    const [x, y] = between(this.#tickAt(tick).wheels, this.#tickAt(tick + 1).wheels, tick % 1);
    const started = stretch.epoch + (stretch.closes ? 1 : 0);
    const robot = this.#robot(tick, stretch, share);
    const toLeft = APPROACH.fromX - Math.max(x, robot[0]);
    return {
      act: stretch.act,
      tick: Math.floor(tick + 1e-9),
      robot,
      keyframes: this.#poses(stretch, tick, share),
      wheels: [...wheels, [x, y]],
      closed: loops.slice(0, started),
      moved: this.#moved(stretch, seconds, tick),
      before: { poses: this.#story.epochs[0]?.poses ?? [], strength: ease((seconds - (this.lengthS - END_S)) / GHOST_S) },
      closeness: stretch.act === 0 ? 0 : ease(toLeft / APPROACH.overM),
    };
  }

  /** The second near another at which the robot is nearest to a point; between equals the one `ahead` (1) or before (−1). */
  nearest([x, y]: Point, seconds: number, ahead: number): number {
    let best = { cost: Infinity, at: seconds };
    for (let at = Math.max(seconds - HAND_S, 0); at <= Math.min(seconds + HAND_S, this.lengthS); at += HAND_STEP_S) {
      const { robot } = this.at(at);
      const cost = Math.hypot(robot[0] - x, robot[1] - y) - HAND_BIAS_M * Math.sign(at - seconds) * ahead;
      if (cost < best.cost) best = { cost, at };
    }
    return best.at;
  }

  #drive(act: number, seconds: number, fromTick: number, toTick: number, epoch: number): void {
    this.#add({ act, fromTick, toTick, epoch, closes: false }, seconds);
  }

  #add(stretch: Omit<Stretch, 'fromS' | 'toS'>, seconds: number): void {
    const fromS = this.lengthS;
    this.#stretches.push({ ...stretch, fromS, toS: fromS + seconds });
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

  #poses({ epoch, closes }: Stretch, tick: number, share: number): Pose[] {
    const { epochs } = this.#story;
    const before = epochs[epoch]?.poses.slice(0, this.#countAt(tick)) ?? [];
    if (!closes) return before;
    const after = epochs[epoch + 1]?.poses ?? [];
    return before.map((pose, node) => between(pose, after[node] ?? pose, snap(share)));
  }

  /** Where the estimate puts it; at the tick of a loop it stands at the keyframe that is moved. */
  #robot(tick: number, stretch: Stretch, share: number): Pose {
    const isAtLoop = this.#story.loops[stretch.epoch]?.tick === Math.floor(tick + 1e-9);
    const newest = () => this.#poses(stretch, tick, share).at(-1) ?? this.#tickAt(tick).estimate;
    if (stretch.closes || isAtLoop) return newest();
    const goal = this.#story.loops[stretch.epoch];
    const next = goal?.tick === Math.floor(tick) + 1
      ? this.#story.epochs[stretch.epoch]?.poses[this.#countAt(goal.tick) - 1]
      : undefined;
    return between(this.#tickAt(tick).estimate, next ?? this.#tickAt(tick + 1).estimate, tick % 1);
  }

  #moved(stretch: Stretch, seconds: number, tick: number): Moment['moved'] {
    const last = this.#stretches.findLast(({ closes, fromS }) => closes && fromS <= seconds);
    if (last === undefined) return { from: [], strength: 0 };
    const from = this.#story.epochs[last.epoch]?.poses.slice(0, this.#countAt(Math.min(tick, last.toTick))) ?? [];
    const strength = stretch === last ? 1 : 1 - clamp((seconds - last.toS) / TRACE_S);
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

/** It stands for a moment, and then goes at once: a loop snaps. */
function snap(share: number): number {
  return ease((share - 0.25) / 0.5);
}

/** A pose on the way from one to another; the heading turns the shorter way. */
export function between(from: Pose, to: Pose, share: number): Pose {
  const turn = Math.atan2(Math.sin(to[2] - from[2]), Math.cos(to[2] - from[2]));
  return [
    from[0] + share * (to[0] - from[0]),
    from[1] + share * (to[1] - from[1]),
    from[2] + share * turn,
  ];
}
