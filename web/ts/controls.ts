// Native controls that mirror those on the canvas, with name, value, unit and help. They have the keyboard focus, and the
// canvas shows the focus ring. A control is visible under the picture while it has the focus; a screen reader always has
// it. Controls that the canvas does not show, such as those under "More", are no tab stops.

import { create } from './dom';
import type { Timeline } from './instance';
import type { ButtonSpec, ParamSpec, WidgetSpec } from './schema';
import { toLabel } from './values';

/** The switch that shows all controls. */
export const MORE = 'more';

export interface ControlHost {
  /** Sets a value; returns the error, if there is one. */
  set(id: string, text: string): string | undefined;
  /** The widget's value. */
  text(id: string): string;
  press(id: string): void;
  /** Finishes the computation on which the length of the run depends, and shows it. */
  finishRun(): void;
  focus(id: string | undefined): void;
}

interface ParamControl {
  spec: ParamSpec;
  show(text: string): void;
}

export class Controls {
  readonly element: HTMLElement;
  readonly #rows = new Map<string, HTMLElement>();
  readonly #params = new Map<string, ParamControl>();
  readonly #ranges = new Map<string, HTMLInputElement>();
  readonly #buttons = new Map<string, HTMLButtonElement>();
  readonly #host: ControlHost;
  /** The button for each key. Keys work while one of these buttons has the focus. */
  readonly #keys: ReadonlyMap<string, string>;
  readonly #keyed: ReadonlySet<string>;

  constructor(widget: WidgetSpec, host: ControlHost) {
    this.#host = host;
    this.#keys = new Map(widget.keys.map(({ key, button }) => [key, button]));
    this.#keyed = new Set(this.#keys.values());
    this.element = create('div', { class: 'controls', role: 'group' });
    this.element.setAttribute('aria-label', `${widget.title}: controls`);
    for (const button of widget.presets) this.#rows.set(button.id, this.#button(button, 'try'));
    for (const param of widget.params) this.#rows.set(param.id, this.#param(param));
    for (const button of widget.buttons) this.#rows.set(button.id, this.#button(button, 'do'));
    for (const id of inOrder(widget, [...this.#rows.keys()])) this.element.append(this.#rows.get(id) ?? '');
    this.offer(widget.opening);
    this.element.addEventListener('keydown', (event) => this.#keyDown(event));
    this.element.addEventListener('focusin', (event) => {
      host.focus((event.target as HTMLElement).dataset['control']);
    });
    this.element.addEventListener('focusout', (event) => {
      const next = event.relatedTarget;
      if (!(next instanceof Node) || !this.element.contains(next)) host.focus(undefined);
    });
  }

  /** Presses the button of a key, which need not be the focused one. */
  #keyDown(event: KeyboardEvent): void {
    const { target } = event;
    if (event.altKey || !(target instanceof HTMLButtonElement)) return;
    const isKeyed = this.#keyed.has(target.dataset['control'] ?? '');
    const chord = event.ctrlKey || event.metaKey ? `Control+${event.key.toLowerCase()}` : event.key;
    const button = this.#keys.get(chord);
    if (!isKeyed || button === undefined) return;
    event.preventDefault();
    this.#host.press(button);
  }

  /** Hides the controls that the canvas does not show from keyboard and screen reader. */
  offer(shown: readonly string[]): void {
    for (const [id, row] of this.#rows) {
      const isShown = shown.includes(id);
      // A hidden control must not keep the focus: "More" gets it.
      if (!isShown && row.matches(':focus-within')) this.#rows.get(MORE)?.querySelector('input')?.focus();
      row.hidden = !isShown;
    }
  }

  /** Dims the buttons that have nothing to do. They keep the focus: a press on one may be what ended its work. */
  disable(disabled: readonly string[]): void {
    for (const [id, button] of this.#buttons) button.setAttribute('aria-disabled', String(disabled.includes(id)));
  }

  /** Shows values that changed elsewhere. */
  show(values: Iterable<[string, string]>): void {
    for (const [id, text] of values) this.#params.get(id)?.show(text);
  }

  /** Shows the length of the run and whether it plays. */
  showTimeline(timeline: Timeline | null): void {
    const play = this.#buttons.get('play');
    if (timeline === null) return;
    play?.setAttribute('aria-pressed', String(timeline.playing));
    const range = this.#ranges.get(timeline.param);
    if (range === undefined) return;
    range.max = String(timeline.last);
    // A run can be shorter than the requested time: the control shows its end.
    const asked = Number(this.#host.text(timeline.param));
    this.#params.get(timeline.param)?.show(String(Math.min(asked, timeline.last)));
  }

  #param(spec: ParamSpec): HTMLElement {
    const row = create('div', { class: 'control' });
    const name = create('label', { class: 'name' });
    name.textContent = spec.label;
    const help = create('span', { class: 'help' });
    help.textContent = spec.help;
    help.id = `help-${spec.id}`;
    const [inputs, show] = this.#inputs(spec);
    const [first] = inputs;
    if (first !== undefined) {
      first.id = `control-${spec.id}`;
      name.htmlFor = first.id;
    }
    for (const input of inputs) {
      input.dataset['control'] = spec.id;
      input.setAttribute('aria-describedby', help.id);
    }
    const line = create('span', { class: 'line' });
    line.append(name, ...inputs, unitOf(spec));
    row.append(line, help);
    this.#params.set(spec.id, { spec, show });
    return row;
  }

  #inputs(spec: ParamSpec): [HTMLElement[], (text: string) => void] {
    switch (spec.kind) {
      case 'choice': {
        const select = create('select');
        for (const option of spec.options) {
          const item = create('option', { value: option.id });
          item.textContent = option.label;
          select.append(item);
        }
        select.addEventListener('change', () => this.#host.set(spec.id, select.value));
        return [[select], (text) => (select.value = text)];
      }
      case 'switch': {
        const box = create('input', { type: 'checkbox', role: 'switch' });
        box.addEventListener('change', () => this.#host.set(spec.id, box.checked ? 'on' : 'off'));
        return [[box], (text) => (box.checked = text === 'on')];
      }
      case 'text': {
        const field = create('input', { type: 'text', maxlength: `${spec.max}`, spellcheck: 'false' });
        field.addEventListener('change', () => {
          const problem = this.#host.set(spec.id, field.value);
          field.setAttribute('aria-invalid', String(problem !== undefined));
        });
        return [[field], this.#typed(field, spec)];
      }
      case 'seed': {
        const field = this.#numberField(spec);
        return [[field], this.#typed(field, spec)];
      }
      default: {
        const range = this.#range(spec);
        const field = this.#numberField(spec);
        field.setAttribute('aria-label', `${spec.label}, number`);
        const showTyped = this.#typed(field, spec);
        const show = (text: string): void => {
          range.value = text;
          range.setAttribute('aria-valuetext', toLabel(spec, text));
          showTyped(text);
        };
        return [[range, field], show];
      }
    }
  }

  #range(spec: ParamSpec): HTMLInputElement {
    const { min, max } = spec;
    // `any`: values between the steps are valid, such as those of fine steps.
    const range = create('input', { type: 'range', min: `${min}`, max: `${max}`, step: 'any' });
    range.addEventListener('input', () => {
      const steps = Math.round((Number(range.value) - min) / spec.step);
      this.#host.set(spec.id, tidy(min + steps * spec.step));
    });
    range.addEventListener('keydown', (event) => {
      // The end of the run is unknown while it is being computed.
      if (spec.kind === 'timeline') this.#host.finishRun();
      const now = Number(range.value);
      const last = Number(range.max);
      const step = event.shiftKey && spec.kind === 'slider' ? spec.step / 10 : spec.step;
      const next = afterKey(event.key, now, { min, max: last, step });
      if (next === undefined) return;
      event.preventDefault();
      this.#host.set(spec.id, tidy(next));
    });
    this.#ranges.set(spec.id, range);
    return range;
  }

  #numberField(spec: ParamSpec): HTMLInputElement {
    const { min, max } = spec;
    const step = spec.kind === 'slider' ? 'any' : '1';
    const field = create('input', { type: 'number', min: `${min}`, max: `${max}`, step });
    field.addEventListener('change', () => {
      const problem = this.#host.set(spec.id, field.value);
      field.setAttribute('aria-invalid', String(problem !== undefined));
    });
    return field;
  }

  /** Shows a value in a field, unless the reader is typing another one. */
  #typed(field: HTMLInputElement, { id }: ParamSpec): (text: string) => void {
    let isBegun = false;
    const show = (text: string): void => {
      const isSame = field.value === text || (field.type === 'number' && Number(field.value) === Number(text));
      if (isBegun || (isSame && hasFocus(field))) return;
      field.value = text;
      field.setAttribute('aria-invalid', 'false');
    };
    field.addEventListener('input', () => (isBegun = true));
    // Capture: has to run before the value is set, which shows the accepted value at once.
    field.addEventListener('change', () => (isBegun = false), { capture: true });
    field.addEventListener('blur', () => {
      if (!isBegun) return;
      isBegun = false;
      show(this.#host.text(id));
    });
    return show;
  }

  #button(spec: ButtonSpec, kind: 'try' | 'do'): HTMLElement {
    const row = create('div', { class: 'control' });
    const button = create('button', { type: 'button' });
    button.textContent = kind === 'try' ? `Try: ${spec.label}` : spec.label;
    button.dataset['control'] = spec.id;
    const help = create('span', { class: 'help' });
    help.id = `help-${kind}-${spec.id}`;
    help.textContent = spec.help;
    button.setAttribute('aria-describedby', help.id);
    if (spec.id === 'play') button.setAttribute('aria-pressed', 'false');
    const keys = [...this.#keys].filter(([, id]) => id === spec.id).map(([key]) => key);
    if (keys.length > 0) button.setAttribute('aria-keyshortcuts', keys.join(' '));
    button.addEventListener('click', () => this.#host.press(spec.id));
    this.#buttons.set(spec.id, button);
    row.append(button, help);
    return row;
  }
}

/** Play, the first controls of the widget, "More", and then the rest. */
function inOrder({ opening }: WidgetSpec, ids: readonly string[]): string[] {
  const rank = (id: string): number => {
    if (id === 'play') return 0;
    if (id === MORE) return 2;
    return opening.includes(id) ? 1 : 3;
  };
  return [...ids].sort((a, b) => rank(a) - rank(b));
}

/** The value after a key press; undefined for keys that change no value. */
function afterKey(
  key: string,
  now: number,
  { min, max, step }: { min: number; max: number; step: number },
): number | undefined {
  const clamp = (value: number): number => Math.min(Math.max(value, min), max);
  switch (key) {
    case 'ArrowRight':
    case 'ArrowUp':
      return clamp(now + step);
    case 'ArrowLeft':
    case 'ArrowDown':
      return clamp(now - step);
    case 'PageUp':
      return clamp(now + 10 * step);
    case 'PageDown':
      return clamp(now - 10 * step);
    case 'Home':
      return min;
    case 'End':
      return max;
    default:
      return undefined;
  }
}

/** Rounds to ten digits: 0.1 + 0.2 becomes 0.3. */
function tidy(value: number): string {
  return String(Number(value.toPrecision(10)));
}

function hasFocus(field: HTMLInputElement): boolean {
  return (field.getRootNode() as ShadowRoot | Document).activeElement === field;
}

function unitOf(spec: ParamSpec): HTMLElement {
  const unit = create('span', { class: 'unit' });
  unit.textContent = spec.unit;
  return unit;
}
