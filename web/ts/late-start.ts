// Notices that a start gets no further. It ends nothing: a slow machine may still draw.

import { STALL_TIMEOUT_MS } from './module';

/** Time without a frame, while the page is visible, after which the reader is told. */
const PATIENCE_MS = 10_000;
/** The same while the program arrives and is compiled: a second after the download's own limit, which names the cause. */
export const ARRIVAL_MS = STALL_TIMEOUT_MS + 1000;

export class LateStart {
  readonly #tell: (sentence: string | undefined) => void;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #awaited: string | undefined;
  #patienceMs = PATIENCE_MS;
  #isTold = false;

  constructor(tell: (sentence: string | undefined) => void) {
    this.#tell = tell;
  }

  /** A step begins; `awaited` is the cause if it does not end. */
  step(awaited: string, patienceMs = PATIENCE_MS): void {
    this.#awaited = awaited;
    this.#patienceMs = patienceMs;
    this.restart();
  }

  /** The step makes progress. */
  restart(): void {
    clearTimeout(this.#timer);
    if (this.#awaited !== undefined) this.#timer = setTimeout(() => this.#expire(), this.#patienceMs);
  }

  /** The first frame is there, or the start has ended. */
  end(): void {
    clearTimeout(this.#timer);
    this.#awaited = undefined;
    if (this.#isTold) this.#tell(undefined);
    this.#isTold = false;
  }

  #expire(): void {
    // A hidden page draws nothing.
    if (document.hidden) this.restart();
    else if (!this.#isTold) {
      this.#isTold = true;
      this.#tell(this.#awaited);
    }
  }
}
