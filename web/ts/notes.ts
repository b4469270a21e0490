// Messages of a widget about input from outside: lines of text under the picture.

import { create, marked } from './dom';

export class Notes {
  readonly #box: HTMLElement;
  readonly #lines = new Map<string, HTMLElement>();

  constructor(box: HTMLElement) {
    this.#box = box;
  }

  /** Shows a message; of one subject only the latest stays. As text, never as HTML. */
  say(message: string, subject?: string): void {
    const line = create('p');
    line.append(...marked(message));
    if (subject !== undefined) {
      this.settle(subject);
      this.#lines.set(subject, line);
    }
    this.#box.append(line);
  }

  /** Removes the message about a subject, which is valid now. */
  settle(subject: string): void {
    this.#lines.get(subject)?.remove();
    this.#lines.delete(subject);
  }

  clear(): void {
    this.#lines.clear();
    this.#box.replaceChildren();
  }
}
