// Buttons and arrow keys that zoom and pan the maps, as Ctrl and the wheel do on the canvas.

import { create } from './dom';

export type ViewChange = 'in' | 'out' | 'left' | 'right' | 'up' | 'down' | 'whole';

const BUTTONS: [ViewChange, string][] = [
  ['in', 'Zoom in'],
  ['out', 'Zoom out'],
  ['whole', 'Whole map'],
];
const ARROWS: Record<string, ViewChange> = {
  ArrowLeft: 'left',
  ArrowRight: 'right',
  ArrowUp: 'up',
  ArrowDown: 'down',
};

/** Three buttons; arrow keys pan. */
export function zoomButtons(change: (view: ViewChange) => void): HTMLElement {
  const bar = create('div', { class: 'zoom', role: 'group', 'aria-label': 'Zoom' });
  const help = create('span', { class: 'hidden', id: 'help-zoom' });
  help.textContent = 'Acts on every map of the widget; the arrow keys move a zoomed map.';
  for (const [view, label] of BUTTONS) {
    const button = create('button', { type: 'button', 'aria-describedby': help.id });
    button.textContent = label;
    button.addEventListener('click', () => change(view));
    bar.append(button);
  }
  bar.append(help);
  bar.addEventListener('keydown', (event) => {
    const view = ARROWS[event.key];
    if (view === undefined) return;
    event.preventDefault();
    change(view);
  });
  return bar;
}
