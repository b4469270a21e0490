// Ctrl and the wheel on the canvas, for the keyboard: zoom, and move what is zoomed.

import { create } from './dom';

export type Way = 'in' | 'out' | 'left' | 'right' | 'up' | 'down' | 'whole';

const BUTTONS: [Way, string][] = [
  ['in', 'Zoom in'],
  ['out', 'Zoom out'],
  ['whole', 'Whole map'],
];
const ARROWS: Record<string, Way> = {
  ArrowLeft: 'left',
  ArrowRight: 'right',
  ArrowUp: 'up',
  ArrowDown: 'down',
};

/** Three buttons, seen while one of them has the focus; the arrow keys move. */
export function lookBar(look: (way: Way) => void): HTMLElement {
  const bar = create('div', { class: 'control', role: 'group', 'aria-label': 'Zoom' });
  const line = create('span', { class: 'line' });
  const help = create('span', { class: 'help', id: 'help-zoom' });
  help.textContent = 'Acts on every map of the widget; the arrow keys move a zoomed map.';
  for (const [way, label] of BUTTONS) {
    const button = create('button', { type: 'button', 'aria-describedby': help.id });
    button.textContent = label;
    button.addEventListener('click', () => look(way));
    line.append(button);
  }
  bar.append(line, help);
  bar.addEventListener('keydown', (event) => {
    const way = ARROWS[event.key];
    if (way === undefined) return;
    event.preventDefault();
    look(way);
  });
  return bar;
}
