// The SVG of the first figure, with its two sweeps. The build puts it into the page; the script moves the source sweep.

import type { Pose } from '../lap/story';

export interface Answer {
  /** The true pose of the source sweep. */
  truth: Pose;
  /** Tolerances in metres and degrees. */
  home: [number, number];
}

/** The output of the module's `matcherScene`. */
export interface Scene extends Answer {
  target: number[];
  source: number[];
}

/** The visible square, in metres; a wide picture shows more at its sides. */
const VIEW = { left: -1.9, top: 5.2, side: 7.2 };
/** Radius of the ring that turns the source. */
const RING_M = 1.3;
/** Half the size of a cross. */
const MARK_M = 0.06;
/** Initial offset of the source: outside of ICP's basin of convergence, so the reader has to help. */
const START_OFF = { x: -0.6, y: 0.75, degrees: 48 };

export function startOf({ truth: [x, y, heading] }: Answer): Pose {
  return [x + START_OFF.x, y + START_OFF.y, heading + (START_OFF.degrees * Math.PI) / 180];
}

/** The SVG transform of a pose, with y up. */
export function placedAt([x, y, heading]: Pose): string {
  return `translate(${x} ${y}) rotate(${(heading * 180) / Math.PI})`;
}

/** The SVG with the source at its first pose. */
export function drawing(scene: Scene): string {
  const crosses = points(scene.target).map(([x, y]) => {
    const [m, span] = [MARK_M, 2 * MARK_M];
    return `M${short(x - m)} ${short(y - m)}l${span} ${span}m0-${span}l-${span} ${span}`;
  });
  const squares = points(scene.source).map(([x, y]) => `M${short(x)} ${short(y)}h0`).join('');
  const at = placedAt(startOf(scene));
  return `<svg viewBox="${VIEW.left} ${-VIEW.top} ${VIEW.side} ${VIEW.side}" tabindex="-1" role="application"
      aria-labelledby="match-name" aria-describedby="match-keys match-says">
      <title id="match-name">Two sweeps of one room, to be laid on each other</title>
      <g transform="scale(1 -1)">
        <path class="match-target" d="${crosses.join('')}"/>
        <path class="match-source match-left" d="${squares}" transform="${at}" visibility="hidden"/>
        <g class="match-moved" transform="${at}">
          <path class="match-source" d="${squares}"/>
          <circle class="match-grab" data-grab="move" r="${RING_M}"/>
          <path class="match-grab match-near" data-grab="move" d="${squares}"/>
          <circle class="match-ring" r="${RING_M}"/>
          <circle class="match-grab match-near" data-grab="turn" r="${RING_M}"/>
          <circle class="match-knob" data-grab="turn" cx="${RING_M}" r="0.15"/>
          <path class="match-robot" d="M0.22 0L-0.15 0.14V-0.14Z"/>
        </g>
      </g>
    </svg>`;
}

function points(numbers: readonly number[]): [number, number][] {
  return Array.from({ length: numbers.length / 2 }, (_, at) => [numbers[2 * at] ?? 0, numbers[2 * at + 1] ?? 0]);
}

/** Rounds to millimetres. */
function short(metres: number): number {
  return Number(metres.toFixed(3));
}
