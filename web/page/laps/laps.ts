// A thousand laps as dots: at four levels of odometry noise, by the front end alone and with loops. They run in the page
// while the figure is in view.

import { WorkerPool, type Core } from './worker-pool';
import { LEVELS, type Lap } from './protocol';
import { nameOf, Strip, type Kind } from './strip';

const KINDS: Kind[] = ['frontEnd', 'withLoops'];
/** The last tick of the lap. */
const LAST_TICK = 129;

export class LapsFigure {
  readonly #figure: HTMLElement;
  readonly #strips: Strip[][] = [];
  readonly #count = document.createElement('p');
  readonly #link = document.createElement('a');
  readonly #about = document.createElement('span');
  readonly #seeds: number;
  readonly #falseLaps: HTMLElement[] = [];
  readonly #wrong = LEVELS.map(() => 0);
  #finishedSeeds = 0;

  constructor(figure: HTMLElement, core: Core) {
    this.#figure = figure;
    this.#seeds = Number(figure.dataset['seeds'] ?? 0);
    this.#build();
    const pool = new WorkerPool(core, this.#seeds, (laps) => this.#add(laps));
    new IntersectionObserver((entries) => {
      const entry = entries.at(-1);
      pool.setActive(entry?.isIntersecting === true);
    }).observe(figure);
  }

  #build(): void {
    const grid = document.createElement('div');
    grid.className = 'laps-grid';
    grid.append(text('', 'laps-corner'), ...KINDS.map((kind) => text(capital(nameOf(kind)), 'laps-head')));
    LEVELS.forEach((noise, level) => {
      const strips = KINDS.map((kind) => new Strip(kind, level, {
        onPoint: (lap) => this.#describe(lap),
        onChoose: (lap) => this.#open(lap),
      }));
      this.#strips.push(strips);
      const name = text(`×${noise}`, 'laps-level');
      const wrong = text('', 'laps-false');
      name.append(wrong);
      this.#falseLaps.push(wrong);
      grid.append(name, ...strips.map(({ element }) => element));
    });
    const ends = KINDS.map(() => text('', 'laps-axis'));
    for (const axis of ends) axis.append(...['0', '1', '≥ 2 m'].map((label) => text(label)));
    grid.append(text('', 'laps-corner'), ...ends);
    this.#count.className = 'laps-count';
    this.#count.setAttribute('role', 'status');
    const chosen = document.createElement('p');
    chosen.className = 'laps-chosen';
    this.#link.className = 'slam-link';
    this.#about.textContent = 'Point at a dot, or walk along a strip with the arrow keys. A click or Enter opens that lap.';
    chosen.append(this.#about, ' ', this.#link);
    this.#link.hidden = true;
    this.#figure.querySelector('.laps-place')?.replaceChildren(grid, this.#count, chosen);
    this.#showCount();
  }

  #add(laps: Lap[]): void {
    for (const lap of laps) {
      for (const strip of this.#strips[lap.level] ?? []) strip.add(lap);
      if (lap.wrong === 0) continue;
      const wrong = (this.#wrong[lap.level] ?? 0) + 1;
      this.#wrong[lap.level] = wrong;
      (this.#falseLaps[lap.level] as HTMLElement).textContent = `${wrong} false`;
    }
    this.#finishedSeeds += 1;
    this.#showCount();
  }

  #showCount(): void {
    const isDone = this.#finishedSeeds === this.#seeds;
    const text = `${this.#finishedSeeds} of ${this.#seeds} seeds run in this page${isDone ? '.' : ' …'}`;
    // A screen reader announces only every hundredth.
    this.#count.ariaLive = isDone || this.#finishedSeeds % 100 === 0 ? 'polite' : 'off';
    this.#count.textContent = text;
  }

  #describe(lap: Lap): void {
    const { seed, level, frontEnd, withLoops, closed, wrong } = lap;
    for (const strips of this.#strips) for (const strip of strips) strip.select(lap);
    const noise = LEVELS[level];
    const false_ = wrong > 0 ? `, ${wrong} of them false` : '';
    this.#about.textContent = `Seed ${seed} at noise ×${noise}: ${frontEnd.toFixed(2)} m by the front end alone, `
      + `${withLoops.toFixed(2)} m with ${closed} loop${closed === 1 ? '' : 's'}${false_}.`;
    this.#link.hidden = false;
    this.#link.textContent = 'Drive it';
    this.#link.href = `?w=16.2&seed=${seed}&noise=${noise}&t=${LAST_TICK}`;
  }

  #open(lap: Lap): void {
    this.#describe(lap);
    this.#link.click();
  }
}

function text(words: string, className = ''): HTMLElement {
  const made = document.createElement('span');
  made.textContent = words;
  made.className = className;
  return made;
}

function capital(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}
