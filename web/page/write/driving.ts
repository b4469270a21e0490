// A reader's function in place of a part of the estimator: a worker holds the core and calls the function, and the widget
// replays its answers.

import type { Driver } from '../../ts/driver';
import type { SlamWidget } from '../../ts/main';
import { NotRun, Sandbox } from './sandbox';

/** Set by the build: the script of the core for the worker. */
declare const WRITE_WORKER_FILE: string;

/** The widgets that a function drives, and what it does there. */
const DRIVES: Record<string, readonly [string, string][]> = {
  svd_align: [['w16.1', 'the registration of w16.1'], ['w16.2', 'the lap of w16.2']],
  point_to_plane_step: [['w16.1', 'the registration of w16.1'], ['w16.2', 'the lap of w16.2']],
  keep_pairs: [['w16.1', 'the registration of w16.1'], ['w16.2', 'the lap of w16.2']],
  gate: [['w16.2', 'the loops of w16.2']],
};

/** The script of the core for the worker. */
async function workerScript(): Promise<string> {
  const response = await fetch(new URL(WRITE_WORKER_FILE, import.meta.url));
  if (!response.ok) throw new Error(`status ${response.status}`);
  return response.text();
}

/** The core without egui. */
async function coreProgram(): Promise<ArrayBuffer> {
  // @ts-expect-error: a separate bundle, which contains the module.
  const { coreBytes } = (await import('./slam-widget.js')) as { coreBytes(): Promise<ArrayBuffer> };
  return coreBytes();
}

/** A widget of this page that a function can drive. */
export interface Seat {
  widget: SlamWidget;
  what: string;
}

/** Where the function can drive on this page. */
export function seatsOf(name: string): Seat[] {
  return (DRIVES[name] ?? []).flatMap(([id, what]) => {
    const widget = document.querySelector<SlamWidget>(`slam-widget[name="${id}"]`);
    return widget === null ? [] : [{ widget, what }];
  });
}

/** A function that drives a widget, until it is ended. */
export class Driving implements Driver {
  readonly name: string;
  readonly #seat: Seat;
  readonly #sandbox: Sandbox;
  readonly #failed: (why: NotRun) => void;
  /** The order under way: a worker executes one at a time. */
  #busy: Promise<unknown> = Promise.resolve();
  #isOver = false;

  private constructor(name: string, seat: Seat, sandbox: Sandbox, failed: (why: NotRun) => void) {
    this.name = name;
    this.#seat = seat;
    this.#sandbox = sandbox;
    this.#failed = failed;
  }

  /**
   * Lets the code drive; `failed` gets the reason if it has to be ended.
   * @throws {NotRun} with a sentence, if it cannot start.
   */
  static async start(code: string, name: string, seat: Seat, failed: (why: NotRun) => void): Promise<Driving> {
    const [script, program] = await Promise.all([workerScript(), coreProgram()]).catch((why: unknown) => {
      throw new NotRun(`The program that calls your code could not be fetched (${why instanceof Error ? why.message : String(why)}). Check the connection and press the button again.`);
    });
    const sandbox = await Sandbox.start(code, name, script);
    await sandbox.ask({ program });
    const driving = new Driving(name, seat, sandbox, failed);
    await seat.widget.drive(driving);
    return driving;
  }

  run(order: string): Promise<Float64Array | undefined> {
    const answered = this.#busy.then(() => this.#execute(order));
    this.#busy = answered;
    return answered;
  }

  /** Gives the widget back to ours. */
  end(): void {
    this.#isOver = true;
    this.#sandbox.end();
    if (this.#seat.widget.driver === this) void this.#seat.widget.drive(undefined);
  }

  async #execute(order: string): Promise<Float64Array | undefined> {
    if (this.#isOver) return undefined;
    try {
      const [answer] = await this.#sandbox.ask({ order });
      if (answer !== undefined && 'result' in answer) return answer.result as Float64Array;
      throw new NotRun(`Your function ended with ${answer?.error ?? 'no answer'}.`, answer?.line);
    } catch (why) {
      if (!(why instanceof NotRun)) throw why;
      // Whoever ended it knows.
      if (!this.#isOver) {
        this.end();
        this.#failed(why);
      }
      return undefined;
    }
  }
}
