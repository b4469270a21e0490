// The element's shadow tree: the question, the picture, Play, the opening control, the verdict, and what More opens.

import { create, stopKeyPropagation } from './dom';
import { copyText } from './export';
import { CrashError } from './instance';
import { StaleError } from './module';
import { STYLE } from './style';

/** Id of the text alternative. */
export const SUMMARY = 'summary';
/** Id of what More opens. */
export const REST = 'rest';

/** Where controls stand. */
export interface Places {
  transport: HTMLElement;
  first: HTMLElement;
  tools: HTMLElement;
  presets: HTMLElement;
  settings: HTMLElement;
  actions: HTMLElement;
}

/** The elements of the shadow tree. */
export interface Parts {
  frame: HTMLElement;
  title: HTMLElement;
  stage: HTMLElement;
  /** Shows a zoomed map completely again. */
  whole: HTMLButtonElement;
  /** Stands for the picture while a widget for files has none. */
  drop: HTMLButtonElement;
  picture: HTMLImageElement;
  progress: HTMLProgressElement;
  note: HTMLElement;
  bar: HTMLElement;
  controls: HTMLElement;
  places: Places;
  verdict: HTMLElement;
  rest: HTMLElement;
  summary: HTMLElement;
  live: HTMLElement;
  status: HTMLElement;
}

/** Builds the empty shadow tree. */
export function build(shadow: ShadowRoot): Parts {
  const style = create('style');
  style.textContent = STYLE;
  const frame = create('section', { class: 'frame', part: 'frame', tabindex: '-1' });
  const stage = create('div', { class: 'stage' });
  const picture = create('img', { class: 'picture', alt: '', loading: 'lazy' });
  const progress = create('progress', { max: '1', hidden: '', 'aria-label': 'Loading the widget' });
  const note = create('div', { class: 'note-box', role: 'status' });
  const title = create('p', { class: 'title', part: 'title' });
  const view = create('div', { class: 'view' });
  const whole = create('button', { type: 'button', class: 'whole', hidden: '' });
  whole.textContent = 'Whole map';
  // Keys have “Open a log”.
  const drop = create('button', { type: 'button', class: 'drop', tabindex: '-1' });
  drop.innerHTML = '<span><b>Drop a log of your robot here</b> or choose a file. It stays in this browser.</span>';
  const bar = create('div', { class: 'bar', part: 'bar', role: 'group' });
  const part = (name: string): HTMLElement => create('div', { class: name, part: name });
  const [transport, first, tools, verdict] = [part('transport'), part('first'), part('tools'), part('verdict')];
  const rest = create('div', { class: 'rest', id: REST, hidden: '' });
  const presets = create('div', { class: 'presets', role: 'group', 'aria-label': 'What to try' });
  const [settings, actions] = [part('settings'), part('actions')];
  // Describes the canvas; a still picture has the same text as `alt`.
  const summary = create('p', { class: 'summary', id: SUMMARY, hidden: '' });
  const live = create('p', { class: 'hidden', role: 'status', 'aria-live': 'polite' });
  const status = create('span', { class: 'status', role: 'status' });
  note.classList.add('note');
  stopKeyPropagation(bar);
  stage.append(picture, progress);
  view.append(stage, whole, drop);
  rest.append(presets, settings, actions);
  const controls = part('controls');
  controls.append(transport, first, tools, verdict);
  bar.append(controls, rest);
  frame.append(title, view, note, summary, bar, live);
  shadow.append(style, frame);
  const places = { transport, first, tools, presets, settings, actions };
  return { frame, title, stage, whole, drop, picture, progress, note, bar, controls, places, verdict, rest, summary, live, status };
}

/** The error in one sentence, and a button that restarts or reloads. */
export function failureBox(error: Error, onAgain: () => void): HTMLElement {
  const isCrash = error instanceof CrashError;
  const box = create('div', { class: 'failure' });
  const sentence = create('p');
  const again = create('button', { type: 'button' });
  const isStale = error instanceof StaleError;
  const remedy = isStale ? 'Reload the page' : 'The picture shows the initial state';
  sentence.textContent = isCrash
    ? 'This widget stopped because of an error in its program. Your settings are kept.'
    : `The interactive widget cannot run here: ${error.message}. ${remedy}.`;
  again.textContent = isCrash ? 'Restart with these settings' : isStale ? remedy : 'Try again';
  // Only a reload fetches the scripts of the page again.
  again.addEventListener('click', isStale ? () => location.reload() : onAgain);
  box.append(sentence, ...(isCrash ? [crashDetails(error.details)] : []), again);
  return box;
}

/** Why there is no frame after ten seconds, and a button that starts anew. */
export function lateBox(cause: string, onAgain: () => void): HTMLElement {
  const box = create('div', { class: 'failure late' });
  const sentence = create('p');
  sentence.textContent = `This widget has drawn nothing yet: ${cause}. The picture shows the initial state; the controls work once it draws.`;
  const again = create('button', { type: 'button' });
  again.textContent = 'Start again';
  again.addEventListener('click', onAgain);
  box.append(sentence, again);
  return box;
}

/** Details of a crash for a bug report. */
function crashDetails(text: string): HTMLElement {
  const element = create('details');
  const heading = create('summary');
  heading.textContent = 'Details for a report';
  const body = create('pre');
  body.textContent = text;
  const copy = create('button', { type: 'button' });
  copy.textContent = 'Copy the details';
  copy.addEventListener('click', () => void copyText(text));
  element.append(heading, body, copy);
  return element;
}
