// Brings an element to the top of the screen and holds it there while the page around it still
// grows: pictures arrive, widgets start. The reader's first move ends it.

let end: (() => void) | undefined;

/** What a reader does to move, or to stay. */
const MOVES = ['wheel', 'touchstart', 'pointerdown', 'keydown'];

/** A scroll of less is the rounding of ours. */
const SLACK_PX = 2;

/** At once, and again whenever the page changes its height, until the reader does something. */
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
    // A smooth scroll would aim at where the element was when it began.
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
      // A scroll bar, or a search in the page: nothing grew, and yet it moved.
      if (movedPx > SLACK_PX && document.documentElement.scrollHeight === pageHeightPx) stop();
    },
    options,
  );
  end = stop;
  align();
  heights.observe(document.body);
}
