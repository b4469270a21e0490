// The lifecycle of a widget's instance and canvas.
//
// Both exist while the widget is near the screen. After a panic, a lost context or scrolling back they are created
// again in the same way; nothing is repaired. The host keeps the values.

import type { Widget } from '../pkg/glue.js';
import { claim, retryWaiting, release, type Drawer } from './contexts';
import { CrashError, Instance } from './instance';
import { placeControls } from './controls-place';
import { nextTask } from './dom';
import { ARRIVAL_MS, LateStart } from './late-start';
import { LoadError, UnexpectedError } from './module';
import type { Parts } from './parts';
import { Stage } from './stage';
import type { Visibility } from './visibility';

/** Contexts that may be lost before the first frame until we give up. */
const MAX_LOST_CONTEXTS = 3;

/** Duration of a task of the start, ms: input waits for its end. */
const MAX_TASK_MS = 30;

/** The element left its page while it loaded. */
export class RemovedError extends LoadError {
  constructor() {
    super('the widget was removed while it loaded');
  }
}

/** The browser keeps discarding the WebGL context. */
class ContextLostError extends LoadError {
  constructor() {
    super('the browser keeps discarding its WebGL context');
  }
}

export interface LifecycleHost {
  /** The widget to draw; undefined if the page names none. */
  widget(): { id: string; title: string } | undefined;
  isConnected(): boolean;
  /** Sets the host's state in a new instance. */
  prepare(widget: Widget): void;
  /** The first frame is on the canvas; `milliseconds` since the start. */
  live(milliseconds: number): void;
  /** A frame was drawn; its pixels can be read until the end of this task. */
  drew(canvas: HTMLCanvasElement): void;
  /** Progressive work is finished. */
  rested(): void;
  /** The start gets no further, but goes on; undefined once it does, or has ended. */
  late(sentence: string | undefined): void;
  /** Called before the instance is disposed: the last moment to take a picture. */
  leaving(): void;
  /** The widget failed, and waits for `restart`. */
  failed(error: Error): void;
}

export class Lifecycle implements Visibility, Drawer {
  readonly #parts: Parts;
  readonly #host: LifecycleHost;
  #instance: Instance | undefined;
  #creating: Promise<Instance> | undefined;
  /** The canvas, even before its first frame. */
  #stage: Stage | undefined;
  /** Contexts lost since the last first frame. */
  #lostContexts = 0;
  #isNear = false;
  #isFar = false;
  #isInView = false;
  #hasFailed = false;
  #isBusy = false;
  readonly #lateStart: LateStart;
  /** The instance's frame counter after the last drawn frame. */
  #drawnFrames = 0;
  /** Height of the controls that the instance knows. */
  #gap = 0;
  /** Increases with every end: asynchronous work of an earlier start detects that it is outdated. */
  #generation = 0;

  constructor(parts: Parts, host: LifecycleHost) {
    this.#parts = parts;
    this.#host = host;
    this.#lateStart = new LateStart((sentence) => host.late(sentence));
  }

  /** Whether a canvas is on the page. */
  get isRunning(): boolean {
    return this.#stage !== undefined;
  }

  /** Whether there is an instance, with or without a canvas. */
  get hasInstance(): boolean {
    return this.#instance !== undefined;
  }

  get hasFailed(): boolean {
    return this.#hasFailed;
  }

  /** Queries the widget; undefined without an instance, or if the query panicked. */
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

  /** Returns the instance, and creates it if necessary. */
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

  /** Draws only in view, except for the first frames. */
  inView(isInView: boolean): void {
    this.#isInView = isInView;
    this.#openOrClose();
    retryWaiting();
  }

  get distance(): number {
    const { frame } = this.#parts;
    if (frame.matches(':hover, :focus-within')) return 0;
    const { top, bottom } = frame.getBoundingClientRect();
    const middle = window.innerHeight / 2;
    const isInView = bottom > 0 && top < window.innerHeight;
    // A partly visible widget has priority over any outside the viewport.
    return Math.max(top - middle, middle - bottom, 0) + (isInView ? 1 : 2 * window.innerHeight);
  }

  yield(): void {
    this.#end();
  }

  retry(): void {
    if (this.#isNear) void this.#run();
  }

  /** Clears a failure, and starts again if the widget is near the screen. */
  restart(): void {
    this.#hasFailed = false;
    this.#lostContexts = 0;
    if (this.#isNear) void this.#run();
  }

  /** The element left its page. */
  leave(): void {
    this.#isNear = false;
    this.#isInView = false;
    this.suspend();
  }

  /** Starts to draw, unless it draws already, gets no context, or failed. */
  async #run(): Promise<void> {
    const { stage } = this.#parts;
    const widget = this.#host.widget();
    if (this.isRunning || this.#hasFailed || widget === undefined) return;
    if (stage.classList.contains('waiting') || !claim(this)) return;
    const generation = this.#generation;
    try {
      stage.classList.add('waiting');
      this.#lateStart.step('the browser has not compiled its program', ARRIVAL_MS);
      const instance = await this.ensureInstance();
      instance.frames.onCrash = (error) => this.fail(instance.crash() ?? error);
      this.#lateStart.step('its program has not finished its first step');
      await nextTask();
      // The first frame shows data: the still picture stands until then.
      while (this.ask((ready) => ready.settle(MAX_TASK_MS)) === true) await nextTask();
      if (generation !== this.#generation) return;
      this.#lateStart.step('the browser renders no frames');
      this.#stage = new Stage(stage, instance, widget.title, () => this.fail(new ContextLostError()));
      await this.#stage.start();
      await nextTask();
      if (generation === this.#generation) this.#begin(instance, this.#stage);
    } catch (error) {
      if (generation === this.#generation) this.fail(error);
    }
  }

  /** Releases context and memory; waits for no context. */
  suspend(): void {
    this.#end();
    release(this);
  }

  #end(): void {
    this.#generation += 1;
    this.#lateStart.end();
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

  /** Fails if the instance panicked between two frames. */
  checkCrash(): void {
    const crash = this.#instance?.crash();
    if (crash !== undefined) this.fail(crash);
  }

  /** Ends the instance and notifies the host, once. Retries instead if only the context was lost. */
  fail(error: unknown): void {
    if (this.#hasFailed) return;
    if (this.#stage?.isLost === true) {
      this.#lostContexts += 1;
      if (this.#lostContexts <= MAX_LOST_CONTEXTS) {
        this.#end();
        if (this.#isNear) void this.#run();
        return;
      }
      error = new ContextLostError();
    }
    this.#hasFailed = true;
    if (error instanceof CrashError) {
      // After a panic an instance can neither draw its picture nor free its memory.
      this.#instance?.frames.close();
      this.#instance = undefined;
    }
    this.suspend();
    this.#host.failed(error instanceof CrashError || error instanceof LoadError ? error : new UnexpectedError(error));
  }

  async #create(name: string): Promise<Instance> {
    const generation = this.#generation;
    const { progress } = this.#parts;
    progress.hidden = false;
    const instance = await Instance.create(name, (share) => {
      progress.value = share;
      this.#lateStart.restart();
    });
    await nextTask();
    if (generation !== this.#generation) {
      instance.dispose();
      // The element moved within its page or was suspended, and a caller still waits for an instance.
      if (this.#host.isConnected()) return this.ensureInstance();
      throw new RemovedError();
    }
    this.#instance = instance;
    instance.use((widget) => this.#host.prepare(widget));
    return instance;
  }

  #begin(instance: Instance, stage: Stage): void {
    const startedAt = performance.now();
    this.#drawnFrames = 0;
    this.#gap = 0;
    instance.frames.afterFrame = () => this.#afterFrame(instance, stage, startedAt);
    instance.frames.open();
  }

  /** Between the two margins nothing changes. During a resize the observers may contradict each other. */
  #runOrSuspend(): void {
    if (this.#isNear) void this.#run();
    else if (this.#isFar) this.suspend();
  }

  #openOrClose(): void {
    // The first frame is drawn at any scroll position.
    if (!this.#parts.stage.classList.contains('live')) return;
    if (this.#isInView) this.#instance?.frames.open();
    else this.#instance?.frames.close();
  }

  /** Returns whether another frame is needed. */
  #afterFrame(instance: Instance, { canvas }: Stage, startedAt: number): boolean {
    const crash = instance.crash();
    if (crash !== undefined) throw crash;
    const height = Math.ceil(instance.use((widget) => widget.contentHeight()));
    const gap = this.#parts.controls.offsetHeight;
    if (gap !== this.#gap) instance.use((widget) => widget.setGap(gap));
    this.#gap = gap;
    const fits = Math.abs(height - canvas.clientHeight) <= 1;
    if (!fits && height > 0) canvas.style.height = `${height}px`;
    else if (!this.#parts.stage.classList.contains('live')) this.#showLive(startedAt);
    placeControls(this.#parts, instance.use((widget) => widget.stageHeight()));
    const handle = instance.use((widget) => widget.handle()) ?? '';
    if (canvas.title !== handle) canvas.title = handle;
    const frames = instance.use((widget) => widget.frames());
    // eframe paints only changes, and without painting the canvas is empty.
    if (frames !== this.#drawnFrames) this.#host.drew(canvas);
    this.#drawnFrames = frames;
    const wasBusy = this.#isBusy;
    this.#isBusy = instance.use((widget) => widget.wantsFrame());
    if (wasBusy && !this.#isBusy) this.#host.rested();
    // After a change of height the widget has to be painted again at that height.
    return !fits || this.#isBusy;
  }

  #showLive(startedAt: number): void {
    this.#parts.progress.hidden = true;
    this.#lateStart.end();
    this.#parts.stage.classList.replace('waiting', 'live');
    this.#lostContexts = 0;
    this.#openOrClose();
    this.#host.live(performance.now() - startedAt);
  }
}
