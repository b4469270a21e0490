// After a jump to a widget elsewhere on the page: a button that returns to the sentence.

import { accent } from '../../crates/robots/robot_io/palette.json';
import { create } from './dom';

const STYLE = `
div { position: fixed; inset: auto auto 3rem 50%; translate: -50% 0; z-index: 5; display: flex; max-width: calc(100vw - 2rem);
  color: #fff; background: ${accent[0]}; border: 2px solid #fff; border-radius: 999px; box-shadow: 0 2px 8px #0006; }
button { font: 600 0.95rem/1.3 system-ui, sans-serif; color: inherit; background: none; border: 0; border-radius: 999px;
  padding: 0.6rem 0.4rem 0.6rem 1.2rem; min-height: 2.75rem; cursor: pointer; }
.close { min-width: 2.75rem; padding: 0 0.4rem 0 0; }
button:focus-visible { outline: 3px solid #fff; outline-offset: -5px; }
@media print { div { display: none; } }
`;
/** Distance in screens from the widget at which the button disappears: the reader has read on. */
const MAX_SCREENS = 2;

let end: (() => void) | undefined;

/**
 * Shows a button that scrolls from `target` back to `link`. It disappears once pressed or closed, if the link is in view
 * again, or if the reader scrolls on.
 */
export function showBackButton(link: HTMLElement, target: Element, name = `“${link.textContent?.trim() ?? ''}”`): void {
  hideBackButton();
  const host = create('div', { class: 'slam-way-back' });
  const style = create('style');
  style.textContent = STYLE;
  const box = create('div');
  const back = create('button', { type: 'button' });
  back.textContent = `Back to ${name}`;
  const close = create('button', { type: 'button', class: 'close', 'aria-label': 'Stay here' });
  close.textContent = '✕';
  box.append(back, close);
  host.attachShadow({ mode: 'open' }).append(style, box);
  let hasLeft = false;
  const seen = new IntersectionObserver((entries) => {
    const isSeen = entries.at(-1)?.isIntersecting === true;
    // The page scrolls only after the click: at first the link is still in view.
    if (isSeen && hasLeft) hideBackButton();
    hasLeft ||= !isSeen;
  });
  const listening = new AbortController();
  // Relative to the widget: pictures that load above it change the scroll position, too.
  const away = (): number => Math.abs(target.getBoundingClientRect().top);
  let hasArrived = false;
  window.addEventListener('scroll', () => {
    hasArrived ||= away() < window.innerHeight;
    if (hasArrived && away() > MAX_SCREENS * window.innerHeight) hideBackButton();
  }, { passive: true, signal: listening.signal });
  end = () => {
    seen.disconnect();
    listening.abort();
    host.remove();
  };
  back.addEventListener('click', () => {
    hideBackButton();
    link.scrollIntoView({ behavior: 'instant', block: 'center' });
    link.focus({ preventScroll: true });
  });
  close.addEventListener('click', hideBackButton);
  document.body.append(host);
  seen.observe(link);
}

export function hideBackButton(): void {
  end?.();
  end = undefined;
}
