// Tabulates the height of a widget over its width, adaptively: an interpolation error of a fraction of a line is invisible.

const NARROWEST_PX = 280;
const WIDEST_PX = 1400;
const STEP_PX = 40;
/** A quarter of a line of text: the table resolves every step by a line. */
const TOLERANCE_PX = 4;

/** Pairs of width and height in CSS pixels by ascending width; `heightAt` lays out the widget. */
export function heightTable(heightAt) {
  const at = (width) => [width, Math.ceil(heightAt(width))];
  const table = [at(NARROWEST_PX)];
  for (let width = NARROWEST_PX + STEP_PX; width <= WIDEST_PX; width += STEP_PX) {
    const next = at(width);
    table.push(...between(table.at(-1), next, at), next);
  }
  return table;
}

function between(low, high, at) {
  if (high[0] - low[0] < 2) return [];
  const middle = at(Math.floor((low[0] + high[0]) / 2));
  const share = (middle[0] - low[0]) / (high[0] - low[0]);
  if (Math.abs(middle[1] - (low[1] + share * (high[1] - low[1]))) <= TOLERANCE_PX) return [];
  return [...between(low, middle, at), middle, ...between(middle, high, at)];
}
