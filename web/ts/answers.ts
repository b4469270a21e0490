// The reader's answers: collected from the events of <slam-predict>, kept in the browser on request, and saved as a file
// for `slam2d mark`.

import type { Prediction } from '../slam-predict';

/** Name and version of the file's format. */
const SCHEMA = 'slam2d-answers/1';
const STORAGE_KEY = SCHEMA;

/** The last answer to an exercise. */
interface Answer {
  exercise: string;
  widget: string;
  state: string;
  prediction: string;
  result: string;
  attempts: number;
  time: string;
}

/** The stored value. */
interface Stored {
  student: string;
  answers: Record<string, Answer[]>;
}

/** Answers by student and exercise. */
const collected = new Map<string, Map<string, Answer>>();
let current = new URLSearchParams(location.search).get('student')?.trim() ?? '';
let isStored = false;
/** Dispatches `change` when a student or an answer changes. */
export const changes = new EventTarget();

readStored();
document.addEventListener('slam-predict', ({ detail }: CustomEvent<Prediction>) => {
  const { exercise, student, widget, state, prediction, result, attempts, time } = detail;
  if (exercise === null) return;
  answersOf(student).set(exercise, { exercise, widget, state, prediction, result, attempts, time });
  changed();
});

/** The name or token of the student; empty for the tasks of the chapter. */
export function student(): string {
  return current;
}

export function setStudent(name: string): void {
  current = name.trim().toWellFormed();
  changed();
}

/** Number of attempts of a student at an exercise so far. */
export function attemptsAt(exercise: string, name: string): number {
  return collected.get(name)?.get(exercise)?.attempts ?? 0;
}

/** Number of exercises that the current student has answered. */
export function answered(): number {
  return collected.get(current)?.size ?? 0;
}

export function keepsAnswers(): boolean {
  return isStored;
}

/** Starts or stops to store the answers in the browser; stopping deletes them. Throws if storage is blocked. */
export function keepAnswers(isOn: boolean): void {
  if (isOn) localStorage.setItem(STORAGE_KEY, storedText());
  else localStorage.removeItem(STORAGE_KEY);
  isStored = isOn;
}

/** The current student's answers as a file. */
export async function answerFile(): Promise<{ name: string; text: string }> {
  const answers = [...answersOf(current).values()];
  const digest = await sha256(canonical(current, answers));
  const name = current.replaceAll(/[^\p{L}\p{N}_-]+/gu, '-');
  const text = JSON.stringify({ schema: SCHEMA, student: current, answers, digest }, null, 1);
  return { name: name === '' ? 'answers.json' : `answers-${name}.json`, text: `${text}\n` };
}

/** The text that the digest covers: only arrays, strings and integers, whose JSON is the same everywhere. */
function canonical(name: string, answers: Answer[]): string {
  const rows = answers.map(({ exercise, widget, state, prediction, result, attempts, time }) =>
    [exercise, widget, state, prediction, result, attempts, time]);
  return JSON.stringify([SCHEMA, name, ...rows]);
}

async function sha256(text: string): Promise<string> {
  // `crypto.subtle` exists only in secure contexts.
  if (!isSecureContext) throw new Error('answers can be saved from a page under https, from this machine, or from a file');
  const digest = await crypto.subtle.digest('SHA-256', new TextEncoder().encode(text));
  return [...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

function answersOf(name: string): Map<string, Answer> {
  const answers = collected.get(name) ?? new Map<string, Answer>();
  collected.set(name, answers);
  return answers;
}

function changed(): void {
  if (isStored) localStorage.setItem(STORAGE_KEY, storedText());
  changes.dispatchEvent(new Event('change'));
}

function storedText(): string {
  const answers = Object.fromEntries([...collected].map(([name, of]) => [name, [...of.values()]]));
  return JSON.stringify({ student: current, answers } satisfies Stored);
}

/** Reads the answers of an earlier visit. Access throws in a sandboxed frame; unreadable answers are ignored. */
function readStored(): void {
  try {
    const text = localStorage.getItem(STORAGE_KEY);
    if (text === null) return;
    const { student: name, answers } = JSON.parse(text) as Stored;
    for (const [of, list] of Object.entries(answers)) {
      for (const answer of list) answersOf(of).set(answer.exercise, answer);
    }
    if (current === '') current = name;
    isStored = true;
  } catch {
    collected.clear();
  }
}
