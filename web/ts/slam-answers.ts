// <slam-answers>: the reader's name for personal tasks, and the file of answers.

import { answered, answerFile, changes, functions, keepAnswers, keepsAnswers, setStudent, student } from './answers';
import { create, stopKeyPropagation } from './dom';
import { saveBlob } from './export';

const STYLE = `
:host { display: block; margin: 1rem 0; border: 1px solid currentColor; border-radius: 6px; padding: 0.75rem 1rem; }
fieldset { border: 0; margin: 0; padding: 0; min-width: 0; }
label { display: flex; flex-wrap: wrap; align-items: center; gap: 0.5rem; padding: 0.25rem 0; }
input[type='text'], button { font: inherit; min-height: 2rem; padding: 0.1rem 0.6rem; }
button { min-height: 2.25rem; padding: 0.2rem 1rem; color: inherit; background: none; border: 1px solid currentColor; border-radius: 999px; cursor: pointer; }
button:disabled { opacity: 0.6; cursor: default; }
legend { padding: 0; font-weight: 600; }
input[type='text'] { box-sizing: border-box; min-width: 0; max-width: 100%; }
input[type='checkbox'] { flex: none; width: 1.25rem; height: 1.25rem; margin: 0; }
p { margin: 0.5rem 0 0; }
textarea { font: inherit; font-size: 0.8rem; width: 100%; box-sizing: border-box; }
`;

export class SlamAnswers extends HTMLElement {
  #name: HTMLInputElement | undefined;
  #status: HTMLElement | undefined;
  readonly #show = (): void => this.#showCount();

  connectedCallback(): void {
    changes.addEventListener('change', this.#show);
    if (this.#status !== undefined) {
      this.#show();
      return;
    }
    const shadow = this.attachShadow({ mode: 'open' });
    const style = create('style');
    style.textContent = STYLE;
    const fields = create('fieldset');
    const legend = create('legend');
    legend.textContent = 'Your answers';
    this.#name = create('input', { type: 'text', autocomplete: 'off', maxlength: '100' });
    this.#name.value = student();
    this.#name.addEventListener('change', () => setStudent(this.#name?.value ?? ''));
    const nameLabel = create('label');
    nameLabel.append('Name or token, for personal tasks:', this.#name);
    const save = create('button', { type: 'button' });
    save.textContent = 'Save my answers';
    save.addEventListener('click', () => void this.#save());
    this.#status = create('p', { role: 'status' });
    fields.append(legend, nameLabel, this.#keepBox(), save, this.#status);
    stopKeyPropagation(fields);
    shadow.append(style, fields);
    this.#show();
  }

  disconnectedCallback(): void {
    changes.removeEventListener('change', this.#show);
  }

  #keepBox(): HTMLLabelElement {
    const box = create('input', { type: 'checkbox' });
    box.checked = keepsAnswers();
    box.addEventListener('change', () => {
      try {
        keepAnswers(box.checked);
      } catch {
        box.checked = false;
        this.#showStatus('This browser does not let the page store anything. Save the file instead.');
      }
    });
    const label = create('label');
    label.append(box, 'Keep my answers in this browser');
    return label;
  }

  async #save(): Promise<void> {
    try {
      const { name, text } = await answerFile();
      saveBlob(new Blob([text], { type: 'application/json' }), name);
      if (window !== window.parent) this.#showText(name, text);
    } catch (error) {
      this.#showStatus(`The answers could not be saved: ${error instanceof Error ? error.message : String(error)}.`);
    }
  }

  /** Shows the file as text: no frame hears whether it may save. */
  #showText(name: string, text: string): void {
    const area = create('textarea', { readonly: '', rows: '4' });
    area.value = text;
    area.addEventListener('focus', () => area.select());
    const label = create('label');
    label.append(`If this frame may not save files, copy this into a file ${name}:`, area);
    this.#status?.replaceChildren(label);
  }

  #showCount(): void {
    if (this.#name !== undefined) this.#name.value = student();
    const count = answered();
    const written = functions();
    const kept = keepsAnswers() ? '' : ' A reload forgets them, unless you keep or save them.';
    const code = written === 0 ? '' : `, ${written} ${written === 1 ? 'function' : 'functions'} written`;
    this.#showStatus(`${count} ${count === 1 ? 'exercise' : 'exercises'} answered${code}.${count + written === 0 ? '' : kept} Nothing leaves this browser unless you save the file.`);
  }

  #showStatus(sentence: string): void {
    this.#status?.replaceChildren(sentence);
  }
}

if (customElements.get('slam-answers') === undefined) customElements.define('slam-answers', SlamAnswers);
