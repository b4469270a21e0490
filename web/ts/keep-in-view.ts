// Scrolls to an element, and repeats that after layout shifts: pictures load, widgets start, verdicts grow. Any input of
// the reader ends it.

let end: (() => void) | undefined;

/** Input of a reader. */
const INPUT_EVENTS = ['wheel', 'touchstart', 'pointerdown', 'keydown'];

/** Smaller movements are rounding. */
const SLACK_PX = 2;

/** Keeps an element at the top of the viewport. */
export function keepInView(element: Element): void {
  // A smooth scroll would miss an element that shifts meanwhile.
  keep(element, () => element.scrollIntoView({ behavior: 'instant', block: 'start' }));
}

/** Keeps the end of something in the viewport, if all of it fits there. */
export function keepEndInView(start: Element, end: Element): void {
  keep(end, () => {
    const { bottom } = end.getBoundingClientRect();
    const fits = bottom - start.getBoundingClientRect().top <= window.innerHeight;
    if (fits && bottom > window.innerHeight) end.scrollIntoView({ behavior: 'instant', block: 'nearest' });
  });
}

/** Scrolls at once, and again whenever the page changes its height, until the reader's first input. */
function keep(element: Element, scroll: () => void): void {
  end?.();
  const listening = new AbortController();
  const heights = new ResizeObserver(() => align());
  const stop = (): void => {
    heights.disconnect();
    listening.abort();
  };
  let alignedPx = 0;
  let pageHeightPx = 0;
  const align = (): void => {
    scroll();
    alignedPx = element.getBoundingClientRect().top;
    pageHeightPx = document.documentElement.scrollHeight;
  };
  const options = { capture: true, passive: true, signal: listening.signal };
  for (const type of INPUT_EVENTS) window.addEventListener(type, stop, options);
  window.addEventListener('popstate', stop, options);
  window.addEventListener(
    'scroll',
    () => {
      const movedPx = Math.abs(element.getBoundingClientRect().top - alignedPx);
      // A scroll without a layout shift comes from the reader: the scroll bar, or a search in the page.
      if (movedPx > SLACK_PX && document.documentElement.scrollHeight === pageHeightPx) stop();
    },
    options,
  );
  end = stop;
  align();
  heights.observe(document.body);
}
