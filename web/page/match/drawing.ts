// The SVG of the matcher, with the two sweeps of a room. The build puts that of the first room into the page; the script
// moves the source sweep.

import type { Point, Pose } from '../world/surfaces';

export interface Answer {
  /** The true pose of the source sweep. */
  truth: Pose;
  /** Tolerances in metres and degrees. */
  home: [number, number];
}

/** The output of the module's `PageMatcher.scene`. */
export interface Scene extends Answer {
  target: number[];
  source: number[];
}

/** A room of the chain. */
export interface Room {
  /** As the module and the page's address name it. */
  name: string;
  /** The first words on entering it. */
  hint: string;
  /** The visible square in metres: left, top, side; a wide picture shows more at its sides. */
  view: [number, number, number];
  /** Initial offset of the source in metres and degrees: outside of ICP's basin of convergence, so the reader has to help. */
  off: Pose;
}

export const ROOMS: readonly [Room, ...Room[]] = [
  { name: 'room', hint: 'A room.', view: [-1.9, 5.2, 7.2], off: [-0.6, 0.75, 48] },
  { name: 'corridor', hint: 'The corridor where the lap closes its first loop. Only its doors show how far along you are.', view: [3.4, 8, 7.2], off: [-1.2, 0.3, 12] },
  { name: 'hall', hint: 'A round hall of 36 walls. Turned by one wall, it fits just as well.', view: [-0.2, 7.2, 7.4], off: [-0.9, 0.8, 35] },
  { name: 'twins', hint: 'Two identical rooms. One door further on, it fits nearly as well.', view: [2.4, 5.2, 7.2], off: [-1.3, 0.2, 8] },
];
/** Radius of the ring that turns the source. */
const RING_M = 1.3;
/** Half the size of a cross. */
const MARK_M = 0.06;

export function startOf({ truth: [x, y, heading] }: Answer, { off: [right, up, degrees] }: Room): Pose {
  return [x + right, y + up, heading + (degrees * Math.PI) / 180];
}

/** The SVG transform of a pose, with y up. */
export function placedAt([x, y, heading]: Pose): string {
  return `translate(${x} ${y}) rotate(${(heading * 180) / Math.PI})`;
}

/** The SVG of the first room. */
export function drawing(scene: Scene): string {
  return `<svg viewBox="${viewBox(ROOMS[0])}" tabindex="-1" role="application"
      aria-labelledby="match-name" aria-describedby="match-keys match-says">${sweeps(scene, ROOMS[0])}</svg>`;
}

export function viewBox({ view: [left, top, side] }: Room): string {
  return `${left} ${-top} ${side} ${side}`;
}

/** The contents of the SVG with the source at its first pose. */
export function sweeps(scene: Scene, room: Room): string {
  const crosses = points(scene.target).map(([x, y]) => {
    const [m, span] = [MARK_M, 2 * MARK_M];
    return `M${short(x - m)} ${short(y - m)}l${span} ${span}m0-${span}l-${span} ${span}`;
  });
  const squares = points(scene.source).map(([x, y]) => `M${short(x)} ${short(y)}h0`).join('');
  const at = placedAt(startOf(scene, room));
  return `<title id="match-name">Two sweeps of one room, to be aligned</title>
      <g transform="scale(1 -1)">
        <path class="match-target" d="${crosses.join('')}"/>
        <path class="match-source match-left" d="${squares}" transform="${at}" visibility="hidden"/>
        <path class="match-pairs" d=""/>
        <g class="match-moved" transform="${at}">
          <path class="match-source" d="${squares}"/>
          <circle class="match-grab" data-grab="move" r="${RING_M}"/>
          <path class="match-grab match-near" data-grab="move" d="${squares}"/>
          <circle class="match-ring" r="${RING_M}"/>
          <circle class="match-grab match-near" data-grab="turn" r="${RING_M}"/>
          <circle class="match-knob" data-grab="turn" cx="${RING_M}" r="0.15"/>
          <path class="match-robot" d="M0.22 0L-0.15 0.14V-0.14Z"/>
        </g>
      </g>`;
}

/** A line from each point of the source to the nearest of the target within the reach, which ICP pairs it with. */
export function pairLines({ target, source }: Scene, [x, y, heading]: Pose, reachM: number): string {
  const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
  const targets = points(target);
  const line = ([along, aside]: Point): string => {
    const from: Point = [x + cos * along - sin * aside, y + sin * along + cos * aside];
    const far = ([toX, toY]: Point): number => Math.hypot(toX - from[0], toY - from[1]);
    const nearest = targets.reduce((best, one) => (far(one) < far(best) ? one : best), targets[0] ?? from);
    return far(nearest) <= reachM ? `M${from.map(short).join(' ')}L${nearest.map(short).join(' ')}` : '';
  };
  return points(source).map(line).join('');
}

function points(numbers: readonly number[]): Point[] {
  return Array.from({ length: numbers.length / 2 }, (_, at) => [numbers[2 * at] ?? 0, numbers[2 * at + 1] ?? 0]);
}

/** Rounds to millimetres. */
function short(metres: number): number {
  return Number(metres.toFixed(3));
}
