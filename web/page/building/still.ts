// The still picture of the finished map: shown until its data have loaded, or without scripts.

import type { Inks } from '../world/surfaces';
import { SvgSurface } from '../world/svg';
import { type Building, draw, LOOPS } from './drawing';

const [WIDTH, HEIGHT] = [900, 450];

/** The building with all loops, as an SVG. */
export function still(story: Building, inks: Inks): string {
  const surface = new SvgSurface(inks, 1);
  draw(story, LOOPS, surface, WIDTH, HEIGHT);
  return surface.file(WIDTH, HEIGHT);
}
