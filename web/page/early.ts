// Runs before the page is painted: what depends on a script, or on the chosen colours, does not change afterwards.

import { restrict } from '../ts/restrict';
import { chosenTheme, showTheme } from './theme-choice';

/** Set by the build: the oldest browsers, as in a sentence. */
declare const BROWSERS: string;

/** What the oldest browsers of the project have, and older ones lack, beside `:has`. */
const NEEDED: readonly (readonly [object, string])[] = [
  [Array.prototype, 'findLast'], [HTMLElement.prototype, 'inert'], [window, 'BroadcastChannel'], [window, 'DecompressionStream'],
  [window, 'MathMLElement'],
];

restrict(document.currentScript?.dataset['policy'] ?? '');
if (!CSS.supports('selector(:has(a))') || !NEEDED.every(([owner, name]) => name in owner)) {
  addEventListener('DOMContentLoaded', () => {
    const line = document.createElement('p');
    line.className = 'older';
    line.setAttribute('role', 'status');
    line.textContent = `This browser is older than the page needs: some figures do not move. Everything works in ${BROWSERS}, or a later version.`;
    const bar = document.querySelector('.bar');
    if (bar === null) document.body.prepend(line);
    else bar.after(line);
  });
}
document.documentElement.dataset['script'] = 'on';
showTheme(chosenTheme());
