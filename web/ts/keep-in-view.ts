// Scrolls an element to the top of the screen and keeps it there while the page around it still grows,
// because pictures arrive and widgets start. Any input of the reader ends it.

let end: (() => void) | undefined;

/** Input with which a reader moves, or stays. */
const MOVES = ['wheel', 'touchstart', 'pointerdown', 'keydown'];

/** A smaller scroll is rounding. */
const SLACK_PX = 2;

/** Scrolls at once, and again whenever the page changes its height, until the reader's first input. */
export function keepInView(element: Element): void {
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
    // A smooth scroll would aim at the position at its beginning.
    element.scrollIntoView({ behavior: 'instant', block: 'start' });
    alignedPx = element.getBoundingClientRect().top;
    pageHeightPx = document.documentElement.scrollHeight;
  };
  const options = { capture: true, passive: true, signal: listening.signal };
  for (const move of MOVES) window.addEventListener(move, stop, options);
  window.addEventListener('popstate', stop, options);
  window.addEventListener(
    'scroll',
    () => {
      const movedPx = Math.abs(element.getBoundingClientRect().top - alignedPx);
      // A movement without a change of height: a scroll bar, or a search in the page.
      if (movedPx > SLACK_PX && document.documentElement.scrollHeight === pageHeightPx) stop();
    },
    options,
  );
  end = stop;
  align();
  heights.observe(document.body);
}
