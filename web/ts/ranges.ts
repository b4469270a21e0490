// Sliders: steps of their own, finer under Shift, also by keyboard.

import { create } from './dom';
import type { ParamSpec } from './schema';

export interface RangeHost {
  /** The present value. */
  text(): string;
  set(text: string): void;
  /** Called before a key changes the value. */
  beforeKey(): void;
}

/** The slider of a parameter. */
export function rangeOf(spec: ParamSpec, host: RangeHost): HTMLInputElement {
  const { min, max } = spec;
  // `any`: values between the steps are valid, such as those of fine steps.
  const range = create('input', { type: 'range', min: `${min}`, max: `${max}`, step: 'any' });
  undoSwipes(range, host);
  range.addEventListener('input', () => {
    showFill(range);
    const steps = Math.round((Number(range.value) - min) / spec.step);
    host.set(tidy(min + steps * spec.step));
  });
  range.addEventListener('keydown', (event) => {
    host.beforeKey();
    const step = event.shiftKey && spec.kind === 'slider' ? spec.step / 10 : spec.step;
    const next = afterKey(event.key, Number(range.value), { min, max: Number(range.max), step });
    if (next === undefined) return;
    event.preventDefault();
    host.set(tidy(next));
  });
  return range;
}

/** Fills the rail up to the thumb. */
export function showFill(range: HTMLInputElement): void {
  const [min, max, value] = [range.min, range.max, range.value].map(Number) as [number, number, number];
  range.style.setProperty('--fill', String(max > min ? (value - min) / (max - min) : 0));
}

/** A touch moves the thumb at once. If it then scrolls the page, the value returns. */
function undoSwipes(range: HTMLInputElement, host: RangeHost): void {
  let touch: { text: string; moves: number } | undefined;
  range.addEventListener('pointerdown', ({ pointerType }) => {
    touch = pointerType === 'touch' ? { text: host.text(), moves: 0 } : undefined;
  });
  range.addEventListener('input', () => {
    if (touch !== undefined) touch.moves += 1;
  });
  range.addEventListener('pointerup', () => (touch = undefined));
  range.addEventListener('pointercancel', () => {
    if (touch?.moves === 1) host.set(touch.text);
    touch = undefined;
  });
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
