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

/** The value of a student's task by `varies="noise=3,4"`: one of them. Undefined if nothing but the seed varies. */
export function ownValue(varies: string, student: string, exercise: string): { id: string; value: string } | undefined {
  const [, id, values] = /^([\w-]+)=(.+)$/.exec(varies) ?? [];
  if (id === undefined || values === undefined) return undefined;
  const all = values.split(',');
  const value = all[seedOf(student, exercise, 0) % all.length];
  return value === undefined ? undefined : { id, value };
}

/** A state with a value in place of its own. */
export function withValue(state: string, { id, value }: { id: string; value: string }): string {
  return state.split('&').map((pair) => (pair.startsWith(`${id}=`) ? `${id}=${value}` : pair)).join('&');
}
