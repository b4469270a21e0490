// The algorithm beside the lap: the lines that ran in the tick on screen are lit.

import type { SlamWidget } from '../../ts/main';

/** Follows w16.2, whose fact `line` is the last line that ran. */
export function lightLines(): void {
  const lap = document.querySelector<SlamWidget>('slam-widget[name="w16.2"]');
  const lines = document.querySelectorAll<HTMLElement>('[data-lines] > li');
  if (lap === null || lines.length === 0) return;
  const show = (): void => {
    const last = Number(lap.outcome?.facts['line'] ?? 0);
    for (const [at, line] of lines.entries()) line.classList.toggle('ran', at < last);
  };
  for (const event of ['slam-ready', 'slam-change', 'slam-result']) lap.addEventListener(event, show);
}
