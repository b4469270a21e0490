// ScormSession to a learning management system by SCORM 1.2, if the frame is inside one.
//
// The system provides an object `API` in an ancestor window (SCORM 1.2 Run-Time Environment, section 3.3). Every answer
// is an interaction. The lesson is complete once each question has an answer; the score is the share of correct
// predictions among the last answers.

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

export interface ScormSession {
  /** The student's id in the system. */
  student: string;
  answered(prediction: Prediction, choices: string[]): void;
  end(): void;
}

/** Starts a session for these questions; undefined if there is no API. */
export function connect(start: Window, questions: string[]): ScormSession | undefined {
  const api = findApi(start);
  if (api === undefined || api.LMSInitialize('') !== 'true') return undefined;
  const results = new Map<string, boolean>();
  let next = Number(api.LMSGetValue('cmi.interactions._count')) || 0;
  if (api.LMSGetValue('cmi.core.lesson_status') === 'not attempted') {
    api.LMSSetValue('cmi.core.lesson_status', 'incomplete');
    api.LMSCommit('');
  }
  return {
    student: api.LMSGetValue('cmi.core.student_id').trim(),
    answered: (prediction, choices) => {
      const { exercise, correct } = prediction;
      if (exercise === null) return;
      writeInteraction(api, `cmi.interactions.${next}`, prediction, choices);
      next += 1;
      results.set(exercise, correct);
      const right = [...results.values()].filter(Boolean).length;
      api.LMSSetValue('cmi.core.score.min', '0');
      api.LMSSetValue('cmi.core.score.max', '100');
      api.LMSSetValue('cmi.core.score.raw', String(Math.round((100 * right) / questions.length)));
      if (results.size === questions.length) api.LMSSetValue('cmi.core.lesson_status', 'completed');
      api.LMSCommit('');
    },
    end: () => void api.LMSFinish(''),
  };
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
