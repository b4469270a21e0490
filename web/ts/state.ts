// The values of one widget: validated, and always complete.

import { writeQuery } from './links';
import { findParam, type WidgetSpec } from './schema';
import { defaultText, parseValue, shorten, toLabel, toValue, type Parsed, type Value } from './values';

export class State {
  readonly spec: WidgetSpec;
  readonly #texts: Map<string, string>;

  constructor(spec: WidgetSpec) {
    this.spec = spec;
    this.#texts = new Map(spec.params.map((param) => [param.id, defaultText(param)]));
  }

  /** Every value as in a link. */
  get texts(): ReadonlyMap<string, string> {
    return this.#texts;
  }

  text(id: string): string {
    return this.#texts.get(id) ?? '';
  }

  /** The value for JavaScript; undefined if the widget has no such parameter. */
  value(id: string): Value | undefined {
    const spec = findParam(this.spec, id);
    return spec && toValue(spec, this.text(id));
  }

  /** The value in words with its unit. */
  label(id: string): string | undefined {
    const spec = findParam(this.spec, id);
    return spec && toLabel(spec, this.text(id));
  }

  toJSON(): Record<string, Value> {
    const { params } = this.spec;
    return Object.fromEntries(params.map((spec) => [spec.id, toValue(spec, this.text(spec.id))]));
  }

  /** The state as the query of a link. */
  get query(): string {
    return writeQuery(this.spec, this.#texts);
  }

  /** Validates a value from outside, without storing it. */
  parse(id: string, input: unknown): Parsed {
    const spec = findParam(this.spec, id);
    if (spec !== undefined) return parseValue(spec, input);
    const known = this.spec.params.map((param) => param.id).join(', ');
    const problem = `${this.spec.id} has no parameter \`${shorten(id)}\`; it has ${known}`;
    return { ok: false, problem };
  }

  /** The error for an unknown button or preset; undefined for a known one. */
  buttonProblem(id: string): string | undefined {
    const known = [...this.spec.presets, ...this.spec.buttons].map((button) => button.id);
    if (known.includes(id)) return undefined;
    return `${this.spec.id} has no button \`${shorten(id)}\`; it has ${known.join(', ')}`;
  }

  /** Stores a valid text. */
  keep(id: string, text: string): void {
    this.#texts.set(id, text);
  }
}
