// After a jump to a widget elsewhere on the page, offers to return to the sentence.

import { accent } from '../../widgets/palette.json';
import { create } from './dom';

const STYLE = `
button { position: fixed; inset: auto auto 1rem 50%; translate: -50% 0; z-index: 5; max-width: calc(100vw - 2rem);
  font: 600 0.95rem/1.3 system-ui, sans-serif; color: #fff; background: ${accent[0]}; border: 2px solid #fff;
  border-radius: 999px; padding: 0.6rem 1.2rem; min-height: 2.75rem; cursor: pointer; box-shadow: 0 2px 8px #0006; }
button:focus-visible { outline: 3px solid ${accent[0]}; outline-offset: 2px; }
@media print { button { display: none; } }
`;

let end: (() => void) | undefined;

/** Shows the way back to a link, or to what has a name, until it was gone, or the place is seen again. */
export function offerWayBack(link: HTMLElement, name = `“${link.textContent?.trim() ?? ''}”`): void {
  endWayBack();
  const host = create('div', { class: 'slam-way-back' });
  const style = create('style');
  style.textContent = STYLE;
  const button = create('button', { type: 'button' });
  button.textContent = `Back to ${name}`;
  host.attachShadow({ mode: 'open' }).append(style, button);
  let hasLeft = false;
  const seen = new IntersectionObserver((entries) => {
    const isSeen = entries.at(-1)?.isIntersecting === true;
    // The page scrolls only after the click: the sentence is still visible at first.
    if (isSeen && hasLeft) endWayBack();
    hasLeft ||= !isSeen;
  });
  end = () => {
    seen.disconnect();
    host.remove();
  };
  button.addEventListener('click', () => {
    endWayBack();
    link.scrollIntoView({ behavior: 'instant', block: 'center' });
    link.focus({ preventScroll: true });
  });
  document.body.append(host);
  seen.observe(link);
}

export function endWayBack(): void {
  end?.();
  end = undefined;
}
