// "Write it yourself" under a listing: an editor, its tests, and help. Loaded when it is opened.
//
// No address carries code: the reader types it, and presses Run. It is kept in the browser only while the box is on. The
// document hears of each run by the event `slam-code`, for the file of answers.

import { edit, type Editor } from './editor';
import { Driving, type Seat, seatsOf } from './driving';
import { EXERCISES, type Exercise } from './exercises';
import { call, NotRun } from './sandbox';

/** What the reader has to know first. */
const WHERE = 'In JavaScript, with tests. Your code runs in this browser only, without access to the page or the network.';
/** Start of the keys in the browser's storage. */
const STORAGE = 'slam2d-code/1:';

/** Fills an opened `<details data-write="svd_align">`, once. */
export function open(details: HTMLElement): void {
  const exercise = EXERCISES.get(details.dataset['write'] ?? '');
  if (exercise === undefined || details.querySelector('.write-editor') !== null) return;
  const kept = stored(exercise);
  const where = sentence(WHERE);
  const place = element('div', 'write-editor');
  const controls = element('p', 'write-controls');
  const results = element('div', 'write-results');
  results.setAttribute('role', 'status');
  const box = element('input');
  box.type = 'checkbox';
  box.checked = kept !== undefined;
  const label = element('label');
  label.append(box, ' Keep my code in this browser');
  const driving = element('p', 'write-controls');
  details.append(where, place, controls, driving, results);
  const keep = (text: string): void => {
    if (box.checked && !store(exercise, text)) {
      box.checked = false;
      results.replaceChildren(sentence('This browser does not let the page store anything. Copy your code into a file instead.'));
    }
  };
  const editor = edit(place, kept ?? exercise.stub, `Your ${exercise.name}, in JavaScript. Tab leaves the editor.`, keep);
  box.addEventListener('change', () => {
    if (box.checked) keep(editor.text());
    else store(exercise, undefined);
  });
  const run = button('Run', () => {
    run.disabled = true;
    editor.mark();
    results.replaceChildren(sentence('Your function is being called …'));
    const help = isSolution(editor.text(), exercise) ? 4 : taken;
    document.dispatchEvent(new CustomEvent('slam-code', { detail: { name: exercise.name, code: editor.text(), help } }));
    void test(editor.text(), exercise).then(({ sentences, line }) => {
      results.replaceChildren(...sentences);
      if (line !== undefined) editor.mark(line.number, line.message);
      run.disabled = false;
    });
  });
  /** Steps of help that the reader took. */
  let taken = 0;
  let shownHelp = 0;
  const help = button('Help (1 of 4)', () => {
    const step = exercise.help[shownHelp];
    if (step !== undefined) {
      results.append(sentence(step));
    } else {
      editor.replace(exercise.solution);
      results.append(sentence('This is a solution. Undo brings yours back. Saved answers note that it was shown.'));
    }
    taken = shownHelp + 1;
    shownHelp = Math.min(shownHelp + 1, exercise.help.length);
    help.textContent = shownHelp < exercise.help.length ? `Help (${shownHelp + 1} of 4)` : 'Help (4 of 4): the solution';
  });
  controls.append(run, ' ', help, ' ', label);
  for (const seat of seatsOf(exercise.name)) driving.append(driveButton(seat, exercise, editor, results), ' ');
}

/** A button that lets the code drive a widget, and gives the widget back to ours. */
function driveButton(seat: Seat, exercise: Exercise, editor: Editor, results: HTMLElement): HTMLButtonElement {
  let driving: Driving | undefined;
  const idle = `Drive ${seat.what} with it`;
  const show = (text: string, ...more: (Node | string)[]): void => {
    const said = sentence(text);
    said.append(...more);
    results.replaceChildren(said);
  };
  const ended = (): void => {
    driving = undefined;
    made.textContent = idle;
  };
  const failed = (why: NotRun): void => {
    ended();
    if (why.line !== undefined) editor.mark(why.line, why.message);
    show(`✗ ${why.line === undefined ? '' : `Line ${why.line}: `}${why.message} Ours drives again.`);
  };
  const start = async (): Promise<void> => {
    editor.mark();
    show('Your function takes its seat …');
    driving = await Driving.start(editor.text(), exercise.name, seat, (why) => failed(why));
    made.textContent = `Let ours drive ${seat.what} again`;
    const look = button('Show it', () => {
      seat.widget.scrollIntoView({ block: 'center' });
      seat.widget.focus({ preventScroll: true });
    });
    show(`Your ${exercise.name}, as it is now, drives ${seat.what}: each change there calls it again. `, look);
  };
  const made = button(idle, () => {
    if (driving !== undefined) {
      driving.end();
      ended();
      show('Ours drives again.');
      return;
    }
    made.disabled = true;
    start().catch((why: unknown) => {
      if (!(why instanceof NotRun)) throw why;
      failed(why);
    }).finally(() => (made.disabled = false));
  });
  // Another function took the seat.
  seat.widget.addEventListener('slam-driver', () => {
    if (driving === undefined || seat.widget.driver === driving) return;
    driving.end();
    ended();
  });
  return made;
}

interface Tested {
  sentences: HTMLElement[];
  line?: { number: number; message: string };
}

/** Runs the tests: a sentence for each, the failures first, and the line of the first error. */
async function test(code: string, exercise: Exercise): Promise<Tested> {
  try {
    const called = await call(code, exercise.name, exercise.trials.map((trial) => trial.arguments));
    const faults: HTMLElement[] = [];
    const right: HTMLElement[] = [];
    let line: Tested['line'];
    for (const [k, trial] of exercise.trials.entries()) {
      const answer = called[k];
      if (answer === undefined) {
        faults.push(sentence(`✗ ${trial.name}: your function gave no answer.`));
        continue;
      }
      if ('error' in answer) {
        const at = answer.line === undefined ? '' : ` in line ${answer.line}`;
        faults.push(sentence(`✗ ${trial.name}: your function ended with ${answer.error}${at}.`));
        if (answer.line !== undefined) line ??= { number: answer.line, message: answer.error };
        continue;
      }
      const fault = trial.fault(answer.result);
      if (fault === undefined) right.push(sentence(`✓ ${trial.name}: as expected.`));
      else faults.push(sentence(`✗ ${trial.name}: ${fault}`));
    }
    const all = faults.length === 0 ? [sentence(`All ${right.length} tests pass: ${exercise.name} is written.`)] : [];
    return { sentences: [...all, ...faults, ...right], ...(line === undefined ? {} : { line }) };
  } catch (error) {
    if (!(error instanceof NotRun)) throw error;
    const at = error.line === undefined ? '' : `Line ${error.line}: `;
    const found: Tested = { sentences: [sentence(`✗ ${at}${error.message}`)] };
    return error.line === undefined ? found : { ...found, line: { number: error.line, message: error.message } };
  }
}

/** Whether the code is the solution but for spaces, as after a reload. */
function isSolution(code: string, exercise: Exercise): boolean {
  const letters = (text: string): string => text.replaceAll(/\s/g, '');
  return letters(code) === letters(exercise.solution);
}

function stored(exercise: Exercise): string | undefined {
  try {
    return localStorage.getItem(STORAGE + exercise.name) ?? undefined;
  } catch {
    // A sandboxed frame has no storage.
    return undefined;
  }
}

/** Stores the code, or removes it; whether that was possible. */
function store(exercise: Exercise, text: string | undefined): boolean {
  try {
    if (text === undefined) localStorage.removeItem(STORAGE + exercise.name);
    else localStorage.setItem(STORAGE + exercise.name, text);
    return true;
  } catch {
    return false;
  }
}

function sentence(text: string): HTMLElement {
  const line = element('p');
  line.textContent = text;
  return line;
}

function button(text: string, press: () => void): HTMLButtonElement {
  const made = element('button');
  made.type = 'button';
  made.textContent = text;
  made.addEventListener('click', press);
  return made;
}

function element<K extends keyof HTMLElementTagNameMap>(tag: K, className = ''): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  made.className = className;
  return made;
}
