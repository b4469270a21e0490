// Ten loop candidates: the reader accepts or rejects each, and then sees which were right.

import type { Glue } from '../pkg/glue.js';
import { themeOf, watchTheme } from '../ts/theme';
import { NARROW, WIDTHS } from './sketch';

interface Candidate {
  svg: string;
  says: string;
}

interface Judged extends Candidate {
  each: string[];
  /** The number of candidates judged right. */
  right: number;
}

export class DecideFigure {
  readonly #place: HTMLElement;
  readonly #glue: Glue;
  readonly #narrow = matchMedia(NARROW);
  #candidates: Candidate[] = [];
  #answers = '';

  constructor(figure: HTMLElement, glue: Glue) {
    this.#place = figure.querySelector<HTMLElement>('.decide-place') as HTMLElement;
    this.#glue = glue;
    // Its laps take a while, so they run once the figure is near the viewport.
    const observer = new IntersectionObserver((entries) => {
      if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
      observer.disconnect();
      watchTheme(figure, () => this.#compute());
      this.#narrow.addEventListener('change', () => this.#compute());
      this.#compute();
    }, { rootMargin: '50%' });
    observer.observe(figure);
  }

  get #width(): number {
    return this.#narrow.matches ? WIDTHS.narrow : WIDTHS.wide;
  }

  #compute(): void {
    this.#candidates = JSON.parse(this.#glue.loopCandidates(this.#width, themeOf(this.#place))) as Candidate[];
    this.#draw();
  }

  #draw(): void {
    const next = this.#candidates[this.#answers.length];
    if (next === undefined) this.#showVerdict();
    else this.#showCandidate(next);
  }

  #showCandidate(candidate: Candidate): void {
    const { length } = this.#answers;
    const count = paragraph(`Candidate ${length + 1} of ${this.#candidates.length}`);
    count.className = 'decide-count';
    this.#show(candidate, count, row(
      button('Accept', () => this.#answer('1')),
      button('Reject', () => this.#answer('0')),
    ));
  }

  #answer(letter: '0' | '1'): void {
    this.#answers += letter;
    this.#draw();
    // The pressed button is gone: its successor gets the focus.
    const buttons = this.#place.querySelectorAll('button');
    (letter === '1' ? buttons[0] : buttons[buttons.length - 1])?.focus({ preventScroll: true });
  }

  #showVerdict(): void {
    const verdict = this.#glue.judgeCandidates(this.#answers, this.#width, themeOf(this.#place));
    const judged = JSON.parse(verdict) as Judged;
    if (judged.right === this.#candidates.length) document.dispatchEvent(new CustomEvent('slam-decided'));
    const list = document.createElement('ol');
    list.className = 'decide-each';
    list.append(...judged.each.map((sentence) => {
      const item = document.createElement('li');
      item.textContent = sentence;
      return item;
    }));
    this.#show(judged, list, row(button('Judge again', () => {
      this.#answers = '';
      this.#draw();
      this.#place.querySelector('button')?.focus({ preventScroll: true });
    })));
  }

  /** Shows a picture, its sentence as a live region, and the elements below. */
  #show({ svg, says }: Candidate, ...below: HTMLElement[]): void {
    const picture = document.createElement('div');
    picture.className = 'sketch-picture';
    picture.innerHTML = svg;
    const sentence = paragraph(says);
    sentence.className = 'sketch-says';
    sentence.setAttribute('role', 'status');
    this.#place.replaceChildren(picture, sentence, ...below);
  }
}

function paragraph(text: string): HTMLParagraphElement {
  const made = document.createElement('p');
  made.textContent = text;
  return made;
}

function row(...buttons: HTMLButtonElement[]): HTMLElement {
  const made = document.createElement('div');
  made.className = 'decide-buttons';
  made.append(...buttons);
  return made;
}

function button(text: string, press: () => void): HTMLButtonElement {
  const made = document.createElement('button');
  made.type = 'button';
  made.textContent = text;
  made.addEventListener('click', press);
  return made;
}
