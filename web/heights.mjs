// The height of a widget at each width: enough widths for an error below a fraction of a line.

const NARROWEST_PX = 280;
const WIDEST_PX = 1400;
const STEP_PX = 40;
/** A line of text is four times as high: a height that falls by one is seen from either side. */
const TOLERANCE_PX = 4;

/** Pairs of width and height in CSS pixels, ascending, from a function that lays out the widget. */
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
