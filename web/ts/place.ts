// The room that a widget takes before its first frame and while it rests: the text around it stays
// where it is when the canvas comes and goes.

/** Widths of a canvas with the heights that the widget needs there, in CSS pixels, ascending. */
export type Heights = readonly (readonly [width: number, height: number])[];

export class Place {
  readonly #stage: HTMLElement;
  #heights: Heights = [];
  #kept: { width: number; height: number } | undefined;

  constructor(stage: HTMLElement) {
    this.#stage = stage;
  }

  /** A widget comes: so high it will be at its defaults. */
  reserve(heights: Heights): void {
    this.#heights = heights;
    this.#kept = undefined;
    this.fit();
  }

  /** The canvas goes: its picture takes as much room. */
  keep(): void {
    const { clientWidth: width, clientHeight: height } = this.#stage;
    this.#kept = { width, height };
    this.fit();
  }

  /** The width may have changed, or the height that the page has for it. */
  fit(): void {
    const width = this.#stage.clientWidth;
    if (width === 0) return;
    const height = this.#kept?.width === width ? this.#kept.height : heightAt(this.#heights, width);
    if (height === undefined) this.free();
    else this.#stage.style.setProperty('--place', `${Math.min(height, this.room)}px`);
  }

  /** What the page has for the canvas: infinite where the element has no `max-height` in its style. */
  get room(): number {
    const frame = this.#stage.parentElement;
    const { host } = this.#stage.getRootNode() as ShadowRoot;
    const most = getComputedStyle(host).maxHeight;
    if (frame === null || !most.endsWith('px')) return Infinity;
    return parseFloat(most) - (frame.offsetHeight - this.#stage.offsetHeight);
  }

  /** Nothing will be drawn: the picture takes the room that it likes. */
  free(): void {
    this.#stage.style.removeProperty('--place');
  }
}

/** Between two widths of the table in proportion, beyond its ends as at them. */
function heightAt(heights: Heights, width: number): number | undefined {
  const next = heights.findIndex(([known]) => known >= width);
  const [below, above] = [heights.at(next - 1), heights.at(next)];
  if (next <= 0 || below === undefined || above === undefined) return heights.at(Math.min(next, 0))?.[1];
  const share = (width - below[0]) / (above[0] - below[0]);
  return Math.round(below[1] + share * (above[1] - below[1]));
}
