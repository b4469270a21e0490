// The size of text: pictures follow the page's root, as all other text of a widget does.

/** The root's font size of browsers by default, px. */
const USUAL_ROOT_PX = 16;

/** How much larger the page's text is than usual. */
export function typeScale(): number {
  return parseFloat(getComputedStyle(document.documentElement).fontSize) / USUAL_ROOT_PX;
}
