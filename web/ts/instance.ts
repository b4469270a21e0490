// One instance of the module, with its own memory and widget. A panic stays inside, and the instance is replaced.

import type { Widget } from '../pkg/glue.js';
import { core } from './core';
import { nextTask } from './dom';
import { FrameGate } from './frames';
import { forgetModule, startProblem } from './module';

export interface Outcome {
  standing: 'good' | 'bad' | 'doubtful' | 'neutral';
  verdict: string;
  sentence: string;
  facts: Record<string, number | null>;
}

export interface TimelineMark {
  at: number;
  label: string;
  standing: Outcome['standing'];
}

export interface Timeline {
  param: string;
  last: number;
  playing: boolean;
  marks: TimelineMark[];
}

/** The buttons that have nothing to do, and those shown as pressed. */
export interface ButtonStates {
  disabled: string[];
  pressed: string[];
}

export interface CsvFile {
  id: string;
  title: string;
  csv: string;
}

/** The widget's code panicked, and its instance is unusable. */
export class CrashError extends Error {
  constructor(readonly details: string) {
    super('the widget stopped because of an error in its program');
  }
}

export class Instance {
  readonly frames: FrameGate;
  readonly #widget: Widget;

  private constructor(widget: Widget, frames: FrameGate) {
    this.#widget = widget;
    this.frames = frames;
  }

  static async create(name: string, progress: (share: number) => void): Promise<Instance> {
    const frames = new FrameGate();
    const glue = await core(frames, progress);
    // A start is split into several tasks: a long one would block the page.
    await nextTask();
    try {
      return new Instance(new glue.Widget(name), frames);
    } catch (error) {
      forgetModule();
      throw startProblem(error);
    }
  }

  /** Calls the widget; a panic becomes a CrashError. */
  use<T>(call: (widget: Widget) => T): T {
    try {
      return call(this.#widget);
    } catch (error) {
      throw this.crash() ?? error;
    }
  }

  /** The panic, if there was one. */
  crash(): CrashError | undefined {
    try {
      if (!this.#widget.hasPanicked()) return undefined;
      return new CrashError(this.#widget.panicMessage() ?? '');
    } catch (error) {
      return new CrashError(String(error));
    }
  }

  async start(canvas: HTMLCanvasElement): Promise<void> {
    try {
      await this.#widget.start(canvas);
    } catch (error) {
      throw this.crash() ?? error;
    }
  }

  /** Releases everything: listeners, frames, memory. */
  dispose(): void {
    this.frames.close();
    try {
      this.#widget.destroy();
      this.#widget.free();
    } catch {
      // After a panic the garbage collector frees the whole memory.
    }
  }

  outcome(): Outcome {
    return JSON.parse(this.use((widget) => widget.outcome())) as Outcome;
  }

  timeline(): Timeline | null {
    return JSON.parse(this.use((widget) => widget.timeline())) as Timeline | null;
  }

  buttons(): ButtonStates {
    return JSON.parse(this.use((widget) => widget.buttonStates())) as ButtonStates;
  }

  tables(): CsvFile[] {
    return JSON.parse(this.use((widget) => widget.tables())) as CsvFile[];
  }

  /** Every value as in a link. */
  values(): Record<string, string> {
    return JSON.parse(this.use((widget) => widget.values())) as Record<string, string>;
  }
}
