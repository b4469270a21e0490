// The still picture of the strip: shown until its script has started, or without scripts.

import type { Inks, Surface } from '../world/surfaces';
import { SvgSurface } from '../world/svg';
import { ASPECT, draw } from './drawing';
import { Replay, type Story } from './story';

const WIDTH = 900;
/** As wide as a soft dot. */
const CELL_PX = 4;

/** The moment before the first loop closes, as an SVG. */
export function still(story: Story, inks: Inks): string {
  const surface = new SvgSurface(inks, CELL_PX);
  drawDoubled(story, surface, WIDTH);
  return surface.file(WIDTH, WIDTH / ASPECT);
}

/** Draws that moment, as wide as given. */
export function drawDoubled(story: Story, surface: Surface, width: number): void {
  const replay = new Replay(story);
  draw(story, replay.at(replay.doubledS), surface, width);
}
