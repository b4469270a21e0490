// A thousand laps as dots: a row for each setting, with the front end alone and with loops. They run in the page while the
// figure is in view.

import { WorkerPool, type Core } from './worker-pool';
import type { Estimate, Lap } from './protocol';
import { nameOf, Strip, type Axis, type Kind } from './strip';

export type { Axis } from './strip';

const KINDS: Kind[] = ['frontEnd', 'withLoops'];

/** A row of dots. */
export interface Row {
  /** Beside the row. */
  name: string;
  /** For screen readers: `wheel noise ×4`. */
  label: string;
  /** Within a sentence: `at noise ×4`. */
  at: string;
  /** The parameters of w16.2 but for the seed: `noise=4`. */
  state: string;
}

/** What the figure shows. */
export interface Plan {
  rows: readonly Row[];
  measure(estimate: Estimate): number;
  axis: Axis;
  /** What the reader believes that loops take off the median of each row, as a share; the laps with loops are hidden while it is asked for. */
  guess?: readonly number[] | 'asked';
  /** Where a lap is opened. */
  lastTick: number;
}

export class LapsFigure {
  readonly #figure: HTMLElement;
  readonly #core: Core;
  readonly #onLaps: () => void;
  readonly #seeds: number;
  readonly #count = document.createElement('p');
  readonly #link = document.createElement('a');
  readonly #about = document.createElement('span');
  #plan: Plan;
  #strips: Strip[][] = [];
  #falseLaps: HTMLElement[] = [];
  #laps: Lap[][] = [];
  #finishedSeeds = 0;
  #isInView = false;
  #pool: WorkerPool;

  constructor(figure: HTMLElement, core: Core, plan: Plan, onLaps: () => void = () => {}) {
    this.#figure = figure;
    this.#core = core;
    this.#onLaps = onLaps;
    this.#plan = plan;
    this.#seeds = Number(figure.dataset['seeds'] ?? 0);
    this.#build();
    this.#pool = this.#startPool();
    new IntersectionObserver((entries) => {
      this.#isInView = entries.at(-1)?.isIntersecting === true;
      this.#pool.setActive(this.#isInView);
    }).observe(figure);
  }

  /** Shows something else; other settings are driven again. */
  show(plan: Plan): void {
    const isSame = plan.rows.every(({ state }, row) => state === this.#plan.rows[row]?.state);
    this.#plan = plan;
    if (!isSame) {
      this.#pool.close();
      this.#pool = this.#startPool();
      this.#pool.setActive(this.#isInView);
    }
    const laps = this.#laps;
    this.#build();
    if (isSame) for (const lap of laps.flat()) this.#put(lap);
    else this.#finishedSeeds = 0;
    this.#showCount();
    this.#onLaps();
  }

  /** The laps of a row so far. */
  lapsOf(row: number): readonly Lap[] {
    return this.#laps[row] ?? [];
  }

  #startPool(): WorkerPool {
    return new WorkerPool(this.#core, this.#seeds, this.#plan.rows.map(({ state }) => state), (laps) => this.#add(laps));
  }

  #build(): void {
    const { rows, axis, guess } = this.#plan;
    const grid = document.createElement('div');
    grid.className = 'laps-grid';
    const head = (kind: Kind): string => capital(nameOf(kind)) + (this.#isHidden(kind) ? ': your guess first' : '');
    grid.append(text('', 'laps-corner'), ...KINDS.map((kind) => text(head(kind), 'laps-head')));
    this.#laps = rows.map(() => []);
    this.#falseLaps = [];
    this.#strips = rows.map(({ name, label }, row) => {
      const strips = KINDS.map((kind) => new Strip(kind, label, axis, (lap) => this.#plan.measure(lap[kind]), {
        onPoint: (lap) => this.#describe(lap),
        onChoose: (lap) => this.#open(lap),
      }));
      const [alone, loops] = strips;
      const share = guess === 'asked' ? undefined : guess?.[row];
      if (share !== undefined && loops !== undefined) loops.guess = () => (1 - share) * (alone?.median ?? NaN);
      const beside = text(name, 'laps-level');
      const wrong = text('', 'laps-false');
      beside.append(wrong);
      this.#falseLaps.push(wrong);
      grid.append(beside, ...strips.map(({ element }) => element));
      return strips;
    });
    const ends = KINDS.map(() => text('', 'laps-axis'));
    for (const end of ends) end.append(...axis.labels.map((label) => text(label)));
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
    for (const lap of laps) this.#put(lap);
    this.#finishedSeeds += 1;
    this.#showCount();
    this.#onLaps();
  }

  #put(lap: Lap): void {
    const row = this.#laps[lap.row];
    const [alone, loops] = this.#strips[lap.row] ?? [];
    row?.push(lap);
    alone?.add(lap);
    if (this.#isHidden('withLoops')) return;
    loops?.add(lap);
    const wrong = row?.filter((one) => one.wrong > 0).length ?? 0;
    if (wrong > 0) (this.#falseLaps[lap.row] as HTMLElement).textContent = `${wrong} false`;
  }

  #isHidden(kind: Kind): boolean {
    return kind === 'withLoops' && this.#plan.guess === 'asked';
  }

  #showCount(): void {
    const isDone = this.#finishedSeeds === this.#seeds;
    const text = `${this.#finishedSeeds} of ${this.#seeds} seeds run in this page${isDone ? '.' : ' …'}`;
    // A screen reader announces only every hundredth.
    this.#count.ariaLive = isDone || this.#finishedSeeds % 100 === 0 ? 'polite' : 'off';
    this.#count.textContent = text;
  }

  #describe(lap: Lap): void {
    const { seed, frontEnd, withLoops, closed, wrong } = lap;
    const row = this.#plan.rows[lap.row] as Row;
    for (const strips of this.#strips) for (const strip of strips) strip.select(lap);
    const { measure, axis } = this.#plan;
    const false_ = wrong > 0 ? `, ${wrong} of them false` : '';
    const loops = `, ${measure(withLoops).toFixed(2)}${axis.unit} with ${closed} loop${closed === 1 ? '' : 's'}${false_}`;
    this.#about.textContent = `Seed ${seed} ${row.at}: ${measure(frontEnd).toFixed(2)}${axis.unit} with the front end alone`
      + `${this.#isHidden('withLoops') ? '' : loops}.`;
    this.#link.hidden = false;
    this.#link.textContent = 'Drive it';
    this.#link.href = `?w=16.2&seed=${seed}&${row.state}&t=${this.#plan.lastTick}`;
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
