// The finished map as the build draws it: shown until the data arrives, and for pages without script.

import { type Building, draw, LOOPS } from './drawing';
import { type Inks, SvgSurface } from '../lap/surfaces';
import type { Point } from '../lap/story';

const [WIDTH, HEIGHT] = [900, 450];

/** The building with all loops, as an SVG. */
export function still(story: Building, inks: Inks): string {
  const surface = new SvgSurface(inks);
  // Most points fall onto a pixel that has one.
  const dots = surface.dots.bind(surface);
  surface.dots = (points, ...rest) => dots([...new Set(points.map((point) => point.map(Math.round).join()))].map((key) => key.split(',').map(Number) as unknown as Point), ...rest);
  draw(story, LOOPS, surface, WIDTH, HEIGHT);
  return surface.file(WIDTH, HEIGHT);
}
