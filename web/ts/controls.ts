// The controls of a widget: native ones, made from its list of presets, parameters and buttons. Play and its slider stand
// below the picture, then the opening control, then More, which opens the rest.

import { create } from './dom';
import type { ButtonStates, Timeline } from './instance';
import { REST, type Places } from './parts';
import { rangeOf, showFill } from './ranges';
import type { ButtonSpec, ParamSpec, WidgetSpec } from './schema';
import { toLabel } from './values';

/** The switch that shows all controls. */
export const MORE = 'more';
/** The button that plays the run. */
const PLAY = 'play';

export interface ControlHost {
  /** Sets a value; returns the error, if there is one. */
  set(id: string, text: string): string | undefined;
  /** The widget's value. */
  text(id: string): string;
  press(id: string): void;
  /** Finishes the computation on which the length of the run depends, and shows it. */
  finishRun(): void;
}

interface ParamControl {
  spec: ParamSpec;
  show(text: string): void;
}

export class Controls {
  readonly #places: Places;
  readonly #widget: WidgetSpec;
  readonly #rows = new Map<string, HTMLElement>();
  readonly #params = new Map<string, ParamControl>();
  readonly #ranges = new Map<string, HTMLInputElement>();
  readonly #buttons = new Map<string, HTMLButtonElement>();
  readonly #host: ControlHost;
  /** The button for each key. Keys work while one of these buttons has the focus. */
  readonly #keys: ReadonlyMap<string, string>;
  readonly #keyed: ReadonlySet<string>;
  /** The controls that are shown while More is closed. */
  #opening: readonly string[];

  constructor(widget: WidgetSpec, places: Places, host: ControlHost) {
    this.#host = host;
    this.#widget = widget;
    this.#places = places;
    this.#opening = widget.opening;
    this.#keys = new Map(widget.keys.map(({ key, button }) => [key, button]));
    this.#keyed = new Set(this.#keys.values());
    for (const button of widget.presets) this.#rows.set(button.id, this.#button(button, 'try'));
    for (const param of widget.params) this.#rows.set(param.id, param.id === MORE ? this.#more(param) : this.#param(param));
    for (const button of widget.buttons) this.#rows.set(button.id, this.#button(button, 'do'));
    for (const row of this.#rows.values()) row.addEventListener('keydown', (event) => this.#keyDown(event));
    this.offer(widget.opening, false);
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

  /** Shows those controls, each in its place, and hides the others. */
  offer(shown: readonly string[], isOpen: boolean): void {
    if (!isOpen) this.#opening = shown;
    for (const [id, row] of this.#rows) {
      const isShown = shown.includes(id);
      // A hidden control must not keep the focus: "More" gets it.
      if (!isShown && row.matches(':focus-within')) this.#rows.get(MORE)?.querySelector('button')?.focus();
      row.hidden = !isShown;
      const place = this.#placeOf(id);
      if (row.parentElement !== place) place.append(row);
    }
    for (const place of Object.values(this.#places) as HTMLElement[]) this.#sort(place);
  }

  /** Puts the rows of a place in order; those that are in order already do not move, and keep the focus. */
  #sort(place: HTMLElement): void {
    let next: Element | null = place.firstElementChild;
    for (const row of this.#inOrder().map((id) => this.#rows.get(id))) {
      if (row?.parentElement !== place) continue;
      if (row === next) next = row.nextElementSibling;
      else place.insertBefore(row, next);
    }
  }

  /** Play comes first, and its slider after the buttons. */
  #inOrder(): string[] {
    const rank = (id: string): number => {
      if (id === PLAY) return 0;
      return this.#isTimeline(id) ? 2 : 1;
    };
    return [...this.#rows.keys()].sort((a, b) => rank(a) - rank(b));
  }

  #placeOf(id: string): HTMLElement {
    const { transport, first, tools, presets, settings, actions } = this.#places;
    if (id === MORE) return tools;
    const isButton = this.#buttons.has(id);
    if (this.#opening.includes(id)) return isButton || this.#isTimeline(id) ? transport : first;
    if (!isButton) return settings;
    return this.#widget.presets.some((preset) => preset.id === id) ? presets : actions;
  }

  #isTimeline(id: string): boolean {
    return this.#params.get(id)?.spec.kind === 'timeline';
  }

  /** Dims the buttons that have nothing to do. They keep the focus: a press on one may be what ended its work. */
  showButtons({ disabled, pressed }: ButtonStates): void {
    for (const [id, button] of this.#buttons) {
      button.setAttribute('aria-disabled', String(disabled.includes(id)));
      const isPressed = pressed.includes(id);
      if (id === PLAY) button.textContent = isPressed ? 'Pause' : this.#labelOf(id);
      else if (isPressed || button.hasAttribute('aria-pressed')) button.setAttribute('aria-pressed', String(isPressed));
    }
  }

  #labelOf(id: string): string {
    return this.#widget.buttons.find((button) => button.id === id)?.label ?? '';
  }

  /** Shows values that changed elsewhere. */
  show(values: Iterable<[string, string]>): void {
    for (const [id, text] of values) this.#params.get(id)?.show(text);
  }

  /** Shows the length of the run and its events. */
  showTimeline(timeline: Timeline | null): void {
    if (timeline === null) return;
    const { param, last, marks } = timeline;
    const range = this.#ranges.get(param);
    const row = this.#rows.get(param);
    if (range === undefined || row === undefined) return;
    range.max = String(last);
    row.classList.toggle('empty', last === 0);
    showText(row.querySelector('.unit'), `of ${last}`);
    // A run can be shorter than the requested time: the control shows its end.
    const asked = Number(this.#host.text(param));
    this.#params.get(param)?.show(String(Math.min(asked, last)));
    const rail = row.querySelector<HTMLElement>('.marks');
    const drawn = JSON.stringify([last, marks]);
    if (rail === null || rail.dataset['drawn'] === drawn) return;
    rail.dataset['drawn'] = drawn;
    rail.replaceChildren(...marks.map(({ at, standing }) => {
      const mark = create('i', { class: standing });
      mark.style.setProperty('--at', String(at / Math.max(last, 1)));
      return mark;
    }));
    range.onpointermove = ({ offsetX }) => {
      const at = (offsetX / range.clientWidth) * last;
      const near = marks.filter((mark) => Math.abs(mark.at - at) <= 0.015 * last);
      range.title = near.map(({ label }) => label).join('; ');
    };
  }

  #more(spec: ParamSpec): HTMLElement {
    const row = create('span', { class: 'control' });
    const button = create('button', { type: 'button', 'aria-expanded': 'false', 'aria-controls': REST, title: spec.help });
    button.dataset['control'] = spec.id;
    button.id = `control-${spec.id}`;
    button.addEventListener('click', () => this.#host.set(spec.id, this.#host.text(spec.id) === 'on' ? 'off' : 'on'));
    const show = (text: string): void => {
      button.textContent = text === 'on' ? 'Less' : 'More';
      button.setAttribute('aria-expanded', String(text === 'on'));
    };
    show('off');
    this.#params.set(spec.id, { spec, show });
    row.append(button);
    return row;
  }

  #param(spec: ParamSpec): HTMLElement {
    const row = create('div', { class: `control ${spec.kind}`, title: spec.help });
    const name = create('label', { class: 'name' });
    name.textContent = spec.label;
    const help = create('span', { class: 'hidden', id: `help-${spec.id}` });
    help.textContent = spec.help;
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
    const unit = create('span', { class: 'unit' });
    unit.textContent = spec.unit;
    const value = create('span', { class: 'value' });
    const range = this.#ranges.get(spec.id);
    value.append(...inputs.filter((input) => input !== range), unit);
    row.append(name, ...(range === undefined ? [] : [onRail(range, spec)]), value, help);
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
        const range = rangeOf(spec, {
          text: () => this.#host.text(spec.id),
          set: (text) => this.#host.set(spec.id, text),
          // The end of the run is unknown while it is being computed.
          beforeKey: () => { if (spec.kind === 'timeline') this.#host.finishRun(); },
        });
        this.#ranges.set(spec.id, range);
        const field = this.#numberField(spec);
        field.setAttribute('aria-label', `${spec.label}, number`);
        const showTyped = this.#typed(field, spec);
        const show = (text: string): void => {
          range.value = text;
          showFill(range);
          range.setAttribute('aria-valuetext', toLabel(spec, text));
          showTyped(text);
        };
        return [[range, field], show];
      }
    }
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
  #typed(field: HTMLInputElement, spec: ParamSpec): (text: string) => void {
    let isBegun = false;
    const show = (value: string): void => {
      const text = shortened(spec, value);
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
      show(this.#host.text(spec.id));
    });
    return show;
  }

  #button(spec: ButtonSpec, kind: 'try' | 'do'): HTMLElement {
    const row = create('span', { class: `control ${kind}` });
    const button = create('button', { type: 'button', title: spec.help });
    button.textContent = spec.label;
    button.dataset['control'] = spec.id;
    const help = create('span', { class: 'hidden', id: `help-${kind}-${spec.id}` });
    help.textContent = spec.help;
    button.setAttribute('aria-describedby', help.id);
    const keys = [...this.#keys].filter(([, id]) => id === spec.id).map(([key]) => key);
    if (keys.length > 0) button.setAttribute('aria-keyshortcuts', keys.join(' '));
    button.addEventListener('click', () => this.#host.press(spec.id));
    this.#buttons.set(spec.id, button);
    row.append(button, help);
    return row;
  }
}

/** A slider on a rail, with the events of a run. */
function onRail(range: HTMLElement, { kind }: ParamSpec): HTMLElement {
  const rail = create('span', { class: 'rail' });
  rail.append(range);
  if (kind === 'timeline') rail.append(create('span', { class: 'marks', 'aria-hidden': 'true' }));
  return rail;
}

/** A number with at most one digit more than its steps have: those of fine steps. */
function shortened({ kind, decimals }: ParamSpec, text: string): string {
  return kind === 'slider' ? String(Number(Number(text).toFixed(decimals + 1))) : text;
}

function hasFocus(field: HTMLInputElement): boolean {
  return (field.getRootNode() as ShadowRoot | Document).activeElement === field;
}

function showText(element: Element | null, text: string): void {
  if (element !== null && element.textContent !== text) element.textContent = text;
}
