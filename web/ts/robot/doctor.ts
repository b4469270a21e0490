// The doctor's report above the picture: what is right, repaired or wrong about a log, the options that correct it, and
// the pose of the laser. The worker computes the report.

import { create, stopKeyPropagation } from '../dom';
import type { Delivery } from './protocol';

export type Verdict = 'good' | 'mended' | 'wrong';

export interface Remark {
  part: 'file' | 'sensor' | 'odometry' | 'mounting' | 'clocks';
  verdict: Verdict;
  /** A sentence, without a full stop. */
  text: string;
  /** Options of the command that correct it; one is enough. */
  options?: string[];
}

/** The part of `slam2d doctor --json` that is shown. */
export interface Diagnosis {
  name: string;
  verdict: Verdict;
  /** `x,y,degrees` or `x,y,degrees,flipped`; null if each line of the log has its own pose. */
  laser: string | null;
  remarks: Remark[];
}

export interface DoctorHost {
  /** Maps the log again with a further option, or with none at all. */
  choose(option: string | undefined): void;
  /** The options of the current map. */
  chosen(): string[];
}

const SIGNS: Record<Verdict, string> = { good: '✓', mended: '!', wrong: '✗' };
const WORDS: Record<Verdict, string> = { good: 'in order', mended: 'repaired or worked around', wrong: 'not repaired' };

export class DoctorScreen {
  readonly element = create('section', { class: 'doctor', hidden: '', 'aria-label': 'What the doctor found' });
  readonly #host: DoctorHost;
  readonly #fold = create('details');
  readonly #heading = create('summary');
  readonly #body = create('div');
  readonly #live = create('p', { class: 'hidden', role: 'status' });
  #name = '';
  #diagnosis: Diagnosis | undefined;

  constructor(host: DoctorHost) {
    this.#host = host;
    this.#fold.append(this.#heading, this.#body);
    this.element.append(this.#fold, this.#live);
    stopKeyPropagation(this.element);
  }

  get diagnosis(): Diagnosis | undefined {
    return this.#diagnosis;
  }

  /** Handles a delivery of the worker; returns whether the layout may have changed. */
  receive({ kind, text }: Delivery): boolean {
    if (kind === 'opening') this.#wait(text);
    else if (kind === 'diagnosis') this.#show(JSON.parse(text) as Diagnosis);
    else if (kind === 'closed') this.#hide();
    else if (kind === 'failed' && this.#diagnosis === undefined) this.#fail(text);
    else return false;
    return true;
  }

  #hide(): void {
    this.element.hidden = true;
    this.#diagnosis = undefined;
    this.#name = '';
    this.#live.textContent = '';
    this.#body.replaceChildren();
  }

  /** Keeps the report of the same log, and with it the focus; hides that of another log. */
  #wait(name: string): void {
    if (name !== this.#name) this.#hide();
    this.#name = name;
    this.#diagnosis = undefined;
    this.#replace(`Checking ${name} …`, []);
  }

  #show(diagnosis: Diagnosis): void {
    this.#diagnosis = diagnosis;
    const summary = headingFor(diagnosis);
    this.#replace(summary, [this.#list(diagnosis.remarks), this.#choices(), this.#laser(diagnosis), this.#option()]);
    // A report without a fault would only push the map down.
    if (this.element.hidden) this.#fold.open = diagnosis.verdict !== 'good';
    this.element.hidden = false;
    this.#live.textContent = summary;
  }

  /** A log that needs an option, or cannot be read with those that were chosen: others can be tried. */
  #fail(sentence: string): void {
    if (!sentence.includes('--') && this.#host.chosen().length === 0) {
      this.#hide();
      return;
    }
    this.#replace(`${SIGNS.wrong} ${this.#name} cannot be mapped with these options`, [this.#choices(), this.#option()]);
    this.#fold.open = true;
    this.element.hidden = false;
  }

  #replace(heading: string, body: HTMLElement[]): void {
    const hadFocus = this.#body.contains((this.element.getRootNode() as ShadowRoot).activeElement);
    // The focused element disappears.
    if (hadFocus) this.#heading.focus();
    this.#heading.textContent = heading;
    this.#body.replaceChildren(...body);
  }

  #list(remarks: readonly Remark[]): HTMLElement {
    const list = create('ul');
    for (const { part, verdict, text, options = [] } of remarks) {
      const item = create('li', { class: verdict });
      const sign = create('span', { class: 'sign', role: 'img', 'aria-label': WORDS[verdict], title: WORDS[verdict] });
      sign.textContent = SIGNS[verdict];
      const name = create('b');
      name.textContent = part;
      const sentence = create('span');
      sentence.append(name, ` ${text}.`);
      for (const option of options) sentence.append(' ', this.#button(`Map with ${option}`, option));
      item.append(sign, sentence);
      list.append(item);
    }
    return list;
  }

  #button(label: string, option: string | undefined): HTMLElement {
    const button = create('button', { type: 'button' });
    button.textContent = label;
    button.addEventListener('click', () => this.#host.choose(option));
    return button;
  }

  /** The current options, with buttons to reset them. */
  #choices(): HTMLElement {
    const line = create('p');
    const chosen = this.#host.chosen();
    if (chosen.length > 0) line.append(`Mapped with ${chosen.join(' ')}. `, this.#button('Map without options', undefined));
    return line;
  }

  /** A form for any other option of the command. */
  #option(): HTMLElement {
    const form = create('form');
    const input = create('input', { required: '', pattern: '--[a-z].*', placeholder: '--heights 0.2,0.6' });
    const label = create('label');
    label.append('Another option of slam2d run ', input);
    const button = create('button', { type: 'submit' });
    button.textContent = 'Map with this option';
    form.append(label, button);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.#host.choose(input.value.trim());
    });
    return form;
  }

  /** A form for the pose of the laser. */
  #laser({ laser }: Diagnosis): HTMLElement {
    const form = create('form');
    const [x = '0', y = '0', heading = '0', flipped] = (laser ?? '').split(',').filter((word) => word !== '');
    const field = (label: string, value: string): HTMLInputElement => {
      const input = create('input', { type: 'number', step: 'any', required: '', value });
      const name = create('label');
      name.append(`${label} `, input);
      form.append(name);
      return input;
    };
    const legend = create('b');
    legend.textContent = 'The laser sits';
    form.append(legend);
    const fields = [field('ahead, m', x), field('to the left, m', y), field('turned left, °', heading)];
    const upsideDown = create('input', { type: 'checkbox' });
    upsideDown.checked = flipped !== undefined;
    const name = create('label');
    name.append(upsideDown, ' upside down');
    const button = create('button', { type: 'submit' });
    button.textContent = 'Map with this pose';
    form.append(name, button);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const words = fields.map((input) => String(input.valueAsNumber));
      if (upsideDown.checked) words.push('flipped');
      this.#host.choose(`--laser ${words.join(',')}`);
    });
    return form;
  }
}

/** The heading: sign, name, and the number of findings of each kind. */
function headingFor({ name, verdict, remarks }: Diagnosis): string {
  const count = (of: Verdict): number => remarks.filter((remark) => remark.verdict === of).length;
  const kinds = (['wrong', 'mended'] as const).filter((of) => count(of) > 0);
  const found = kinds.map((of) => `${count(of)} ${WORDS[of]}`);
  return `${SIGNS[verdict]} ${name}: ${found.length === 0 ? 'the recording is in order' : found.join(', ')}`;
}
