// ScormSession to a learning management system by SCORM 1.2, if the frame is inside one.
//
// The system provides an object `API` in an ancestor window (SCORM 1.2 Run-Time Environment, section 3.3). Every answer
// is an interaction. The lesson is complete once each question has an answer; the score is the share of correct
// predictions among the first answers, because each answer shows what happens; a setting takes the best or the last ones.
// What counts so far is kept in `cmi.suspend_data`, so a student who leaves and comes back keeps it.

import type { Prediction } from '../slam-predict';

/** The part of the API that we use. */
interface Api {
  LMSInitialize(none: ''): string;
  LMSGetValue(name: string): string;
  LMSSetValue(name: string, value: string): string;
  LMSCommit(none: ''): string;
  LMSFinish(none: ''): string;
}

/** Ancestor windows to search. */
const MAX_ANCESTORS = 7;
/** SCORM identifies a choice by one letter. */
const LETTERS = 'abcdefghijklmnopqrstuvwxyz';

/** Which of several answers to a question counts. */
export type Counts = 'best' | 'first' | 'last';

export interface ScormSession {
  /** The student's id in the system. */
  student: string;
  /** The questions answered so far, and whether the answer that counts came true. */
  results: ReadonlyMap<string, boolean>;
  answered(prediction: Prediction, choices: string[]): void;
  end(): void;
}

/** Starts a session for these questions; undefined if there is no API. `now` is the time in ms. */
export function connect(
  start: Window, questions: string[], counts: Counts = 'first', now: () => number = Date.now,
): ScormSession | undefined {
  const api = findApi(start);
  if (api === undefined || api.LMSInitialize('') !== 'true') return undefined;
  const began = now();
  const set = (name: string, value: string): void => void api.LMSSetValue(name, value);
  const results = restored(api.LMSGetValue('cmi.suspend_data'), questions);
  let next = Number(api.LMSGetValue('cmi.interactions._count')) || 0;
  const before = api.LMSGetValue('cmi.core.lesson_status');
  const isDone = (): boolean => results.size === questions.length;
  if (before === 'not attempted' || before === '') {
    set('cmi.core.lesson_status', 'incomplete');
    api.LMSCommit('');
  }
  return {
    student: api.LMSGetValue('cmi.core.student_id').trim(),
    results,
    answered: (prediction, choices) => {
      const { exercise, correct } = prediction;
      if (exercise === null) return;
      writeInteraction(api, `cmi.interactions.${next}`, prediction, choices);
      next += 1;
      results.set(exercise, counted(results.get(exercise), correct, counts));
      const right = [...results.values()].filter(Boolean).length;
      set('cmi.core.score.min', '0');
      set('cmi.core.score.max', '100');
      set('cmi.core.score.raw', String(Math.round((100 * right) / questions.length)));
      set('cmi.suspend_data', JSON.stringify(Object.fromEntries(results)));
      if (isDone()) set('cmi.core.lesson_status', 'completed');
      api.LMSCommit('');
    },
    end: () => {
      set('cmi.core.session_time', duration(now() - began));
      // An empty exit ends the attempt in some systems, and the next visit would begin at nothing.
      set('cmi.core.exit', 'suspend');
      api.LMSCommit('');
      api.LMSFinish('');
    },
  };
}

/** Whether a question counts as right, with one more answer. */
function counted(before: boolean | undefined, now: boolean, counts: Counts): boolean {
  if (before === undefined || counts === 'last') return now;
  return counts === 'first' ? before : before || now;
}

/** The results of an earlier visit; of other questions, or unreadable ones, none. */
function restored(text: string, questions: string[]): Map<string, boolean> {
  try {
    const entries = Object.entries(JSON.parse(text) as Record<string, unknown>);
    return new Map(entries.filter((entry): entry is [string, boolean] =>
      questions.includes(entry[0]) && typeof entry[1] === 'boolean'));
  } catch {
    return new Map();
  }
}

/** A time in ms as CMITimespan: HHHH:MM:SS. */
function duration(time_ms: number): string {
  const seconds = Math.max(0, Math.round(time_ms / 1000));
  const two = (number: number): string => String(number).padStart(2, '0');
  return `${String(Math.floor(seconds / 3600)).padStart(4, '0')}:${two(Math.floor(seconds / 60) % 60)}:${two(seconds % 60)}`;
}

function writeInteraction(api: Api, prefix: string, prediction: Prediction, choices: string[]): void {
  const isChoice = choices.length > 0;
  const encode = (answer: string): string => (isChoice ? (LETTERS[choices.indexOf(answer)] ?? '') : answer);
  const set = (name: string, value: string): void => void api.LMSSetValue(`${prefix}.${name}`, value);
  set('id', prediction.exercise ?? '');
  set('type', isChoice ? 'choice' : 'numeric');
  set('time', new Date(prediction.time).toTimeString().slice(0, 'hh:mm:ss'.length));
  set('student_response', encode(prediction.prediction));
  if (prediction.right !== null) set('correct_responses.0.pattern', encode(prediction.right));
  set('result', prediction.correct ? 'correct' : 'wrong');
}

/** Searches the ancestors, then the opener. */
function findApi(start: Window): Api | undefined {
  let at = start;
  try {
    for (let k = 0; k < MAX_ANCESTORS; k += 1) {
      const api = (at as Window & { API?: Api }).API;
      if (api !== undefined) return api;
      if (at.parent === at) break;
      at = at.parent;
    }
    return (start.opener as { API?: Api } | null)?.API;
  } catch {
    // Access to a window of another origin throws.
    return undefined;
  }
}
