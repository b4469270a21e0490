// The still picture of the finished map: shown until its data have loaded, or without scripts.

import { type Building, draw, LOOPS } from './drawing';
import { type Inks, SvgSurface } from '../lap/surfaces';
import type { Point } from '../lap/story';

const [WIDTH, HEIGHT] = [900, 450];

/** The building with all loops, as an SVG. */
export function still(story: Building, inks: Inks): string {
  const surface = new SvgSurface(inks);
  // Most points share a pixel with another one: deduplication shrinks the file.
  const dots = surface.dots.bind(surface);
  surface.dots = (points, ...rest) => dots([...new Set(points.map((point) => point.map(Math.round).join()))].map((key) => key.split(',').map(Number) as unknown as Point), ...rest);
  draw(story, LOOPS, surface, WIDTH, HEIGHT);
  return surface.file(WIDTH, HEIGHT);
}
