// Notifications about a widget: events for programs, sentences for screen readers, the page's address.

import { updateEntry, type Linked, setAddressed } from './address';
import { CrashError, type Outcome, type Timeline } from './instance';
import type { Notes } from './notes';
import { failureBox, lateBox, type Parts } from './parts';
import type { Value } from './values';

/** Debounces the result: a drag changes a value with every frame. */
const DEBOUNCE_MS = 350;
/** While values keep changing, as during the mapping of a log, a screen reader gets progress at this interval. */
const PROGRESS_MS = 10_000;

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
  /** The text for the picture as drawn, which may lag behind the values. */
  readonly #shownSummary: () => string;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Whether a screen reader gets the next result. */
  #isAnnounced = false;
  /** The last known result: news without a change of a value, such as those of a worker, are announced if it differs. */
  #known: string | undefined;
  /** Whether the values being set come from attributes. */
  #isFromAttributes = false;
  /** Whether values settled before the widget had run: the result follows its first run. */
  #isResultPending = false;
  #lateBox: HTMLElement | undefined;
  /** Time of the last announcement, or of the first change since the last result. */
  #announcedAt = 0;

  constructor(source: NotifierSource, parts: Parts, notes: Notes, onSettled: () => void, shownSummary: () => string) {
    this.#onSettled = onSettled;
    this.#shownSummary = shownSummary;
    this.#source = source;
    this.#parts = parts;
    this.#notes = notes;
  }

  /** Ends the set-up of the widget: a screen reader does not get the values of attributes and address. */
  setUp(): void {
    this.#isAnnounced = false;
    this.#isResultPending = false;
    this.#known = undefined;
  }

  /** Sets values of attributes: the address still names the widget that the reader changed last. */
  fromAttributes(set: () => void): void {
    this.#isFromAttributes = true;
    set();
    this.#isFromAttributes = false;
  }

  /** The first frame is on the canvas; `milliseconds` since the start. */
  ready(milliseconds: number): void {
    this.#describe();
    this.#emit('slam-ready', { value: this.#source.value, ms: milliseconds });
    if (this.#isResultPending) this.#reportResult();
  }

  /** Progressive work is finished: updates the summary. */
  rested(): void {
    this.#describe();
  }

  /** Reports changes with the outcome of the picture so far. The result follows after the debounce. */
  changed(changes: readonly [string, string][], outcome: Outcome | undefined): void {
    if (this.#timer === undefined) this.#announcedAt = performance.now();
    for (const [parameter, text] of changes) {
      this.#notes.remove(parameter);
      const value = this.#source.get(parameter);
      this.#emit('slam-change', { parameter, value, text, outcome });
    }
    // A playback changes no address: it stays with the widget that the reader changed last.
    if (changes.length > 0 && !this.#isFromAttributes) setAddressed(this.#source);
    clearTimeout(this.#timer);
    const sentence = outcome?.sentence ?? this.#known;
    this.#isAnnounced ||= changes.length > 0 || (this.#known !== undefined && sentence !== this.#known);
    this.#known = sentence;
    this.#isResultPending = false;
    const isLong = performance.now() - this.#announcedAt > PROGRESS_MS;
    if (isLong && this.#isAnnounced && outcome !== undefined) this.#announce(outcome.sentence);
    this.#timer = setTimeout(() => this.#settled(), DEBOUNCE_MS);
  }

  /** Announces events that a playback passes, because its result comes only at the end. */
  passed({ marks }: Timeline, before: number, now: number): void {
    const passed = marks.filter(({ at }) => before < at && at <= now);
    if (passed.length > 0) this.#announce(passed.map(({ label }) => label).join('; '));
  }

  /** Reports an invalid value from outside. */
  invalid(kind: 'name' | 'value', message: string, subject?: string): void {
    this.#notes.show(message, subject);
    this.#emit('slam-error', { kind, message });
  }

  /** Reports a failure, with a button that restarts the widget. */
  failed(error: Error, restart: () => void): void {
    const { note, frame } = this.#parts;
    const again = (): void => {
      window.removeEventListener('pageshow', back);
      box.remove();
      restart();
    };
    // Who leaves ends what the page fetches; the browser may keep the page like that, and return to it.
    const back = ({ persisted }: PageTransitionEvent): void => {
      if (persisted && box.isConnected && !(error instanceof CrashError)) again();
    };
    window.addEventListener('pageshow', back);
    const box = failureBox(error, () => {
      // The button disappears; without this the focus would move to the document.
      frame.focus({ preventScroll: true });
      again();
    });
    note.append(box);
    const kind = error instanceof CrashError ? 'crash' : 'load';
    this.#emit('slam-error', { kind, message: error.message });
  }

  /** Says over the still picture why nothing is drawn, while the start goes on; removes it without a cause. */
  late(cause: string | undefined, restart: () => void): void {
    const { note, frame } = this.#parts;
    this.#lateBox?.remove();
    this.#lateBox = undefined;
    if (cause === undefined) return;
    const box = lateBox(cause, () => {
      frame.focus({ preventScroll: true });
      restart();
    });
    this.#lateBox = box;
    note.append(box);
  }

  /** Drops pending results, because the element left its page. */
  stop(): void {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#isResultPending = false;
  }

  #settled(): void {
    const source = this.#source;
    this.#timer = undefined;
    this.#onSettled();
    this.#reportResult();
    this.#describe();
    if (source.hasAttribute('linked')) updateEntry(source);
  }

  #reportResult(): void {
    const { value, outcome } = this.#source;
    this.#isResultPending = outcome === undefined;
    if (outcome === undefined) return;
    if (this.#isAnnounced) this.#announce(outcome.sentence);
    this.#emit('slam-result', { value, outcome });
  }

  #describe(): void {
    this.#parts.summary.textContent = this.#shownSummary();
  }

  #announce(sentence: string): void {
    this.#announcedAt = performance.now();
    this.#parts.live.textContent = sentence;
  }

  #emit(type: string, detail: Record<string, unknown>): void {
    const { name } = this.#source;
    const event = new CustomEvent(type, { detail: { name, ...detail }, bubbles: true, composed: true });
    this.#source.dispatchEvent(event);
  }
}
