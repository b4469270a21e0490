// <slam-widget name="w16.1" heading="60">: a widget on any page.
//
// The element keeps the values and communicates with the page; what draws them comes and goes with the
// position of the widget on the screen (life.ts).

import { linkTo, readAddress } from './address';
import { boxOf, type Box } from './box';
import { Controls, MORE } from './controls';
import { listen, upgradeProperties } from './dom';
import { takeAwayBar } from './export';
import type { Widget } from '../pkg/glue.js';
import { CrashError, type CsvFile, type Outcome, type Timeline } from './instance';
import { Life, TakenAwayError, type LifeHost } from './life';
import { LoadError } from './module';
import { lookBar, type Way } from './look';
import { Looks } from './looks';
import { News } from './news';
import { Notes } from './notes';
import { build, type Parts } from './parts';
import { Pictures } from './pictures';
import { Place } from './place';
import { findParam, findWidget, widgets } from './schema';
import { State } from './state';
import { defaultText, shorten, type Value } from './values';
import { unwatchVisibility, watchVisibility } from './visibility';
import { Desk, hand, type FileUse } from './robot/desk';
import { DoctorScreen, type Diagnosis } from './robot/doctor';
import { chooseFiles, takeDrops } from './robot/files';
import { LoopsToLookInto } from './robot/loops';
import { carryTextOrder, takeTextFile, type TextFileHost } from './text-files';
import type { Delivery } from './robot/protocol';

export class SlamWidget extends HTMLElement {
  static readonly observedAttributes: string[] = ['name', 'theme'];

  readonly #parts: Parts;
  readonly #notes: Notes;
  readonly #news: News;
  readonly #pictures: Pictures;
  readonly #place: Place;
  readonly #life: Life;
  readonly #looks: Looks;
  #state: State | undefined;
  #isSetUp = false;
  #controls: Controls | undefined;
  #look: HTMLElement | undefined;
  #lastOutcome: Outcome | undefined;
  #unwatch: (() => void)[] = [];
  readonly #textFiles: TextFileHost;
  /** Processes a reader's own file, once there is one. */
  #desk: Desk | undefined;
  #doctor: DoctorScreen | undefined;
  #loops: LoopsToLookInto | undefined;

  constructor() {
    super();
    this.#parts = build(this.attachShadow({ mode: 'open' }));
    this.#notes = new Notes(this.#parts.note);
    this.#textFiles = {
      frame: this.#parts.frame,
      act: (deed) => void this.#act(deed),
      refuse: (problem) => this.#news.wrong('value', problem),
    };
    const shownSummary = (): string => this.#shownSummary();
    this.#news = new News(this, this.#parts, this.#notes, () => this.#showTimeline(), shownSummary);
    this.#pictures = new Pictures(this.#parts.picture);
    this.#place = new Place(this.#parts.stage);
    this.#life = new Life(this.#parts, this.#lifeHost());
    this.#looks = new Looks(this, this.#parts, this.#life, this.#pictures);
  }

  connectedCallback(): void {
    // An element that moves within its page, or was set up before, keeps its state.
    if (!this.#isSetUp) this.#setUp();
    upgradeProperties(this);
    this.#unwatch = [
      ...this.#looks.watch(),
      listen(window, 'error', () => this.#life.checkCrash()),
      listen(window, 'resize', () => this.#resized()),
      listen(document, 'visibilitychange', () => this.#life.wake()),
      // The element in the reader's focus comes first if not all can draw.
      listen(this, 'pointerenter', () => this.#life.askAgain()),
      listen(this, 'focusin', () => this.#life.askAgain()),
    ];
    if (this.#takesFiles) {
      // A resting widget has to run to provide the start pose of a log.
      const take = (files: File[]): void => void this.#act(() => this.#takeFiles(files));
      this.#unwatch.push(takeDrops(this.#parts.frame, take));
    }
    this.#place.fit();
    watchVisibility(this, this.#life);
  }

  disconnectedCallback(): void {
    unwatchVisibility(this);
    for (const end of this.#unwatch) end();
    this.#unwatch = [];
    this.#news.stop();
    this.#life.leave();
    // An element that moves within its page is back at once.
    setTimeout(() => {
      if (!this.isConnected) this.#closeDesk();
    });
  }

  attributeChangedCallback(name: string, old: string | null, value: string | null): void {
    // Before the set-up there is nothing to change, because it reads all attributes.
    if (!this.#isSetUp) return;
    if (name === 'name') {
      if (old === value) return;
      this.#life.suspend();
      this.#setUp();
      this.#life.restart();
    } else if (name === 'theme') {
      this.#looks.showTheme();
    } else {
      const spec = this.#state && findParam(this.#state.spec, name);
      if (spec !== undefined) this.#tryToSet(name, value ?? defaultText(spec));
    }
  }

  // ---- for programs -------------------------------------------------------------------------

  /** The widget: `w16.1`. */
  get name(): string {
    return this.getAttribute('name') ?? '';
  }

  set name(name: string) {
    this.setAttribute('name', name);
  }

  /** The whole state as JSON; the setter takes an object or its text, complete or in part. */
  get value(): Record<string, Value> {
    return this.#state?.toJSON() ?? {};
  }

  set value(given: Record<string, Value> | string) {
    const state: unknown = typeof given === 'string' ? JSON.parse(given) : given;
    if (typeof state !== 'object' || state === null || Array.isArray(state)) {
      throw new TypeError('value takes an object of parameters');
    }
    for (const [id, value] of Object.entries(state)) this.set(id, value as Value);
  }

  /** One parameter; undefined if this widget has none of that name. */
  get(id: string): Value | undefined {
    return this.#state?.value(String(id));
  }

  /** Sets one parameter; throws a RangeError with the valid values. */
  set(id: string, value: Value): void {
    const problem = this.#set(String(id), value);
    if (problem !== undefined) throw new RangeError(problem);
  }

  /** Presses a button or a preset by its name; rejects with a RangeError with the valid names. */
  async press(id: string): Promise<void> {
    if (!this.#isSetUp) this.#setUp();
    const button = String(id);
    const problem = this.#state?.buttonProblem(button);
    if (problem !== undefined) throw new RangeError(problem);
    await this.#life.ensureInstance();
    // A button acts on the values that are set, not on what the picture still waits for.
    this.#finishWork();
    this.#life.ask((widget) => widget.press(button));
    this.#sync();
    this.#showTimeline();
    this.#life.wake();
  }

  /** The result of the values that are set, once the widget has run with them. */
  get outcome(): Outcome | undefined {
    this.#finishWork();
    return this.#shownOutcome();
  }

  /** The run that can be scrubbed, while the widget runs. */
  get timeline(): Timeline | null {
    this.#finishWork();
    return this.#shownTimeline();
  }

  /** The text that stands for the picture. */
  get summary(): string {
    this.#finishWork();
    return this.#shownSummary();
  }

  /** The state as the query of a link. */
  get query(): string {
    return this.#state?.query ?? '';
  }

  /** The page, if it takes the state from its address; else a separate page with the widget. */
  get link(): string {
    return linkTo(this, this.#state?.spec, this.query);
  }

  /** Every plot and table as CSV. */
  async tables(): Promise<CsvFile[]> {
    await this.#ensureInstance();
    this.#finishWork();
    return this.#life.ask((_, instance) => instance.tables()) ?? [];
  }

  /** The pixels of the canvas; waits until the widget runs and draws. */
  snapshot(): Promise<ImageBitmap> {
    if (this.#life.hasFailed) return Promise.reject(new LoadError('the widget does not run'));
    const picture = this.#pictures.nextFrame();
    this.#life.wake();
    return picture;
  }

  /** `running` while it has a canvas. */
  get state(): 'running' | 'resting' {
    return this.#life.isRunning ? 'running' : 'resting';
  }

  /** Frames drawn since this instance started. */
  get frames(): number {
    return this.#life.ask((widget) => widget.frames()) ?? 0;
  }

  /** Whether something draggable is at that position, in CSS pixels from the canvas's corner. */
  dragsAt(x: number, y: number): boolean {
    return this.#life.ask((widget) => widget.dragsAt(x, y)) ?? false;
  }

  /** The rectangle of a control on the canvas: left, top, width, height; null while it rests. */
  controlBox(id: string): Box | null {
    return boxOf(this.#life.ask((widget) => widget.controlBox(String(id))));
  }

  /** The rectangle of the picture on the canvas: left, top, width, height; null while it rests. */
  sceneBox(): Box | null {
    return boxOf(this.#life.ask((widget) => widget.sceneBox()));
  }

  /** Position of a panel's point on the canvas, in CSS pixels; null if it is not visible. */
  panelToScreen(panel: string, x: number, y: number): [number, number] | null {
    const at = this.#life.ask((widget) => widget.panelToScreen(String(panel), x, y));
    return at === undefined ? null : [at[0] ?? 0, at[1] ?? 0];
  }

  /** Zooms every map, or moves the visible part. */
  look(way: Way): void {
    this.#life.ask((widget) => widget.look(shorten(String(way))));
    this.#life.wake();
  }

  /** Panics on purpose, in the widget or in the worker beside it, for tests of a page's recovery. */
  crashForTest(where?: 'worker'): void {
    if (where === 'worker') this.#desk?.crashForTest();
    else this.#life.ask((widget) => widget.crashForTest());
  }

  /**
   * Passes a file to a widget that accepts files: a log, a session, a reference for grading, or a world.
   * Several files are those of one recording.
   */
  openFile(file: File | readonly File[], use: FileUse = 'map'): void {
    if (!this.#isSetUp) this.#setUp();
    if (!this.#takesFiles) throw new TypeError(`${this.name} takes no files`);
    const files = file instanceof File ? [file] : [...file];
    if (use === 'where') void this.#act(() => this.#takeFiles(files, use));
    else this.#takeFiles(files, use);
  }

  /** The doctor's report on the log of w16.10, in the format of `slam2d doctor --json`; null if there is none. */
  get diagnosis(): Diagnosis | null {
    return this.#doctor?.diagnosis ?? null;
  }

  /** The bytes of a file that w16.10 saves, such as `session.slam2d`; rejects with a sentence if there is none. */
  savedFile(name: string): Promise<File> {
    return this.#desk?.file(String(name)) ?? Promise.reject(new Error('Open a log first.'));
  }

  /** Releases context and memory; the values stay, and the picture shows them. */
  suspend(): void {
    this.#life.suspend();
  }

  // ---- setting up ---------------------------------------------------------------------------

  async #ensureInstance(): Promise<void> {
    if (!this.#isSetUp) this.#setUp();
    await this.#life.ensureInstance();
  }

  #setUp(): void {
    const parts = this.#parts;
    this.#isSetUp = true;
    this.#closeDesk();
    const spec = findWidget(this.name);
    parts.frame.classList.toggle('takes-files', spec?.takesFiles === true);
    parts.frame.classList.toggle('without-file', spec?.takesFiles === true);
    this.#state = spec && new State(spec);
    this.#lastOutcome = undefined;
    this.#notes.clear();
    this.#pictures.clear(spec?.summary ?? '');
    this.#place.reserve(spec?.heights ?? []);
    parts.bar.replaceChildren();
    if (spec === undefined) {
      const known = widgets.map((widget) => widget.id).join(', ');
      this.#news.wrong('name', `There is no widget \`${this.name.slice(0, 60)}\`; there are ${known}.`);
      return;
    }
    this.#controls = new Controls(spec, {
      set: (id, text) => this.#tryToSet(id, text),
      text: (id) => this.#state?.text(id) ?? '',
      press: (id) => void this.press(id).catch((error: unknown) => this.#pressFailed(error)),
      finishRun: () => {
        this.#finishWork();
        this.#showTimeline();
      },
      focus: (id) => this.#looks.showFocus(id),
    });
    const look = lookBar((way) => this.look(way));
    look.hidden = true;
    this.#look = look;
    parts.bar.append(this.#controls.element, look, takeAwayBar(this, spec.id, parts.status));
    parts.frame.setAttribute('aria-label', `Widget ${spec.id.replace(/^w/, '')}: ${spec.title}`);
    parts.summary.textContent = spec.summary;
    this.#looks.become(spec.id);
    this.#news.given(() => {
      for (const param of spec.params) {
        const text = this.getAttribute(param.id);
        if (text !== null) this.#tryToSet(param.id, text);
      }
    });
    if (this.hasAttribute('linked')) {
      readAddress(this, spec, {
        set: (id, text) => this.#tryToSet(id, text),
        wrong: (kind, problem) => this.#news.wrong(kind, problem),
      });
    }
    this.#controls.show(this.#state?.texts ?? []);
    this.#offerControls();
    this.#news.setUp();
  }

  /** Ignores an error if the element has left its page, because the reader cannot see it. */
  #pressFailed(error: unknown): void {
    if (!(error instanceof TakenAwayError)) this.#life.fail(error);
  }

  // ---- running ------------------------------------------------------------------------------

  #lifeHost(): LifeHost {
    return {
      widget: () => this.#state?.spec,
      isHere: () => this.isConnected,
      prepare: (widget) => {
        const state = this.#state;
        this.#desk?.restore(widget);
        for (const [id, text] of state?.texts ?? []) {
          const problem = refusal(() => widget.set(id, text));
          if (problem !== undefined) this.#news.wrong('value', `${problem}. The default stands.`, id);
        }
        // The model may keep less than was asked for: no moment after the end of its run.
        for (const id of state?.texts.keys() ?? []) state?.keep(id, widget.text(id));
        this.#controls?.show(state?.texts ?? []);
        this.#offerControls(widget);
        this.#looks.prepare(widget);
        widget.setRoom(this.#place.room);
      },
      live: (milliseconds) => {
        this.#showTimeline();
        this.#shownOutcome();
        this.#news.ready(milliseconds);
      },
      drew: (canvas) => {
        this.#pictures.handOut(canvas);
        this.#looks.drew(canvas);
        this.#sync();
      },
      rested: () => this.#news.rested(),
      leaving: () => {
        this.#looks.drawPicture();
        this.#shownOutcome();
        this.#place.keep();
      },
      failed: (error) => {
        this.#place.free();
        this.#pictures.refuse(error);
        this.#news.failed(error, () => this.#life.restart());
      },
    };
  }

  /** Copies what changed in the widget: pointer, playback, presets. */
  #sync(): void {
    this.#carryOrders();
    const changes = this.#changes();
    if (changes.length === 0) return;
    const timeline = this.#shownTimeline();
    if (timeline?.playing === true) {
      const before = Number(this.#state?.text(timeline.param));
      const now = Number(new Map(changes).get(timeline.param) ?? before);
      this.#news.passed(timeline, before, now);
    }
    this.#told(changes);
  }

  /** Values of the widget that the element does not have yet. */
  #changes(): [string, string][] {
    const values = this.#life.ask((_, instance) => instance.values()) ?? {};
    const known = [...(this.#state?.texts ?? [])];
    return known.map(([id, text]): [string, string] => [id, values[id] ?? text]).filter(([id, text]) => this.#state?.text(id) !== text);
  }

  /** Executes the widget's requests to its host: a file, its mapping, a file to save. */
  #carryOrders(): void {
    const orders = this.#life.ask((widget) => widget.takeOrders()) ?? [];
    for (const order of orders) {
      if (!carryTextOrder(order, this.#textFiles)) this.#openDesk().order(order);
    }
  }

  /** Whether the widget accepts a file: a log, or a world, which a text can contain as well. */
  get #takesFiles(): boolean {
    const spec = this.#state?.spec;
    return spec?.takesFiles === true || spec?.params.some(({ kind }) => kind === 'text') === true;
  }

  #takeFiles(files: File[], use?: FileUse): void {
    const [first] = files;
    if (this.#state?.spec.takesFiles === true) this.#openDesk().take(files, use);
    else if (first !== undefined) void takeTextFile(first, this.#textFiles);
  }

  #openDesk(): Desk {
    if (this.#desk !== undefined) return this.#desk;
    const label = 'A log, or a reference for it';
    const desk = new Desk({
      deliver: (deliveries) => this.#deliver(deliveries),
      choose: (accept, chosen) => chooseFiles(this.#parts.frame, { accept, label, several: true }, chosen),
    });
    this.#doctor = new DoctorScreen({
      choose: (option) => desk.choose(option?.replace(/^--/, '')),
      chosen: () => desk.chosen,
    });
    this.#loops = new LoopsToLookInto({
      show: (loop) => this.#tryToSet('loop', loop),
      decide: (order) => desk.order(order),
    });
    this.#parts.frame.prepend(this.#doctor.element);
    this.#parts.stage.after(this.#loops.element);
    this.#parts.frame.classList.remove('without-file');
    this.#desk = desk;
    return desk;
  }

  #closeDesk(): void {
    this.#desk?.close();
    this.#desk = undefined;
    this.#doctor?.element.remove();
    this.#doctor = undefined;
    this.#loops?.element.remove();
    this.#loops = undefined;
  }

  #deliver(deliveries: readonly Delivery[]): void {
    const besides = [this.#doctor, this.#loops];
    const moved = deliveries.flatMap((delivery) => besides.filter((beside) => beside?.hear(delivery) === true));
    if (moved.length > 0) this.#resized();
    this.#life.ask((widget) => deliveries.forEach((delivery) => hand(widget, delivery)));
    this.#told(this.#changes());
    this.#carryOrders();
    this.#life.wake();
  }

  /** Executes an action on the widget, at once if it runs, else as soon as it does. */
  async #act(deed: (widget: Widget) => void): Promise<void> {
    try {
      await this.#ensureInstance();
    } catch (error) {
      this.#pressFailed(error);
      return;
    }
    this.#life.ask(deed);
    this.#told(this.#changes());
    this.#carryOrders();
    this.#life.wake();
  }

  /** Stores changes, and reports them to controls and page. */
  #told(changes: readonly [string, string][]): void {
    for (const [id, text] of changes) this.#state?.keep(id, text);
    this.#controls?.show(changes);
    if (changes.length > 0) this.#offerControls();
    this.#showTimeline();
    this.#news.changed(changes, this.#shownOutcome());
  }

  /** The controls that the widget shows are the stops of the keyboard; one that rests shows its opening, or all. */
  #offerControls(running?: Widget): void {
    const state = this.#state;
    if (state === undefined) return;
    const { spec } = state;
    const hasMore = spec.params.some(({ id }) => id === MORE);
    const isOpen = !hasMore || state.text(MORE) === 'on';
    const all = (): string[] => [...spec.presets, ...spec.params, ...spec.buttons].map(({ id }) => id);
    const shown = running?.shownControls() ?? this.#life.ask((widget) => widget.shownControls());
    this.#controls?.offer(shown ?? (isOpen ? all() : spec.opening));
    if (this.#look !== undefined) this.#look.hidden = !isOpen;
  }

  /** Figures are read of the values that are set: what the picture still waits for is finished. */
  #finishWork(): void {
    if (this.#life.ask((widget) => widget.finish_work()) === true) this.#life.wake();
  }

  /** The result of what the picture shows, which may wait for newer values. */
  #shownOutcome(): Outcome | undefined {
    this.#lastOutcome = this.#life.ask((_, instance) => instance.outcome()) ?? this.#lastOutcome;
    return this.#lastOutcome;
  }

  #shownSummary(): string {
    return this.#life.ask((widget) => widget.summary()) ?? this.#state?.spec.summary ?? '';
  }

  #shownTimeline(): Timeline | null {
    return this.#life.ask((_, instance) => instance.timeline()) ?? null;
  }

  #showTimeline(): void {
    this.#controls?.disable(this.#life.ask((widget) => widget.disabledButtons()) ?? []);
    this.#controls?.showTimeline(this.#shownTimeline());
  }

  #resized(): void {
    this.#place.fit();
    this.#life.ask((widget) => widget.setRoom(this.#place.room));
    this.#life.wake();
  }

  // ---- values -------------------------------------------------------------------------------

  /** Sets a parameter; returns the error, if there is one. */
  #set(id: string, given: unknown): string | undefined {
    if (!this.#isSetUp) this.#setUp();
    const state = this.#state;
    if (state === undefined) return 'there is no such widget';
    const parsed = state.parse(id, given);
    if (!parsed.ok) return parsed.problem;
    if (state.text(id) === parsed.text) return undefined;
    let problem: string | undefined;
    const kept = this.#life.ask((running) => {
      problem = refusal(() => running.set(id, parsed.text));
      return running.text(id);
    });
    if (problem !== undefined) return problem;
    // The result of the old values is invalid now.
    if (kept === undefined) this.#lastOutcome = undefined;
    this.#told([...new Map([[id, kept ?? parsed.text], ...this.#changes()])]);
    this.#carryOrders();
    this.#life.wake();
    return undefined;
  }

  /** Sets a value from outside; reports and returns the error, if there is one. */
  #tryToSet(id: string, given: unknown): string | undefined {
    const problem = this.#set(id, given);
    if (problem === undefined) {
      this.#notes.settle(id);
      return undefined;
    }
    const label = this.#state?.label(id);
    const stands = label === undefined ? '' : ` It stays at ${label}.`;
    this.#news.wrong('value', `${problem}.${stands}`, id);
    return problem;
  }
}

/** The core's reason to reject a well-formed value; a panic propagates. */
function refusal(deed: () => void): string | undefined {
  try {
    deed();
    return undefined;
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError || error instanceof CrashError) throw error;
    return (error as Error).message;
  }
}
