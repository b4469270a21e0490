// Personal tasks: a separate seed for each student and exercise, because neighbours should get different laps.
//
// `ch16-mark` derives the same seeds; tests/reference/student-seeds.json pins both.

/** Seeds to try until one of the choices is right. */
export const MAX_ATTEMPTS = 100;

/** FNV-1a over the UTF-8 text `student`, newline, exercise, newline, attempt; then the finalizer of MurmurHash3. */
export function seedOf(student: string, exercise: string, attempt: number): number {
  let hash = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(`${student}\n${exercise}\n${attempt}`)) {
    hash = Math.imul(hash ^ byte, 0x01000193);
  }
  hash = Math.imul(hash ^ (hash >>> 16), 0x85ebca6b);
  hash = Math.imul(hash ^ (hash >>> 13), 0xc2b2ae35);
  return (hash ^ (hash >>> 16)) >>> 0;
}

/**
 * The parameters of a student's task by `varies="noise seed: 3.25 12, 3.5 7"`: names, and the values of each task, of which
 * a hash deals one. Undefined if there are no tasks to deal.
 */
export function ownTask(varies: string, student: string, exercise: string): Map<string, string> | undefined {
  const [, names = '', tasks] = /^([^:]+):(.+)$/.exec(varies) ?? [];
  if (tasks === undefined) return undefined;
  const all = tasks.split(',');
  const values = all[seedOf(student, exercise, 0) % all.length]?.trim().split(/\s+/) ?? [];
  return new Map(names.trim().split(/\s+/).map((name, k) => [name, values[k] ?? '']));
}

/** A state with these values: in place of its own, or after them. */
export function withValues(state: string, values: Map<string, string>): string {
  const pairs = new Map(state.split('&').map((pair) => pair.split('=', 2) as [string, string]));
  for (const [name, value] of values) pairs.set(name, value);
  return [...pairs].map(([name, value]) => `${name}=${value}`).join('&');
}
