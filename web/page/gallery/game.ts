// Break my SLAM: tools to draw a flat with, and Drive.

import type { SlamWidget } from '../../ts/main';

/** Lets the buttons of the game set the widget, whose own controls are hidden until the reader asks for all of them. */
export function startGame(game: HTMLElement, widget: SlamWidget): void {
  const tools = [...game.querySelectorAll<HTMLButtonElement>('[data-tool]')];
  const show = (): void => {
    const held = widget.get('edit');
    for (const button of tools) button.setAttribute('aria-pressed', String(button.dataset['tool'] === held));
  };
  const press = (css: string, act: (button: HTMLButtonElement) => void): void => {
    const button = game.querySelector<HTMLButtonElement>(css);
    button?.addEventListener('click', () => act(button));
  };
  for (const button of tools) button.addEventListener('click', () => widget.set('edit', button.dataset['tool'] ?? 'off'));
  press('[data-undo]', () => void widget.press('take-back'));
  press('[data-drive]', () => {
    widget.set('edit', 'off');
    void widget.press('reset').then(() => widget.press('play'));
  });
  press('[data-all]', (button) => button.setAttribute('aria-expanded', String(game.classList.toggle('all'))));
  widget.addEventListener('slam-change', show);
  void customElements.whenDefined('slam-widget').then(() => {
    // A link shows the lap that it names. Otherwise the pencil is in hand.
    const query = new URLSearchParams(location.search);
    if (query.has('w') && !query.has('edit')) widget.set('edit', 'off');
    show();
  });
}
