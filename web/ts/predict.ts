// <slam-predict>: the reader commits to an answer before seeing the result.
//
//   <slam-predict exercise="16.4" widget="w16.1" state="heading=60&dx=0&dy=0">
//     <p>Where does registration end from 60° off?</p>
//     <ul><li data-choice="right minimum">at the truth</li>
//         <li data-choice="quarter turn">a quarter turn off</li></ul>
//     <p data-why>The walls of an almost square room fit after a quarter turn, too.</p>
//   </slam-predict>
//
// A choice is compared with the widget's verdict. With `fact="rmse_m" tolerance="0.02"` the reader types a number, which
// is compared with that fact of the outcome. With a fact and choices, each choice covers a half-open range of values:
// `<li data-choice="smaller" data-to="0.02">`, or `data-from` inclusive and `data-to` exclusive.
//
// For a student (attribute `student`, or `?student=` of the page), an exercise whose widget has a seed becomes a personal
// task, unless `varies="no"` says that most seeds have the same answer. `varies="noise seed: 3 12, 4 7"` lists the tasks instead, of
// which no answer has more than a third; the question says which noise it has.

// @ts-expect-error: a separate bundle.
import './slam-widget.js';
import { attemptsAt, changes, student } from './answers';
import { stopKeyPropagation, withCode } from './dom';
import { MAX_ATTEMPTS, ownTask, seedOf, withValues } from './personal-seeds';
import './slam-answers';
import { showBackButton } from './back-button';
import type { SlamWidget } from './element';
import type { Outcome } from './instance';
import type { Prediction } from '../slam-predict';

type Verdict = Pick<Prediction, 'prediction' | 'result' | 'right' | 'correct' | 'gap'>;

/** A state of the widget with its outcome. */
interface Result {
  state: string;
  outcome: Outcome;
}

const STYLE = `
:host { display: block; border: 1px solid currentColor; border-radius: 6px; padding: 0.75rem 1rem; }
fieldset { border: 0; margin: 0.5rem 0; padding: 0; min-width: 0; }
label { display: block; padding: 0.25rem 0; }
label:has(input[type='radio']) { display: flex; gap: 0.5rem; }
input[type='radio'] { flex: none; width: 1.25rem; height: 1.25rem; margin: 0.2em 0 0; }
input[type='number'], button { box-sizing: border-box; max-width: 100%; font: inherit; min-height: 2rem; padding: 0.1rem 0.6rem; }
button { min-height: 2.25rem; padding: 0.2rem 1rem; color: inherit; background: none; border: 1px solid currentColor; border-radius: 999px; cursor: pointer; }
button:disabled { opacity: 0.6; cursor: default; }
legend { padding: 0; font-weight: 600; }
.answer { outline: none; }
::slotted([slot="why"]) { margin-top: 0.75rem; }
.answer:not(:empty) { border-top: 1px solid currentColor; margin-top: 0.75rem; }
`;

/** Minimum number of decimals of a result. */
const DECIMALS = 3;

export class SlamPredict extends HTMLElement {
  #form: HTMLFormElement | undefined;
  #answer: HTMLElement | undefined;
  /** What a student has to know of the task before answering. */
  readonly #task = document.createElement('p');
  readonly #studentChanged = (): void => this.#showTask();
  /** Attempts at a question without an id, which answers.ts does not count. */
  #attempts = 0;

  connectedCallback(): void {
    changes.addEventListener('change', this.#studentChanged);
    if (this.#form !== undefined) {
      this.#showTask();
      return;
    }
    const shadow = this.attachShadow({ mode: 'open' });
    const style = document.createElement('style');
    style.textContent = STYLE;
    this.#form = this.#makeForm();
    this.#answer = document.createElement('div');
    this.#answer.className = 'answer';
    this.#answer.setAttribute('role', 'status');
    this.#answer.tabIndex = -1;
    stopKeyPropagation(this.#form);
    // The slot puts the explanation below the answer, wherever it is in the markup.
    const why = document.createElement('slot');
    why.name = 'why';
    shadow.append(style, document.createElement('slot'), this.#task, this.#form, this.#answer, why);
    for (const hidden of this.querySelectorAll<HTMLElement>('[data-why]')) {
      hidden.slot = 'why';
      hidden.hidden = true;
    }
    for (const list of this.querySelectorAll<HTMLElement>(':has(> [data-choice])')) list.hidden = true;
    this.#showTask();
  }

  disconnectedCallback(): void {
    changes.removeEventListener('change', this.#studentChanged);
  }

  /** Tells a student what is personal about the task; the choices then have their ranges, because the text is the chapter's. */
  #showTask(): void {
    const person = this.#person();
    const own = person === '' ? undefined : ownTask(this.getAttribute('varies') ?? '', person, this.getAttribute('exercise') ?? '');
    const sentences = [];
    if (own !== undefined) {
      const state = new URLSearchParams(this.getAttribute('state') ?? '');
      const [name = '', value] = [...own].find(([id]) => state.has(id)) ?? [];
      sentences.push(`Your task has ${name} ${value} and its own seed.`);
      sentences.push(`The numbers in the text belong to the chapter’s task, with ${name} ${state.get(name)}.`);
      if (this.hasAttribute('fact')) sentences.push('Go by the ranges.');
    } else if (person !== '' && this.#isSame()) {
      sentences.push('Everyone has this task, because a different seed would barely change the answer.');
    }
    this.#task.textContent = sentences.join(' ');
    this.#task.hidden = sentences.length === 0;
    for (const range of this.#form?.querySelectorAll<HTMLElement>('.range') ?? []) range.hidden = own === undefined;
  }

  #person(): string {
    return this.getAttribute('student') ?? student();
  }

  #makeForm(): HTMLFormElement {
    const form = document.createElement('form');
    const fields = document.createElement('fieldset');
    const legend = document.createElement('legend');
    legend.textContent = 'Your prediction';
    fields.append(legend);
    const fact = this.getAttribute('fact');
    const choices = this.querySelectorAll<HTMLElement>('[data-choice]');
    if (fact === null || choices.length > 0) {
      for (const choice of choices) fields.append(radio(choice, this.getAttribute('unit') ?? ''));
    } else {
      fields.append(numberField(this.getAttribute('unit') ?? ''));
    }
    const commit = document.createElement('button');
    commit.textContent = 'Commit and see';
    form.append(fields, commit);
    // A click handler, because a sandbox without `allow-forms` blocks submit events. Enter clicks the button, too.
    commit.addEventListener('click', (event) => {
      event.preventDefault();
      if (!form.reportValidity()) return;
      const prediction = new FormData(form).get('prediction');
      if (typeof prediction === 'string' && prediction !== '') void this.#check(prediction);
    });
    return form;
  }

  async #check(prediction: string): Promise<void> {
    const name = this.getAttribute('widget') ?? '';
    const css = `slam-widget[name="${CSS.escape(name)}"]`;
    const widget = this.closest('section')?.querySelector<SlamWidget>(css) ?? document.querySelector<SlamWidget>(css);
    if (widget === null) {
      this.#showSentences([`There is no widget ${name} on this page.`]);
      return;
    }
    this.#lock(true);
    try {
      const exercise = this.getAttribute('exercise');
      const person = this.#person();
      const result = await this.#result(widget, exercise ?? '', person);
      const verdict = this.#judge(prediction, result.outcome);
      this.#show(verdict, result, widget);
      this.#attempts = (exercise === null ? this.#attempts : attemptsAt(exercise, person)) + 1;
      const detail: Prediction = {
        exercise,
        student: person,
        attempts: this.#attempts,
        widget: widget.name,
        state: result.state,
        time: new Date().toISOString(),
        ...verdict,
      };
      this.dispatchEvent(new CustomEvent('slam-predict', { detail, bubbles: true, composed: true }));
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      this.#showSentences([`Your answer could not be checked: ${reason}.`]);
      this.#answer?.append(button('Predict again', () => this.#reset()));
    }
    // A committed answer earns the explanation, even if the widget cannot run.
    this.#showWhy(true);
    // The focused button is disabled now, and would lose the focus.
    this.#answer?.focus({ preventScroll: true });
  }

  /** Runs the question. A personal task is one of a list, or has the first seed for which one of the choices is right. */
  async #result(widget: SlamWidget, exercise: string, person: string): Promise<Result> {
    const state = this.getAttribute('state') ?? '';
    await setState(widget, state);
    const isFixed = this.#isSame() || widget.get('seed') === undefined || new URLSearchParams(state).has('seed');
    if (exercise === '' || person === '' || isFixed) return { state, outcome: outcomeOf(widget) };
    const own = ownTask(this.getAttribute('varies') ?? '', person, exercise);
    if (own !== undefined) {
      const personal = withValues(state, own);
      await setState(widget, personal);
      return { state: personal, outcome: outcomeOf(widget) };
    }
    for (let attempt = 0; attempt < MAX_ATTEMPTS; attempt += 1) {
      const seed = seedOf(person, exercise, attempt);
      widget.set('seed', seed);
      const outcome = outcomeOf(widget);
      if (this.#right(outcome) !== null) return { state: `${state}&seed=${seed}`, outcome };
    }
    await setState(widget, state);
    return { state, outcome: outcomeOf(widget) };
  }

  /** Whether everyone has the same task. */
  #isSame(): boolean {
    return this.getAttribute('varies') === 'no';
  }

  /** The right choice or number for an outcome; null if there is none. */
  #right(outcome: Outcome): string | null {
    const choices = [...this.querySelectorAll<HTMLElement>('[data-choice]')];
    const fact = this.getAttribute('fact');
    const value = fact === null ? undefined : (outcome.facts[fact] ?? undefined);
    if (fact !== null && value === undefined) return null;
    if (choices.length === 0) return String(value);
    const right = choices.find((choice) =>
      value === undefined ? choice.dataset['choice'] === outcome.verdict : covers(choice, value));
    return right?.dataset['choice'] ?? null;
  }

  #judge(prediction: string, outcome: Outcome): Verdict {
    const fact = this.getAttribute('fact');
    const right = this.#right(outcome);
    if (fact === null) {
      return { prediction, result: outcome.verdict, right, correct: prediction === outcome.verdict, gap: null };
    }
    const result = outcome.facts[fact] ?? undefined;
    if (result === undefined) throw new RangeError(`the widget reports no number \`${fact}\` here`);
    const choice = this.#item(prediction);
    if (choice !== null) {
      return { prediction, result: String(result), right, correct: covers(choice, result), gap: null };
    }
    const gap = Number(prediction) - result;
    const tolerance = Number(this.getAttribute('tolerance') ?? 0);
    return { prediction, result: String(result), right, correct: Math.abs(gap) <= tolerance, gap };
  }

  #show(verdict: Verdict, { state, outcome }: Result, widget: SlamWidget): void {
    const { correct, gap, prediction, result } = verdict;
    const unit = this.getAttribute('unit') ?? '';
    const judged = correct ? 'As you predicted.' : 'It turns out differently, but a wrong guess is no mistake.';
    // The widget's sentence may be about another quantity than the fact.
    const digits = Math.max(gap === null ? 0 : decimalsOf(prediction), DECIMALS);
    const number = `It is ${Number(result).toFixed(digits)}${unit}.`;
    const answer = this.hasAttribute('fact') ? number : outcome.sentence;
    const answered = gap === null
      ? `${judged} You said: ${this.#textOf(prediction)}. ${answer}`
      : `${judged} ${number} You said ${prediction}${unit} and are off by ${Math.abs(gap).toPrecision(2)}${unit}.`;
    const isPersonal = state !== (this.getAttribute('state') ?? '');
    const seed = new URLSearchParams(state).get('seed');
    const note = `This is your personal task, seed ${seed}. The numbers in the text belong to the chapter’s task.`;
    this.#showSentences([answered, ...(isPersonal ? [note] : [])]);
    // The widget may be far away, so the page does not scroll by itself.
    const show = button('Show it in the widget', () => {
      widget.scrollIntoView({ block: 'start' });
      showBackButton(show, widget, 'the question');
    });
    const again = button('Predict again', () => this.#reset());
    this.#answer?.append(show, ' ', again);
  }

  /** The text of a choice on the page. */
  #textOf(choice: string): string {
    return this.#item(choice)?.textContent?.trim() ?? choice;
  }

  #item(choice: string): HTMLElement | null {
    return this.querySelector<HTMLElement>(`[data-choice="${CSS.escape(choice)}"]`);
  }

  #reset(): void {
    this.#answer?.replaceChildren();
    this.#form?.reset();
    this.#lock(false);
    this.#showWhy(false);
    this.#form?.querySelector('input')?.focus();
  }

  /** Disables the form while a result is shown. */
  #lock(isLocked: boolean): void {
    const fields = this.#form?.querySelectorAll<HTMLInputElement | HTMLButtonElement>('input, button');
    for (const field of fields ?? []) field.disabled = isLocked;
  }

  #showWhy(isShown: boolean): void {
    for (const why of this.querySelectorAll<HTMLElement>('[data-why]')) why.hidden = !isShown;
  }

  #showSentences(sentences: string[]): void {
    this.#answer?.replaceChildren(
      ...sentences.map((sentence) => {
        const line = document.createElement('p');
        line.append(...withCode(sentence));
        return line;
      }),
    );
  }
}

/** Sets a state; the other parameters get their defaults. */
async function setState(widget: SlamWidget, state: string): Promise<void> {
  // The task is about our estimator.
  if (widget.driver !== undefined) await widget.drive(undefined);
  await widget.press('defaults');
  for (const [id, text] of new URLSearchParams(state)) widget.set(id, text);
}

/** The outcome of the present state; throws if the widget cannot run. */
function outcomeOf({ outcome }: SlamWidget): Outcome {
  if (outcome === undefined) throw new Error('the widget cannot run here');
  return outcome;
}

/** Whether a choice is right for a value: `data-from` is inclusive, `data-to` exclusive. */
function covers({ dataset: { from, to } }: HTMLElement, value: number): boolean {
  return value >= Number(from ?? -Infinity) && value < Number(to ?? Infinity);
}

function decimalsOf(number: string): number {
  return number.split('.')[1]?.length ?? 0;
}

function button(text: string, press: () => void): HTMLButtonElement {
  const made = document.createElement('button');
  made.textContent = text;
  made.addEventListener('click', press);
  return made;
}

/** A choice and its range, which is shown in a personal task. */
function radio(choice: HTMLElement, unit: string): HTMLLabelElement {
  const label = document.createElement('label');
  const input = document.createElement('input');
  input.type = 'radio';
  input.name = 'prediction';
  input.required = true;
  input.value = choice.dataset['choice'] ?? '';
  label.append(input, ` ${choice.textContent ?? ''}`);
  const { from, to } = choice.dataset;
  if (from !== undefined || to !== undefined) {
    const range = document.createElement('span');
    range.className = 'range';
    range.hidden = true;
    if (to === undefined) range.append(`(${from}${unit} or more)`);
    else range.append(Number(from ?? 0) === 0 ? `(below ${to}${unit})` : `(${from} to ${to}${unit})`);
    label.append(' ', range);
  }
  return label;
}

function numberField(unit: string): HTMLLabelElement {
  const label = document.createElement('label');
  const input = document.createElement('input');
  input.type = 'number';
  input.name = 'prediction';
  input.step = 'any';
  input.required = true;
  label.append('A number: ', input, ` ${unit}`);
  return label;
}

if (customElements.get('slam-predict') === undefined) {
  customElements.define('slam-predict', SlamPredict);
}
