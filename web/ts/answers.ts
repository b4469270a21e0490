// The reader's answers: collected from the events of <slam-predict>, kept in the browser on request, and saved as a file
// for `ch16-mark`.

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

/** A function of the page's editors, as it was run last. */
interface Written {
  function: string;
  code: string;
  attempts: number;
  time: string;
  /** Steps of help taken before any of the runs; 4 if the page had shown its solution. Earlier versions did not count. */
  help?: number;
}

/** The stored value. */
interface Stored {
  student: string;
  answers: Record<string, Answer[]>;
  code?: Record<string, Written[]>;
}

/** Answers by student and exercise. */
const collected = new Map<string, Map<string, Answer>>();
/** Functions by student and name. */
const written = new Map<string, Map<string, Written>>();
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

document.addEventListener('slam-code', (event) => {
  const { name, code, help } = (event as CustomEvent<{ name: string; code: string; help: number }>).detail;
  const functions = functionsOf(current);
  const before = functions.get(name);
  const attempts = (before?.attempts ?? 0) + 1;
  functions.set(name, { function: name, code, attempts, time: new Date().toISOString(), help: Math.max(before?.help ?? 0, help) });
  changed();
});

/** The name or token of the student; empty for the tasks of the chapter. */
export function student(): string {
  return current;
}

export function setStudent(name: string): void {
  current = name.trim().replace(/\p{Surrogate}/gu, '\uFFFD');
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

/** Number of functions that the current student has run. */
export function functions(): number {
  return written.get(current)?.size ?? 0;
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
  const code = [...functionsOf(current).values()];
  const digest = await sha256(canonical(current, answers, code));
  const name = current.replaceAll(/[^\p{L}\p{N}_-]+/gu, '-');
  const text = JSON.stringify({ schema: SCHEMA, student: current, answers, ...(code.length === 0 ? {} : { code }), digest }, null, 1);
  return { name: name === '' ? 'answers.json' : `answers-${name}.json`, text: `${text}\n` };
}

/** The text that the digest covers: only arrays, strings and integers, whose JSON is the same everywhere. */
function canonical(name: string, answers: Answer[], functions: Written[]): string {
  const rows = answers.map(({ exercise, widget, state, prediction, result, attempts, time }) =>
    [exercise, widget, state, prediction, result, attempts, time]);
  const codes = functions.map(({ function: of, code, attempts, time, help }) =>
    [of, code, attempts, time, ...(help === undefined ? [] : [help])]);
  return JSON.stringify([SCHEMA, name, ...rows, ...codes]);
}

async function sha256(text: string): Promise<string> {
  // `crypto.subtle` exists only in secure contexts.
  if (!isSecureContext) throw new Error('this needs a page served over https, from localhost, or opened from a file');
  const digest = await crypto.subtle.digest('SHA-256', new TextEncoder().encode(text));
  return [...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

function answersOf(name: string): Map<string, Answer> {
  const answers = collected.get(name) ?? new Map<string, Answer>();
  collected.set(name, answers);
  return answers;
}

function functionsOf(name: string): Map<string, Written> {
  const functions = written.get(name) ?? new Map<string, Written>();
  written.set(name, functions);
  return functions;
}

function changed(): void {
  if (isStored) localStorage.setItem(STORAGE_KEY, storedText());
  changes.dispatchEvent(new Event('change'));
}

function storedText(): string {
  const lists = <T>(all: Map<string, Map<string, T>>): Record<string, T[]> =>
    Object.fromEntries([...all].map(([name, of]) => [name, [...of.values()]]));
  return JSON.stringify({ student: current, answers: lists(collected), code: lists(written) } satisfies Stored);
}

/** Reads the answers of an earlier visit. Access throws in a sandboxed frame; unreadable answers are ignored. */
function readStored(): void {
  try {
    const text = localStorage.getItem(STORAGE_KEY);
    if (text === null) return;
    const { student: name, answers, code = {} } = JSON.parse(text) as Stored;
    for (const [of, list] of Object.entries(answers)) {
      for (const answer of list) answersOf(of).set(answer.exercise, answer);
    }
    for (const [of, list] of Object.entries(code)) {
      for (const one of list) functionsOf(of).set(one.function, one);
    }
    if (current === '') current = name;
    isStored = true;
  } catch {
    collected.clear();
    written.clear();
  }
}
