// The element's shadow tree: picture and canvas above, notes, controls and tools below.

import { create, stopKeyPropagation } from './dom';
import { copyText } from './export';
import { CrashError } from './instance';
import { StaleError } from './module';
import { STYLE } from './style';

/** Id of the text alternative. */
export const SUMMARY = 'summary';

/** The elements of the shadow tree. */
export interface Parts {
  frame: HTMLElement;
  stage: HTMLElement;
  picture: HTMLImageElement;
  progress: HTMLProgressElement;
  note: HTMLElement;
  bar: HTMLElement;
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
  const bar = create('div', { class: 'bar' });
  // Describes the canvas; a still picture has the same text as `alt`.
  const summary = create('p', { class: 'summary', id: SUMMARY, hidden: '' });
  const live = create('p', { class: 'hidden', role: 'status', 'aria-live': 'polite' });
  const status = create('span', { class: 'status', role: 'status' });
  note.classList.add('note');
  stopKeyPropagation(bar);
  stage.append(picture, progress);
  frame.append(stage, note, summary, bar, live);
  shadow.append(style, frame);
  return { frame, stage, picture, progress, note, bar, summary, live, status };
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
