// Reports to a learning management system by SCORM 1.2, if the frame is inside one.
//
// The system offers an object `API` in one of the windows around the frame (SCORM 1.2 Run-Time Environment,
// section 3.3). Every answer is an interaction; the lesson is complete once each question has an answer, and the
// score is the share of predictions that came true, of the last answers.

import type { Prediction } from '../slam-predict';

/** The functions that we call. */
interface Api {
  LMSInitialize(none: ''): string;
  LMSGetValue(name: string): string;
  LMSSetValue(name: string, value: string): string;
  LMSCommit(none: ''): string;
  LMSFinish(none: ''): string;
}

/** Windows around windows that are searched. */
const MOST_PARENTS = 7;
/** SCORM names choices by one letter. */
const LETTERS = 'abcdefghijklmnopqrstuvwxyz';

export interface Reports {
  /** The id of the student in the system. */
  student: string;
  answered(prediction: Prediction, choices: string[]): void;
  end(): void;
}

/** Starts a session for these questions; undefined without a system around. */
export function connect(start: Window, questions: string[]): Reports | undefined {
  const api = findApi(start);
  if (api === undefined || api.LMSInitialize('') !== 'true') return undefined;
  const came = new Map<string, boolean>();
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
      tell(api, `cmi.interactions.${next}`, prediction, choices);
      next += 1;
      came.set(exercise, correct);
      const right = [...came.values()].filter(Boolean).length;
      api.LMSSetValue('cmi.core.score.min', '0');
      api.LMSSetValue('cmi.core.score.max', '100');
      api.LMSSetValue('cmi.core.score.raw', String(Math.round((100 * right) / questions.length)));
      if (came.size === questions.length) api.LMSSetValue('cmi.core.lesson_status', 'completed');
      api.LMSCommit('');
    },
    end: () => void api.LMSFinish(''),
  };
}

function tell(api: Api, place: string, prediction: Prediction, choices: string[]): void {
  const isChoice = choices.length > 0;
  const written = (answer: string): string => (isChoice ? (LETTERS[choices.indexOf(answer)] ?? '') : answer);
  const set = (name: string, value: string): void => void api.LMSSetValue(`${place}.${name}`, value);
  set('id', prediction.exercise ?? '');
  set('type', isChoice ? 'choice' : 'numeric');
  set('time', new Date(prediction.time).toTimeString().slice(0, 'hh:mm:ss'.length));
  set('student_response', written(prediction.prediction));
  if (prediction.right !== null) set('correct_responses.0.pattern', written(prediction.right));
  set('result', prediction.correct ? 'correct' : 'wrong');
}

/** The nearest one outwards, also in the window that opened this one. */
function findApi(start: Window): Api | undefined {
  let at = start;
  try {
    for (let k = 0; k < MOST_PARENTS; k += 1) {
      const api = (at as Window & { API?: Api }).API;
      if (api !== undefined) return api;
      if (at.parent === at) break;
      at = at.parent;
    }
    return (start.opener as { API?: Api } | null)?.API;
  } catch {
    // A window of another host may not be asked.
    return undefined;
  }
}
