// Validation of values from links, attributes and messages. It repeats the core's rules (`ParamSpec::parse`) to check a
// link before the module has loaded; a test compares the two on the same texts.

import type { ParamSpec } from './schema';

/** A value for JavaScript: a number, a text, the name of an option, or a boolean. */
export type Value = number | string | boolean;

export type Parsed = { ok: true; text: string } | { ok: false; problem: string };

const WORD = /^[\w-]*$/;
const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

/** Validates a value from a reader, a link or a program. */
export function parseValue(spec: ParamSpec, input: unknown): Parsed {
  const text = String(input).trim();
  const reject = (expected: string): Parsed => ({
    ok: false,
    problem: `\`${spec.id}\` takes ${expected}, not \`${shorten(text)}\``,
  });
  switch (spec.kind) {
    case 'choice':
      return spec.options.some((option) => option.id === text)
        ? { ok: true, text }
        : reject(spec.options.map((option) => option.id).join(' or '));
    case 'switch':
      if (['on', '1', 'true'].includes(text)) return { ok: true, text: 'on' };
      if (['off', '0', 'false'].includes(text)) return { ok: true, text: 'off' };
      return reject('on or off');
    case 'text':
      // The core validates the content when it runs.
      return text.length <= spec.max && WORD.test(text)
        ? { ok: true, text }
        : reject(`at most ${spec.max} letters, digits, - and _`);
    default: {
      if (!NUMBER.test(text)) return reject('a number');
      const value = Number(text);
      const slack = 1e-6 * spec.step;
      if (!Number.isFinite(value) || value < spec.min - slack || value > spec.max + slack) {
        return reject(`${spec.min} to ${spec.max}`);
      }
      const clamped = Math.min(Math.max(value, spec.min), spec.max);
      return { ok: true, text: String(spec.kind === 'slider' ? clamped : Math.round(clamped)) };
    }
  }
}

/** The default as in a link. */
export function defaultText(spec: ParamSpec): string {
  if (spec.kind === 'choice') return spec.options[spec.default]?.id ?? '';
  if (spec.kind === 'switch') return spec.default === 0 ? 'off' : 'on';
  return spec.kind === 'text' ? '' : String(spec.default);
}

/** The value for JavaScript. */
export function toValue(spec: ParamSpec, text: string): Value {
  if (spec.kind === 'choice' || spec.kind === 'text') return text;
  if (spec.kind === 'switch') return text === 'on';
  return Number(text);
}

/** The value with its unit for display: `60°`, `0.70 m`. */
export function toLabel(spec: ParamSpec, text: string): string {
  if (spec.kind === 'choice') {
    return spec.options.find((option) => option.id === text)?.label ?? text;
  }
  if (spec.kind === 'switch') return text;
  // The text itself is long and encoded.
  if (spec.kind === 'text') return text === '' ? 'none' : 'what it was';
  const value = Number(text);
  const onStep = Math.abs(value - Number(value.toFixed(spec.decimals))) < 1e-9;
  const number = value.toFixed(onStep ? spec.decimals : spec.decimals + 1);
  return spec.unit === '' || spec.unit === '°' ? number + spec.unit : `${number} ${spec.unit}`;
}

/** Shortens a text from outside for display. */
export function shorten(text: string): string {
  return text.length > 60 ? `${text.slice(0, 60)}…` : text;
}
