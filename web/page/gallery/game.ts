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
  // A widget that cannot run reports it itself.
  press('[data-undo]', () => void widget.press('take-back').catch(() => {}));
  press('[data-drive]', () => {
    widget.set('edit', 'off');
    void widget.press('reset').then(() => widget.press('play')).catch(() => {});
  });
  press('[data-all]', (button) => button.setAttribute('aria-expanded', String(game.classList.toggle('all'))));
  widget.addEventListener('slam-change', show);
  const enable = (isOn: boolean): void => {
    for (const button of game.querySelectorAll<HTMLButtonElement>('.game-tools button')) button.disabled = !isOn;
  };
  widget.addEventListener('slam-error', (event) => {
    const { kind } = (event as CustomEvent<{ kind: string }>).detail;
    if (kind === 'load' || kind === 'crash') enable(false);
  });
  widget.addEventListener('slam-ready', () => enable(true));
  void customElements.whenDefined('slam-widget').then(() => {
    // A link shows the lap that it names. Otherwise the pencil is in hand.
    const query = new URLSearchParams(location.search);
    if (query.has('w') && !query.has('edit')) widget.set('edit', 'off');
    show();
  });
}
