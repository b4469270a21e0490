// The life cycle of a widget's drawing: an instance of the module and its canvas.
//
// Both exist while the widget is near the screen. They are never repaired, but created again in one way:
// after scrolling back, after a panic, after a lost context. The host keeps the values.

import type { Widget } from '../pkg/glue.js';
import { claim, lookAgain, release, type Drawer } from './contexts';
import { CrashError, Instance } from './instance';
import { nextTask } from './dom';
import { LoadError } from './module';
import type { Parts } from './parts';
import { Stage } from './stage';
import type { Visibility } from './visibility';

/** Number of times that a browser may take a context away before the first frame. */
const MOST_LOSSES = 3;

/** The element left its page, and its widget is not needed any more. */
export class TakenAwayError extends LoadError {
  constructor() {
    super('the widget was taken away while it loaded');
  }
}

/** The browser took the context away: a fault of neither the page nor the widget. */
class LostError extends LoadError {
  constructor() {
    super('the browser takes its drawing surface away again and again');
  }
}

export interface LifecycleHost {
  /** The widget to draw; undefined if the page names none. */
  widget(): { id: string; title: string } | undefined;
  /** Whether the element is on a page. */
  isHere(): boolean;
  /** Sets the host's state in a new instance. */
  prepare(widget: Widget): void;
  /** The first frame is on the canvas, that many milliseconds after its start. */
  live(milliseconds: number): void;
  /** A frame was drawn; the canvas holds it until the end of this task. */
  drew(canvas: HTMLCanvasElement): void;
  /** Progressive work is finished. */
  rested(): void;
  /** The instance is about to end: the last moment to take a picture. */
  leaving(): void;
  /** Nothing runs until the host calls `restart`. */
  failed(error: Error): void;
}

export class Lifecycle implements Visibility, Drawer {
  readonly #parts: Parts;
  readonly #host: LifecycleHost;
  #instance: Instance | undefined;
  #creating: Promise<Instance> | undefined;
  /** The canvas, from before its first frame on. */
  #stage: Stage | undefined;
  /** Number of contexts lost since the last completed frame. */
  #losses = 0;
  #isNear = false;
  #isFar = false;
  #isInView = false;
  #hasFailed = false;
  #isBusy = false;
  /** Frames laid out by the instance when the last one was drawn. */
  #drawnFrames = 0;
  /** Increases with every end, so that asynchronous work of an earlier start can detect that it is outdated. */
  #generation = 0;

  constructor(parts: Parts, host: LifecycleHost) {
    this.#parts = parts;
    this.#host = host;
  }

  /** Whether a canvas is on the page. */
  get isRunning(): boolean {
    return this.#stage !== undefined;
  }

  /** Whether there is an instance, with a canvas or not. */
  get hasInstance(): boolean {
    return this.#instance !== undefined;
  }

  /** Whether nothing runs until a restart. */
  get hasFailed(): boolean {
    return this.#hasFailed;
  }

  /** Queries the widget; undefined if there is none, or if the query made it panic. */
  ask<T>(question: (widget: Widget, instance: Instance) => T): T | undefined {
    const instance = this.#instance;
    if (instance === undefined) return undefined;
    try {
      return instance.use((widget) => question(widget, instance));
    } catch (error) {
      if (!(error instanceof CrashError)) throw error;
      this.fail(error);
      return undefined;
    }
  }

  /** An instance, created now if there is none. */
  ensureInstance(): Promise<Instance> {
    const widget = this.#host.widget();
    if (widget === undefined) return Promise.reject(new LoadError('there is no such widget'));
    this.#creating ??= this.#create(widget.id);
    return this.#creating;
  }

  near(isNear: boolean): void {
    this.#isNear = isNear;
    this.#runOrSuspend();
  }

  far(isFar: boolean): void {
    this.#isFar = isFar;
    this.#runOrSuspend();
  }

  /** Draws only while it is visible; the first frames are drawn even before. */
  inView(isInView: boolean): void {
    this.#isInView = isInView;
    this.#openOrClose();
    lookAgain();
  }

  get distance(): number {
    const { frame } = this.#parts;
    if (frame.matches(':hover, :focus-within')) return 0;
    const { top, bottom } = frame.getBoundingClientRect();
    const middle = window.innerHeight / 2;
    const isInView = bottom > 0 && top < window.innerHeight;
    // Half a visible widget has priority over a whole one beyond the edge.
    return Math.max(top - middle, middle - bottom, 0) + (isInView ? 1 : 2 * window.innerHeight);
  }

  yield(): void {
    this.#end();
  }

  askAgain(): void {
    if (this.#isNear) void this.#run();
  }

  /** Starts again if the widget is near the screen; a failure is forgotten. */
  restart(): void {
    this.#hasFailed = false;
    this.#losses = 0;
    if (this.#isNear) void this.#run();
  }

  /** The element left its page. */
  leave(): void {
    this.#isNear = false;
    this.#isInView = false;
    this.suspend();
  }

  /** Draws; does nothing if it draws already, has to wait for others, or failed. */
  async #run(): Promise<void> {
    const { stage } = this.#parts;
    const widget = this.#host.widget();
    if (this.isRunning || this.#hasFailed || widget === undefined) return;
    if (stage.classList.contains('waiting') || !claim(this)) return;
    const generation = this.#generation;
    try {
      stage.classList.add('waiting');
      const instance = await this.ensureInstance();
      await nextTask();
      if (generation !== this.#generation) return;
      this.#stage = new Stage(stage, instance, widget.title, () => this.fail(new LostError()));
      await this.#stage.start();
      await nextTask();
      if (generation === this.#generation) this.#begin(instance, this.#stage);
    } catch (error) {
      if (generation === this.#generation) this.fail(error);
    }
  }

  /** Releases context and memory. */
  suspend(): void {
    this.#end();
    release(this);
  }

  #end(): void {
    this.#generation += 1;
    if (this.#parts.stage.classList.contains('live')) this.#host.leaving();
    this.#stage?.dispose();
    this.#stage = undefined;
    this.#instance?.dispose();
    this.#instance = undefined;
    this.#creating = undefined;
    this.#parts.stage.classList.remove('live', 'waiting');
    this.#parts.progress.hidden = true;
  }

  /** Requests a frame. */
  wake(): void {
    this.ask((widget) => widget.requestFrame());
    this.#instance?.frames.wake();
  }

  /** Ends an instance that panicked between two frames. */
  checkCrash(): void {
    const crash = this.#instance?.crash();
    if (crash !== undefined) this.fail(crash);
  }

  /** Ends everything and notifies the host, once; starts again if only the context was lost. */
  fail(error: unknown): void {
    if (this.#hasFailed) return;
    if (this.#stage?.isLost === true) {
      this.#losses += 1;
      if (this.#losses <= MOST_LOSSES) {
        this.#end();
        if (this.#isNear) void this.#run();
        return;
      }
      error = new LostError();
    }
    this.#hasFailed = true;
    if (error instanceof CrashError) {
      // A crashed instance cannot draw its picture any more, nor free its memory.
      this.#instance?.frames.close();
      this.#instance = undefined;
    }
    this.suspend();
    this.#host.failed(error instanceof Error ? error : new LoadError(String(error)));
  }

  async #create(name: string): Promise<Instance> {
    const generation = this.#generation;
    const { progress } = this.#parts;
    progress.hidden = false;
    const instance = await Instance.create(name, (share) => (progress.value = share));
    await nextTask();
    if (generation !== this.#generation) {
      instance.dispose();
      // It moved within its page, or rests, and an instance is still requested.
      if (this.#host.isHere()) return this.ensureInstance();
      throw new TakenAwayError();
    }
    this.#instance = instance;
    instance.use((widget) => this.#host.prepare(widget));
    return instance;
  }

  #begin(instance: Instance, stage: Stage): void {
    const startedAt = performance.now();
    this.#drawnFrames = 0;
    instance.frames.afterFrame = () => this.#afterFrame(instance, stage, startedAt);
    instance.frames.onCrash = (error) => this.fail(instance.crash() ?? error);
    instance.frames.open();
  }

  /** The observers report one after the other, and not always consistently while a window changes. */
  #runOrSuspend(): void {
    if (this.#isNear) void this.#run();
    else if (this.#isFar) this.suspend();
  }

  #openOrClose(): void {
    // Before its first frame it draws at any position.
    if (!this.#parts.stage.classList.contains('live')) return;
    if (this.#isInView) this.#instance?.frames.open();
    else this.#instance?.frames.close();
  }

  /** Returns whether another frame is needed. */
  #afterFrame(instance: Instance, { canvas }: Stage, startedAt: number): boolean {
    const crash = instance.crash();
    if (crash !== undefined) throw crash;
    const height = Math.ceil(instance.use((widget) => widget.contentHeight()));
    const fits = Math.abs(height - canvas.clientHeight) <= 1;
    if (!fits && height > 0) canvas.style.height = `${height}px`;
    else if (!this.#parts.stage.classList.contains('live')) this.#showLive(startedAt);
    const frames = instance.use((widget) => widget.frames());
    // eframe draws only changes; a canvas without drawing is empty.
    if (frames !== this.#drawnFrames) this.#host.drew(canvas);
    this.#drawnFrames = frames;
    const wasBusy = this.#isBusy;
    this.#isBusy = instance.use((widget) => widget.wantsFrame());
    if (wasBusy && !this.#isBusy) this.#host.rested();
    // A new height needs a frame at that height, however slow the machine is.
    return !fits || this.#isBusy;
  }

  #showLive(startedAt: number): void {
    this.#parts.progress.hidden = true;
    this.#parts.stage.classList.replace('waiting', 'live');
    this.#losses = 0;
    this.#openOrClose();
    this.#host.live(performance.now() - startedAt);
  }
}
