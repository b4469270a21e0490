// The result of a widget in words and numbers: a gesture or the verdict below the picture, facts, notes and tables under
// More.

import { create } from './dom';
import type { Outcome } from './instance';
import type { WidgetSpec } from './schema';

/** Facts and tables as they are shown. */
export interface Details {
  facts: { label: string; text: string }[];
  tables: { title: string; columns: string[]; rows: string[][] }[];
}

/** A shape for each standing, in addition to its colour. */
const SIGNS: Record<Outcome['standing'], string> = { good: '✓', bad: '✗', doubtful: '△', neutral: '○' };

/** Shows the gesture that answers until the reader acts, and then the verdict: one sentence, all of them with More, and what it shows. It never gets lower, so that nothing below it jumps. */
export class VerdictLine {
  readonly #element: HTMLElement;
  #shown = '';

  constructor(element: HTMLElement) {
    this.#element = element;
  }

  ask(gesture: string): void {
    const line = create('p', { class: 'gesture' });
    line.textContent = gesture;
    this.#replace(gesture, line);
  }

  show({ standing, verdict, sentence }: Outcome, claim: string): void {
    const line = create('p');
    const sign = create('span', { 'aria-hidden': 'true' });
    const words = create('strong', { class: standing });
    sign.textContent = `${SIGNS[standing]} `;
    words.append(sign, verdict);
    const [first = sentence] = /^.*?[.!?](?= )/.exec(sentence) ?? [];
    const further = create('span', { class: 'further' });
    further.textContent = sentence.slice(first.length);
    line.append(words, ` ${first}`, further);
    this.#replace(`${standing} ${verdict} ${sentence}`, line, Object.assign(create('p', { class: 'claim' }), { textContent: claim }));
  }

  /** Forgets the height of another width. */
  resized(): void {
    this.#element.style.removeProperty('min-height');
  }

  #replace(shown: string, ...lines: HTMLElement[]): void {
    if (this.#shown === shown) return;
    // Nothing is kept of the place of nothing: measuring it would lay out the page for each widget.
    const before = this.#shown === '' ? 0 : this.#element.offsetHeight;
    this.#shown = shown;
    this.#element.replaceChildren(...lines);
    if (before > 0 && this.#element.offsetHeight < before) this.#element.style.minHeight = `${before}px`;
  }
}

/** What to notice, the facts and the tables. */
export class DetailList {
  readonly element = create('div', { class: 'details' });
  readonly #facts = create('dl', { class: 'facts' });
  readonly #tables = create('div', { class: 'tables' });
  #shown = '';

  constructor({ notice }: WidgetSpec) {
    this.element.append(this.#facts);
    if (notice.length > 0) {
      const head = create('p', { class: 'head' });
      head.textContent = 'What to notice';
      const list = create('ul');
      list.append(...notice.map((sentence) => Object.assign(create('li'), { textContent: sentence })));
      this.element.append(head, list);
    }
    this.element.append(this.#tables);
  }

  /** Shows details as JSON. */
  show(json: string): void {
    if (this.#shown === json) return;
    this.#shown = json;
    const { facts, tables } = JSON.parse(json) as Details;
    this.#facts.replaceChildren(...facts.map(({ label, text }) => {
      const pair = create('div');
      pair.append(Object.assign(create('dt'), { textContent: label }), Object.assign(create('dd'), { textContent: text }));
      return pair;
    }));
    this.#tables.replaceChildren(...tables.map(tableOf));
  }
}

function tableOf({ title, columns, rows }: Details['tables'][number]): HTMLElement {
  const table = create('table');
  const caption = create('caption');
  caption.textContent = title;
  const row = (cells: string[], tag: 'th' | 'td'): HTMLElement => {
    const line = create('tr');
    // A head without words is none for a screen reader.
    line.append(...cells.map((text) => Object.assign(create(text === '' ? 'td' : tag), { textContent: text })));
    return line;
  };
  const head = create('thead');
  head.append(row(columns, 'th'));
  const body = create('tbody');
  body.append(...rows.map((cells) => row(cells, 'td')));
  table.append(caption, head, body);
  return table;
}
