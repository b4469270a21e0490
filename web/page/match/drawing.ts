// The SVG of the matcher, with the two sweeps of a room. The build puts that of the first room into the page; the script
// moves the source sweep.

import { floor, robot, type Segment, seen, threads } from '../world/plan';
import type { Point, Pose } from '../world/surfaces';
import { inMetres, METRES } from '../world/svg';

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
/** Opacity of the area of the sweep in the hand at the sensor, and at a distance, m. */
const SEEN = { alphas: [0.27, 0.13], rangeM: 3.2 } as const;
const POINT_PX = 2.4;
/** Radius in which a finger takes the knob. */
const FINGER_M = 22 / METRES.pxPerM;

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
  const [target, source] = [points(scene.target), points(scene.source)];
  const targets = target.map(METRES.to);
  const sources = source.map(METRES.to);
  const at = placedAt(startOf(scene, room));
  const grabs = source.map(([x, y]) => `M${short(x)} ${short(y)}h0`).join('');
  // The order of the points is that of the beams.
  return `<title id="match-name">Two sweeps of one room, to be aligned</title>
      <g transform="scale(1 -1)">
        ${inMetres((surface) => floor(surface, METRES, target))}
        <g class="match-moved" transform="${at}">${inMetres((surface) => seen(surface, METRES, [0, 0], source, 'posterior', SEEN.alphas, SEEN.rangeM))}</g>
        <g class="match-target">${inMetres((surface) => surface.discs(targets, 'measurement', POINT_PX))}</g>
        <g class="match-left" transform="${at}" visibility="hidden">${inMetres((surface) => surface.discs(sources, 'posterior', POINT_PX))}</g>
        <path class="match-pairs" d=""/>
        <g class="match-threads"></g>
        <g class="match-moved" transform="${at}">
          <g class="match-source">${inMetres((surface) => {
            surface.discs(sources, 'paper', POINT_PX + 0.6);
            surface.discs(sources, 'posterior', POINT_PX);
          })}</g>
          <circle class="match-grab" data-grab="move" r="${RING_M}"/>
          <path class="match-grab match-near" data-grab="move" d="${grabs}"/>
          <circle class="match-ring" r="${RING_M}"/>
          <circle class="match-grab match-near" data-grab="turn" r="${RING_M}"/>
          <circle class="match-halo" cx="${RING_M}" r="0.3"/>
          <circle class="match-grab" data-grab="turn" cx="${RING_M}" r="${FINGER_M}"/>
          <circle class="match-knob" data-grab="turn" cx="${RING_M}" r="0.17"/>
          <g class="match-robot">${inMetres((surface) => robot(surface, METRES, [0, 0, 0], 'posterior'))}</g>
        </g>
      </g>`;
}

/** The pairs of ICP, each from a point of the source to the nearest of the target within the reach: their lines, and drawn. */
export function pairLines({ target, source }: Scene, [x, y, heading]: Pose, reachM: number): { lines: string; threads: string } {
  const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
  const targets = points(target);
  const pairs = points(source).flatMap(([along, aside]): Segment[] => {
    const from: Point = [x + cos * along - sin * aside, y + sin * along + cos * aside];
    const far = ([toX, toY]: Point): number => Math.hypot(toX - from[0], toY - from[1]);
    const nearest = targets.reduce((best, one) => (far(one) < far(best) ? one : best), targets[0] ?? from);
    return far(nearest) <= reachM ? [[from, nearest]] : [];
  });
  return {
    lines: pairs.map(([from, to]) => `M${from.map(short).join(' ')}L${to.map(short).join(' ')}`).join(''),
    threads: inMetres((surface) => threads(surface, METRES, pairs, reachM)),
  };
}

function points(numbers: readonly number[]): Point[] {
  return Array.from({ length: numbers.length / 2 }, (_, at) => [numbers[2 * at] ?? 0, numbers[2 * at + 1] ?? 0]);
}

/** Rounds to millimetres. */
function short(metres: number): number {
  return Number(metres.toFixed(3));
}
