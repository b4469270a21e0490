// Notifications about a widget: events for programs, sentences for screen readers, the page's address.

import { keepEntry, type Linked, tellOf } from './address';
import { CrashError, type Outcome, type Timeline } from './instance';
import type { Notes } from './notes';
import { failureBox, type Parts } from './parts';
import type { Value } from './values';

/** Delay between the last change and the result, so that not every frame of a drag is reported. */
const SETTLED_MS = 350;
/** During permanent changes, such as the mapping of a log, a screen reader gets progress at this interval. */
const UNDER_WAY_MS = 10_000;

/** The reported widget. */
export interface NotifierSource extends Linked {
  readonly value: Record<string, Value>;
  readonly outcome: Outcome | undefined;
  readonly timeline: Timeline | null;
  get(id: string): Value | undefined;
}

export class Notifier {
  readonly #source: NotifierSource;
  readonly #parts: Parts;
  readonly #notes: Notes;
  readonly #onSettled: () => void;
  /** The text for the picture as it is, whatever it still waits for. */
  readonly #shownSummary: () => string;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Whether a screen reader is told what the timer waits for. */
  #isNews = false;
  /** Whether values are being set that the page gave as attributes. */
  #isGiven = false;
  /** Values settled before the widget had run: their result is reported as soon as there is one. */
  #isOwed = false;
  /** Start of the changes that have not settled since, or the time of the last report about them. */
  #saidAt = 0;

  constructor(source: NotifierSource, parts: Parts, notes: Notes, onSettled: () => void, shownSummary: () => string) {
    this.#onSettled = onSettled;
    this.#shownSummary = shownSummary;
    this.#source = source;
    this.#parts = parts;
    this.#notes = notes;
  }

  /** The widget was set up: values of attributes and address are not reported. */
  setUp(): void {
    this.#isNews = false;
    this.#isOwed = false;
  }

  /** Sets values that the page gave as attributes: the address stays with the widget that the reader has set. */
  given(set: () => void): void {
    this.#isGiven = true;
    set();
    this.#isGiven = false;
  }

  /** The first frame is on the canvas, that many milliseconds after its start. */
  ready(milliseconds: number): void {
    this.#describe();
    this.#emit('slam-ready', { value: this.#source.value, ms: milliseconds });
    if (this.#isOwed) this.#tellResult();
  }

  /** Progressive work is finished: the summary is that of the complete picture. */
  rested(): void {
    this.#describe();
  }

  /** Values changed; the outcome is that of the picture so far. The result follows once they settle. */
  changed(changes: readonly [string, string][], outcome: Outcome | undefined): void {
    if (this.#timer === undefined) this.#saidAt = performance.now();
    for (const [parameter, text] of changes) {
      this.#notes.settle(parameter);
      const value = this.#source.get(parameter);
      this.#emit('slam-change', { parameter, value, text, outcome });
    }
    // A playback leaves the address to the widget that the reader has set.
    if (changes.length > 0 && !this.#isGiven) tellOf(this.#source);
    clearTimeout(this.#timer);
    this.#isNews = true;
    this.#isOwed = false;
    const isLong = performance.now() - this.#saidAt > UNDER_WAY_MS;
    if (isLong && outcome !== undefined) this.#say(outcome.sentence);
    this.#timer = setTimeout(() => this.#settled(), SETTLED_MS);
  }

  /** A playback settles only at its end; events that it passes are reported on the way. */
  passed({ marks }: Timeline, before: number, now: number): void {
    const passed = marks.filter(({ at }) => before < at && at <= now);
    if (passed.length > 0) this.#say(passed.map(({ label }) => label).join('; '));
  }

  /** A value from outside was invalid. */
  wrong(kind: 'name' | 'value', message: string, subject?: string): void {
    this.#notes.say(message, subject);
    this.#emit('slam-error', { kind, message });
  }

  /** Nothing runs until the reader asks for it. */
  failed(error: Error, restart: () => void): void {
    const { note, frame } = this.#parts;
    const box = failureBox(error, () => {
      // The button disappears: the focus stays in the widget.
      frame.focus({ preventScroll: true });
      box.remove();
      restart();
    });
    note.append(box);
    const kind = error instanceof CrashError ? 'crash' : 'load';
    this.#emit('slam-error', { kind, message: error.message });
  }

  /** The element left its page: pending results are dropped. */
  stop(): void {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#isOwed = false;
  }

  #settled(): void {
    const source = this.#source;
    this.#timer = undefined;
    this.#onSettled();
    this.#tellResult();
    this.#describe();
    if (source.hasAttribute('linked')) keepEntry(source);
  }

  #tellResult(): void {
    const { value, outcome } = this.#source;
    this.#isOwed = outcome === undefined;
    if (outcome === undefined) return;
    if (this.#isNews) this.#say(outcome.sentence);
    this.#emit('slam-result', { value, outcome });
  }

  #describe(): void {
    this.#parts.summary.textContent = this.#shownSummary();
  }

  #say(sentence: string): void {
    this.#saidAt = performance.now();
    this.#parts.live.textContent = sentence;
  }

  #emit(type: string, detail: Record<string, unknown>): void {
    const { name } = this.#source;
    const event = new CustomEvent(type, { detail: { name, ...detail }, bubbles: true, composed: true });
    this.#source.dispatchEvent(event);
  }
}
