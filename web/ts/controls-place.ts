// Keeps the controls below the picture if More opens plots: they stand in a gap of the canvas above those plots.

import type { Parts } from './parts';

/** Puts the controls at the end of the picture's own part, if the canvas goes on below it. */
export function placeControls({ controls, rest, stage }: Parts, stageHeight: number): void {
  const wasSplit = controls.style.top !== '';
  const isSplit = !rest.hidden && stageHeight < stage.clientHeight - 1;
  if (!isSplit) {
    if (wasSplit) controls.style.top = controls.style.marginBottom = '';
    return;
  }
  const moved = parseFloat(controls.style.top) || 0;
  const away = stage.getBoundingClientRect().top + stageHeight - controls.getBoundingClientRect().top;
  if (!wasSplit || Math.abs(away) > 0.5) controls.style.top = `${moved + away}px`;
  // What follows takes the room that they leave.
  controls.style.marginBottom = `${-controls.offsetHeight}px`;
}
