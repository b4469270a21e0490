// The reader's answers on this page: collected from the events of <slam-predict>, kept in the browser if the
// reader asks for it, and saved as one file that `slam2d mark` reads.

import type { Prediction } from '../slam-predict';

/** Name and version of the file's format. */
const SCHEMA = 'slam2d-answers/1';
/** Where the browser keeps the answers. */
const PLACE = SCHEMA;

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

/** What the browser keeps. */
interface Kept {
  student: string;
  answers: Record<string, Answer[]>;
}

/** Answers by student and exercise. */
const collected = new Map<string, Map<string, Answer>>();
let current = new URLSearchParams(location.search).get('student')?.trim() ?? '';
let isKept = false;
/** Dispatches `change` when a student or an answer changes. */
export const changes = new EventTarget();

readKept();
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
  return isKept;
}

/** Starts or stops to keep the answers in this browser; stopping deletes what it kept. Throws if it may not store. */
export function keepAnswers(isOn: boolean): void {
  if (isOn) localStorage.setItem(PLACE, keptText());
  else localStorage.removeItem(PLACE);
  isKept = isOn;
}

/** The current student's answers as a file. */
export async function answerFile(): Promise<{ name: string; text: string }> {
  const answers = [...answersOf(current).values()];
  const digest = await sha256(canonical(current, answers));
  const name = current.replaceAll(/[^\p{L}\p{N}_-]+/gu, '-');
  const text = JSON.stringify({ schema: SCHEMA, student: current, answers, digest }, null, 1);
  return { name: name === '' ? 'answers.json' : `answers-${name}.json`, text: `${text}\n` };
}

/** The text whose digest is in the file: arrays of texts and whole numbers, which have one form in JSON. */
function canonical(name: string, answers: Answer[]): string {
  const rows = answers.map(({ exercise, widget, state, prediction, result, attempts, time }) =>
    [exercise, widget, state, prediction, result, attempts, time]);
  return JSON.stringify([SCHEMA, name, ...rows]);
}

async function sha256(text: string): Promise<string> {
  // Browsers have it only on pages that nobody in between can have changed.
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
  if (isKept) localStorage.setItem(PLACE, keptText());
  changes.dispatchEvent(new Event('change'));
}

function keptText(): string {
  const answers = Object.fromEntries([...collected].map(([name, of]) => [name, [...of.values()]]));
  return JSON.stringify({ student: current, answers } satisfies Kept);
}

/** What an earlier visit kept. A frame in a sandbox may not ask, and what cannot be read is as good as nothing. */
function readKept(): void {
  try {
    const text = localStorage.getItem(PLACE);
    if (text === null) return;
    const { student: name, answers } = JSON.parse(text) as Kept;
    for (const [of, list] of Object.entries(answers)) {
      for (const answer of list) answersOf(of).set(answer.exercise, answer);
    }
    if (current === '') current = name;
    isKept = true;
  } catch {
    collected.clear();
  }
}
