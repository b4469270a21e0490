// Messages about invalid input, as lines of text under the picture.

import { create, withCode } from './dom';

export class Notes {
  readonly #box: HTMLElement;
  readonly #lines = new Map<string, HTMLElement>();

  constructor(box: HTMLElement) {
    this.#box = box;
  }

  /** Shows a message as text, never as HTML. It replaces an earlier one about the same subject. */
  show(message: string, subject?: string): void {
    const line = create('p');
    line.append(...withCode(message));
    if (subject !== undefined) {
      this.remove(subject);
      this.#lines.set(subject, line);
    }
    this.#box.append(line);
  }

  /** Removes the message about a subject that is valid now. */
  remove(subject: string): void {
    this.#lines.get(subject)?.remove();
    this.#lines.delete(subject);
  }

  clear(): void {
    this.#lines.clear();
    this.#box.replaceChildren();
  }
}
