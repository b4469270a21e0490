// A thousand laps by each matcher: the reader chooses what is shown, the world, the normals and the cap on the information.

import { LapsFigure, type Axis, type Plan } from './laps';
import { spreadOf } from './spread';
import type { Estimate, Lap } from './protocol';
import type { Core } from './worker-pool';

interface Quantity {
  name: string;
  measure(estimate: Estimate): number;
  axis: Axis;
  /** The result of a row in words. */
  says(laps: readonly Lap[]): string;
}

const MATCHERS = [['p2p', 'Point-to-point'], ['p2l', 'Point-to-plane'], ['ndt', 'NDT']] as const;
const WORLDS = [['the Apartment', ''], ['the ring', '&world=ring&information=exact']] as const;

const metres = (value: number): string => `${value.toFixed(2)}\u00a0m`;
const percent = (before: number, after: number): string => {
  const fall = Math.round(100 * (1 - after / before));
  return fall < 0 ? `+${-fall}%` : `−${fall}%`;
};

/** Median and tail without loops and with them. */
function spreads(laps: readonly Lap[], measure: (estimate: Estimate) => number): string {
  const [alone, loops] = [spreadOf(laps.map(({ frontEnd }) => measure(frontEnd))), spreadOf(laps.map(({ withLoops }) => measure(withLoops)))];
  if (alone === undefined || loops === undefined) return '';
  return `median ${metres(alone.median)}, with loops ${metres(loops.median)} (${percent(alone.median, loops.median)}); `
    + `one lap in twenty beyond ${metres(alone.p95)}, with loops ${metres(loops.p95)}`;
}

const rms = (values: readonly number[]): number => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);
const median = (values: readonly number[]): number => spreadOf(values)?.median ?? NaN;

const QUANTITIES: readonly Quantity[] = [
  {
    name: 'rms error',
    measure: (estimate) => estimate.rms,
    axis: { end: 3, unit: ' m', labels: ['0', '1.5', '≥ 3 m'] },
    says: (laps) => spreads(laps, (estimate) => estimate.rms),
  },
  {
    name: 'error in the middle of the path',
    measure: (estimate) => estimate.middle,
    axis: { end: 3, unit: ' m', labels: ['0', '1.5', '≥ 3 m'] },
    says(laps) {
      const sigma = (of: (lap: Lap) => Estimate): number => median(laps.map((lap) => of(lap).sigma));
      const predicted = percent(sigma(({ frontEnd }) => frontEnd), sigma(({ withLoops }) => withLoops));
      return `${spreads(laps, (estimate) => estimate.middle)}; the graph predicts ${predicted}`;
    },
  },
  {
    name: 'that error ÷ the graph’s standard deviation',
    measure: (estimate) => estimate.middle / estimate.sigma,
    axis: { end: 6, unit: '', labels: ['0', '3', '≥ 6'] },
    says(laps) {
      const ratio = (of: (lap: Lap) => Estimate): string => rms(laps.map((lap) => of(lap).middle / of(lap).sigma)).toFixed(1);
      return `root mean square ${ratio(({ frontEnd }) => frontEnd)}, with loops ${ratio(({ withLoops }) => withLoops)}; 1 would be right`;
    },
  },
];

export class MatchersFigure {
  readonly #laps: LapsFigure;
  readonly #quantity = choice('Show', QUANTITIES.map(({ name }) => name));
  readonly #world = choice('in', WORLDS.map(([name]) => name));
  readonly #radius = slider('Radius of the normals', { min: 1.5, max: 6, step: 0.1, value: 4.2 }, (cells) => `${cells.toFixed(1)} cells`);
  readonly #guesses = MATCHERS.map(([, name]) => slider(
    `Your guess: loops lower ${name} by`,
    { min: 0, max: 80, step: 1, value: 0 },
    (share) => (share === 0 ? 'none yet' : `${share}%`),
  ));
  /** The guesses of the reader, once a slider is released. */
  #guessed: readonly number[] | 'asked' = 'asked';
  readonly #cap = document.createElement('input');
  readonly #says = document.createElement('ul');

  constructor(figure: HTMLElement, core: Core) {
    this.#cap.type = 'checkbox';
    this.#cap.checked = true;
    const cap = document.createElement('label');
    cap.append(this.#cap, ' cap on the information');
    const controls = document.createElement('div');
    controls.className = 'laps-controls';
    controls.append(this.#quantity.label, this.#world.label, this.#radius.label, cap, ...this.#guesses.map(({ label }) => label));
    this.#says.className = 'laps-says';
    figure.querySelector('.laps-place')?.before(controls);
    figure.querySelector('.laps-place')?.after(this.#says);
    this.#laps = new LapsFigure(figure, core, this.#plan(), () => this.#report());
    for (const control of [this.#quantity.select, this.#world.select, this.#radius.input, this.#cap]) {
      control.addEventListener('change', () => this.#laps.show(this.#plan()));
    }
    const guess = (): void => {
      const shares = this.#guesses.map(({ input }) => input.valueAsNumber / 100);
      this.#guessed = shares.every((share) => share > 0) ? shares : 'asked';
      this.#laps.show(this.#plan());
    };
    for (const { input } of this.#guesses) {
      input.addEventListener('change', guess);
      input.addEventListener('input', () => { if (this.#guessed !== 'asked') guess(); });
    }
    this.#report();
  }

  get #shown(): Quantity {
    return QUANTITIES[this.#quantity.select.selectedIndex] as Quantity;
  }

  #plan(): Plan {
    const [, world] = WORLDS[this.#world.select.selectedIndex] ?? WORLDS[0];
    const { measure, axis } = this.#shown;
    const shared = `normals=${this.#radius.input.value}&cap=${this.#cap.checked ? 'on' : 'off'}${world}`;
    const rows = MATCHERS.map(([matcher, name]) => ({ name, label: name, at: `with ${name}`, state: `matcher=${matcher}&${shared}` }));
    return { rows, measure, axis, guess: this.#guessed, lastTick: world === '' ? 129 : 2000 };
  }

  /** The rows in words, once they are guessed. */
  #report(): void {
    if (this.#guessed === 'asked') {
      const question = document.createElement('li');
      question.textContent = 'By how much do loops lower the median of each matcher? Set a guess for each.';
      this.#says.replaceChildren(question);
      return;
    }
    this.#says.replaceChildren(...MATCHERS.map(([, name], row) => {
      const line = document.createElement('li');
      const laps = this.#laps.lapsOf(row);
      line.textContent = laps.length === 0 ? `${name}: …` : `${name}: ${this.#shown.says(laps)}.`;
      return line;
    }));
  }
}

function choice(name: string, options: readonly string[]): { label: HTMLElement; select: HTMLSelectElement } {
  const label = document.createElement('label');
  const select = document.createElement('select');
  select.append(...options.map((text) => new Option(text)));
  label.append(`${name} `, select);
  return { label, select };
}

function slider(
  name: string,
  range: Record<'min' | 'max' | 'step' | 'value', number>,
  text: (value: number) => string,
): { label: HTMLElement; input: HTMLInputElement } {
  const label = document.createElement('label');
  const input = document.createElement('input');
  const output = document.createElement('output');
  input.type = 'range';
  Object.assign(input, { min: range.min, max: range.max, step: range.step });
  input.value = String(range.value);
  const show = (): void => { output.textContent = text(input.valueAsNumber); };
  input.addEventListener('input', show);
  show();
  label.append(`${name} `, input, ' ', output);
  return { label, input };
}
