// The tests of the written functions for `ch16-mark`, whose engine calls them. The build bundles this into
// teaching/mark/src/written.js. Arguments and results pass as text, because the student's code has a realm of its own.

import { EXERCISES } from './exercises';

interface Marking {
  /** The names of the functions. */
  names(): string[];
  /** Number of tests of a function. */
  count(name: string): number;
  /** The call of a test as text: `gate(Float64Array.of(0.045, 0, 0), 1, [0.045, 0.012], 7.815)`. */
  call(name: string, test: number): string;
  /** The sentence of a failure, or an empty one. */
  fault(name: string, test: number, result: unknown): string;
}

function trial(name: string, test: number) {
  const found = EXERCISES.get(name)?.trials[test];
  if (found === undefined) throw new RangeError(`${name} has no test ${test}`);
  return found;
}

function text(value: unknown): string {
  if (value instanceof Float64Array) return `Float64Array.of(${[...value].join(', ')})`;
  return Array.isArray(value) ? `[${value.map(text).join(', ')}]` : String(value);
}

(globalThis as unknown as { marking: Marking }).marking = {
  names: () => [...EXERCISES.keys()],
  count: (name) => EXERCISES.get(name)?.trials.length ?? 0,
  call: (name, test) => `${name}(${trial(name, test).arguments.map(text).join(', ')})`,
  fault: (name, test, result) => {
    const { name: what, fault } = trial(name, test);
    const sentence = fault(result);
    return sentence === undefined ? '' : `${what}: ${sentence}`;
  },
};
