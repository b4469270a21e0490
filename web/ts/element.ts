// <slam-widget name="w16.1" heading="60">: a widget on any page.
//
// The element keeps the values and communicates with the page. The instance that draws them exists only near the
// viewport (lifecycle.ts).

import { linkTo, readAddress } from './address';
import { Appearance } from './appearance';
import { boxOf, type Box } from './box';
import { Controls, MORE } from './controls';
import { create, listen, upgradeProperties } from './dom';
import { exportMenu } from './export';
import type { Widget } from '../pkg/glue.js';
import { CrashError, type CsvFile, type Outcome, type Timeline } from './instance';
import { keepEndInView } from './keep-in-view';
import { Lifecycle, RemovedError, type LifecycleHost } from './lifecycle';
import { LoadError } from './module';
import { Notifier } from './notifier';
import { Notes } from './notes';
import { build, type Parts } from './parts';
import { DetailList, VerdictLine } from './readouts';
import { Pictures } from './pictures';
import { ReservedHeight } from './reserved-height';
import { findParam, findWidget, widgets } from './schema';
import { State } from './state';
import { defaultText, shorten, type Value } from './values';
import { fitPicture } from './type-scale';
import { unwatchVisibility, watchVisibility } from './visibility';
import { answersTo, type Driver, isForDriver, seat } from './driver';
import { LogMapper, deliverTo, type FileUse } from './robot/log-mapper';
import { DoctorScreen, type Diagnosis } from './robot/doctor';
import { ConnectionPanel } from './robot/connection';
import { acceptDrops, chooseFiles } from './robot/files';
import { LoopsToLookInto } from './robot/loops';
import { executeTextOrder, takeTextFile, type TextFileHost } from './text-files';
import type { Delivery } from './robot/protocol';
import { type ViewChange, zoomButtons } from './zoom-buttons';

/** Steps of the longest run that a link in the text plays. */
const LONGEST_RUN = 100;

export class SlamWidget extends HTMLElement {
  static readonly observedAttributes: string[] = ['name', 'theme'];

  readonly #parts: Parts;
  readonly #notes: Notes;
  readonly #notifier: Notifier;
  readonly #pictures: Pictures;
  readonly #reservedHeight: ReservedHeight;
  readonly #lifecycle: Lifecycle;
  readonly #appearance: Appearance;
  readonly #verdict: VerdictLine;
  #state: State | undefined;
  #isSetUp = false;
  /** Whether the reader or a program has acted: until then a gesture stands in place of the verdict. */
  #hasActed = false;
  #controls: Controls | undefined;
  #details: DetailList | undefined;
  #lastOutcome: Outcome | undefined;
  #unwatch: (() => void)[] = [];
  readonly #textFiles: TextFileHost;
  /** Maps a reader's log, once a file was opened. */
  #mapper: LogMapper | undefined;
  #driver: Driver | undefined;
  #doctor: DoctorScreen | undefined;
  #loops: LoopsToLookInto | undefined;
  /** Offered by pages whose policy opens connections: `connects`. */
  #connection: ConnectionPanel | undefined;

  constructor() {
    super();
    this.#parts = build(this.attachShadow({ mode: 'open' }));
    this.#notes = new Notes(this.#parts.note);
    this.#textFiles = {
      frame: this.#parts.frame,
      act: (action) => void this.#act(action),
      reject: (problem) => this.#notifier.invalid('value', problem),
    };
    const shownSummary = (): string => this.#shownSummary();
    this.#notifier = new Notifier(this, this.#parts, this.#notes, () => this.#showTimeline(), shownSummary);
    this.#pictures = new Pictures(this.#parts.picture);
    this.#reservedHeight = new ReservedHeight(this.#parts);
    this.#verdict = new VerdictLine(this.#parts.verdict);
    this.#parts.whole.addEventListener('click', () => this.look('whole'));
    this.#parts.drop.addEventListener('click', () => void this.press('open'));
    this.#lifecycle = new Lifecycle(this.#parts, this.#lifecycleHost());
    this.#appearance = new Appearance(this, this.#parts, this.#lifecycle, this.#pictures);
  }

  connectedCallback(): void {
    // An element that moves within its page, or was set up before, keeps its state.
    if (!this.#isSetUp) this.#setUp();
    upgradeProperties(this);
    try {
      this.#connect();
    } catch (error) {
      this.#lifecycle.fail(error);
    }
  }

  #connect(): void {
    this.#unwatch = [
      ...this.#appearance.watch(),
      listen(window, 'error', () => this.#lifecycle.checkCrash()),
      listen(window, 'resize', () => this.#resized()),
      listen(document, 'visibilitychange', () => this.#lifecycle.wake()),
      // Focus and pointer give priority if not all widgets can draw.
      listen(this, 'pointerenter', () => this.#lifecycle.retry()),
      listen(this, 'focusin', () => this.#lifecycle.retry()),
    ];
    if (this.#takesFiles) {
      // The start pose of a log comes from the running widget.
      const take = (files: File[]): void => void this.#act(() => this.#takeFiles(files));
      this.#unwatch.push(acceptDrops(this.#parts.frame, take));
    }
    this.#reservedHeight.fitSoon();
    watchVisibility(this, this.#lifecycle);
  }

  disconnectedCallback(): void {
    unwatchVisibility(this);
    for (const end of this.#unwatch) end();
    this.#unwatch = [];
    this.#notifier.stop();
    this.#lifecycle.leave();
    // An element that moves within its page is connected again in the same task.
    setTimeout(() => {
      if (!this.isConnected) this.#closeMapper();
    });
  }

  attributeChangedCallback(name: string, old: string | null, value: string | null): void {
    // The set-up reads all attributes anyway.
    if (!this.#isSetUp) return;
    if (name === 'name') {
      if (old === value) return;
      this.#lifecycle.suspend();
      this.#setUp();
      this.#lifecycle.restart();
    } else if (name === 'theme') {
      this.#appearance.showTheme();
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

  /** All parameters; the setter takes an object or its JSON, complete or partial. */
  get value(): Record<string, Value> {
    return this.#state?.toJSON() ?? {};
  }

  set value(input: Record<string, Value> | string) {
    const state: unknown = typeof input === 'string' ? JSON.parse(input) : input;
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
    await this.#lifecycle.ensureInstance();
    // A button acts on the values that are set, which the picture may not show yet.
    this.#finishWork();
    this.#hasActed = true;
    this.#lifecycle.ask((widget) => widget.press(button));
    this.#sync();
    this.#showTimeline();
    this.#lifecycle.wake();
  }

  /** Plays a short run from its start, so that the reader sees how the state comes about. */
  async playFromStart(): Promise<void> {
    await this.#ensureInstance();
    const last = this.#shownTimeline()?.last ?? Infinity;
    const canPlay = this.#lifecycle.ask((widget) => widget.shownControls().includes('play')) === true;
    if (last > LONGEST_RUN || !canPlay) return;
    await this.press('reset');
    await this.press('play');
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

  /** The text alternative of the picture. */
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
    return this.#lifecycle.ask((_, instance) => instance.tables()) ?? [];
  }

  /** The pixels of the canvas; waits until the widget runs and draws. */
  snapshot(): Promise<ImageBitmap> {
    if (this.#lifecycle.hasFailed) return Promise.reject(new LoadError('the widget is not running'));
    const picture = this.#pictures.nextFrame();
    this.#lifecycle.wake();
    return picture;
  }

  /** `running` while it has a canvas. */
  get state(): 'running' | 'resting' {
    return this.#lifecycle.isRunning ? 'running' : 'resting';
  }

  /** Frames drawn since this instance started. */
  get frames(): number {
    return this.#lifecycle.ask((widget) => widget.frames()) ?? 0;
  }

  /** Whether something can be dragged at a position, in CSS pixels from the canvas's corner. */
  dragsAt(x: number, y: number): boolean {
    return this.#lifecycle.ask((widget) => widget.dragsAt(x, y)) ?? false;
  }

  /** The rectangle of the picture on the canvas: left, top, width, height; null while it rests. */
  sceneBox(): Box | null {
    return boxOf(this.#lifecycle.ask((widget) => widget.sceneBox()));
  }

  /** Position of a panel's point on the canvas, in CSS pixels; null if it is not visible. */
  panelToScreen(panel: string, x: number, y: number): [number, number] | null {
    const at = this.#lifecycle.ask((widget) => widget.panelToScreen(String(panel), x, y));
    return at === undefined ? null : [at[0] ?? 0, at[1] ?? 0];
  }

  /** Zooms every map, or moves the visible part. */
  look(way: ViewChange): void {
    this.#lifecycle.ask((widget) => widget.look(shorten(String(way))));
    this.#lifecycle.wake();
  }

  /** Panics on purpose in the widget or in its worker, for tests of the recovery. */
  crashForTest(where?: 'worker'): void {
    if (where === 'worker') this.#mapper?.crashForTest();
    else this.#lifecycle.ask((widget) => widget.crashForTest());
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
    return this.#mapper?.file(String(name)) ?? Promise.reject(new Error('Open a log first.'));
  }

  /** The reader's function that drives, if there is one. */
  get driver(): Driver | undefined {
    return this.#driver;
  }

  /** Puts a function of the reader in place of a part of the estimator; without one, ours drives again. */
  async drive(driver?: Driver): Promise<void> {
    this.#driver = driver;
    this.dispatchEvent(new CustomEvent('slam-driver'));
    await this.#act((widget) => seat(widget, driver));
  }

  /** Releases context and memory; the values stay, and the picture shows them. */
  suspend(): void {
    this.#lifecycle.suspend();
  }

  // ---- setting up ---------------------------------------------------------------------------

  async #ensureInstance(): Promise<void> {
    if (!this.#isSetUp) this.#setUp();
    await this.#lifecycle.ensureInstance();
  }

  #setUp(): void {
    const parts = this.#parts;
    this.#isSetUp = true;
    this.#closeMapper();
    const spec = findWidget(this.name);
    parts.frame.classList.toggle('takes-files', spec?.takesFiles === true);
    parts.frame.classList.toggle('without-file', spec?.takesFiles === true);
    this.#state = spec && new State(spec);
    this.#hasActed = false;
    this.#lastOutcome = undefined;
    this.#notes.clear();
    this.#pictures.clear(spec?.summary ?? '');
    this.#reservedHeight.reserve(spec?.heights ?? []);
    for (const place of Object.values(parts.places) as HTMLElement[]) place.replaceChildren();
    this.#details?.element.remove();
    parts.rest.querySelector('.zoom')?.remove();
    parts.bar.hidden = spec === undefined;
    if (spec === undefined) {
      const known = widgets.map((widget) => widget.id).join(', ');
      this.#notifier.invalid('name', `There is no widget \`${this.name.slice(0, 60)}\`; there are ${known}.`);
      return;
    }
    this.#controls = new Controls(spec, parts.places, {
      set: (id, text) => this.#tryToSet(id, text),
      text: (id) => this.#state?.text(id) ?? '',
      press: (id) => {
        void this.press(id).catch((error: unknown) => this.#pressFailed(error));
        // The verdict of the run has more lines than that before it.
        if (id === 'play') keepEndInView(parts.frame, parts.verdict);
      },
      finishRun: () => {
        this.#finishWork();
        this.#showTimeline();
      },
    });
    this.#connection?.element.remove();
    this.#connection = undefined;
    if (spec.takesFiles && this.hasAttribute('connects')) this.#offerConnection();
    this.#details = new DetailList(spec);
    parts.rest.append(zoomButtons((view) => this.look(view)), this.#details.element);
    parts.places.tools.append(exportMenu(this, spec.id, parts.status));
    const number = create('span');
    number.textContent = spec.id.replace(/^w/, '');
    parts.title.replaceChildren(number, spec.title);
    parts.bar.setAttribute('aria-label', `${spec.title}: controls`);
    parts.frame.setAttribute('aria-label', `Widget ${spec.id.replace(/^w/, '')}: ${spec.title}`);
    parts.summary.textContent = spec.summary;
    this.#appearance.become(spec.id);
    this.#notifier.fromAttributes(() => {
      for (const param of spec.params) {
        const text = this.getAttribute(param.id);
        if (text !== null) this.#tryToSet(param.id, text);
      }
    });
    // Attributes are the page's start; an address is a state that somebody chose.
    this.#hasActed = false;
    if (this.hasAttribute('linked')) {
      readAddress(this, spec, {
        set: (id, text) => this.#tryToSet(id, text),
        invalid: (kind, problem) => this.#notifier.invalid(kind, problem),
      });
    }
    this.#controls.show(this.#state?.texts ?? []);
    this.#offerControls();
    this.#showReadouts();
    this.#notifier.setUp();
  }

  /** Reports a failed press, unless the element has left its page. */
  #pressFailed(error: unknown): void {
    if (!(error instanceof RemovedError)) this.#lifecycle.fail(error);
  }

  // ---- running ------------------------------------------------------------------------------

  #lifecycleHost(): LifecycleHost {
    return {
      widget: () => this.#state?.spec,
      isConnected: () => this.isConnected,
      prepare: (widget) => {
        const state = this.#state;
        this.#mapper?.restore(widget);
        for (const [id, text] of state?.texts ?? []) {
          const problem = rejection(() => widget.set(id, text));
          if (problem !== undefined) this.#notifier.invalid('value', `${problem}. The default is used.`, id);
        }
        // The model may clamp a value: a time to the end of the run.
        for (const id of state?.texts.keys() ?? []) state?.keep(id, widget.text(id));
        if (this.#driver !== undefined) seat(widget, this.#driver);
        this.#controls?.show(state?.texts ?? []);
        this.#offerControls(widget);
        this.#appearance.prepare(widget);
        if (this.#hasActed) widget.act();
        this.#fit(widget);
      },
      live: (milliseconds) => {
        this.#executeOrders();
        this.#showTimeline();
        this.#showReadouts();
        this.#notifier.ready(milliseconds);
      },
      drew: (canvas) => {
        this.#pictures.resolveSnapshots(canvas);
        this.#appearance.drew(canvas);
        this.#sync();
        this.#showReadouts();
      },
      rested: () => this.#notifier.rested(),
      late: (cause) => this.#notifier.late(cause, () => {
        this.#lifecycle.suspend();
        this.#lifecycle.restart();
      }),
      leaving: () => {
        this.#showReadouts();
        this.#appearance.drawPicture();
        this.#reservedHeight.keep();
      },
      failed: (error) => {
        this.#reservedHeight.free();
        this.#pictures.rejectSnapshots(error);
        this.#notifier.failed(error, () => this.#lifecycle.restart());
      },
    };
  }

  /** Copies values that changed in the widget, by pointer, playback or preset. */
  #sync(): void {
    this.#executeOrders();
    const changes = this.#changes();
    if (changes.length === 0) return;
    const timeline = this.#shownTimeline();
    if (timeline?.playing === true) {
      const before = Number(this.#state?.text(timeline.param));
      const now = Number(new Map(changes).get(timeline.param) ?? before);
      this.#notifier.passed(timeline, before, now);
    }
    this.#announce(changes);
  }

  /** Values of the widget that the element does not have yet. */
  #changes(): [string, string][] {
    const values = this.#lifecycle.ask((_, instance) => instance.values()) ?? {};
    const known = [...(this.#state?.texts ?? [])];
    return known.map(([id, text]): [string, string] => [id, values[id] ?? text]).filter(([id, text]) => this.#state?.text(id) !== text);
  }

  /** Executes the widget's requests to its host: to open, map or save a file. */
  #executeOrders(): void {
    const orders = this.#lifecycle.ask((widget) => widget.takeOrders()) ?? [];
    for (const order of orders) {
      if (isForDriver(order)) void answersTo(order, this.#driver).then((answers) => this.#deliver(answers));
      else if (!executeTextOrder(order, this.#textFiles)) this.#openMapper().order(order);
    }
  }

  /** Whether the widget accepts a file: a log, or a world for its text parameter. */
  get #takesFiles(): boolean {
    const spec = this.#state?.spec;
    return spec?.takesFiles === true || spec?.params.some(({ kind }) => kind === 'text') === true;
  }

  #takeFiles(files: File[], use?: FileUse): void {
    this.#hasActed = true;
    this.#lifecycle.ask((widget) => widget.act());
    const [first] = files;
    if (this.#state?.spec.takesFiles === true) this.#openMapper().take(files, use);
    else if (first !== undefined) void takeTextFile(first, this.#textFiles);
  }

  #openMapper(): LogMapper {
    if (this.#mapper !== undefined) return this.#mapper;
    const label = 'A log, or a reference for it';
    const mapper = new LogMapper({
      deliver: (deliveries) => this.#deliver(deliveries),
      choose: (chosen) => chooseFiles(this.#parts.frame, { label, several: true }, chosen),
    });
    this.#doctor = new DoctorScreen({
      choose: (option) => mapper.choose(option?.replace(/^--/, '')),
      chosen: () => mapper.chosen,
    });
    this.#loops = new LoopsToLookInto({
      show: (loop) => this.#tryToSet('loop', loop),
      decide: (order) => mapper.order(order),
    });
    if (this.#connection === undefined) this.#parts.frame.prepend(this.#doctor.element);
    else this.#connection.element.after(this.#doctor.element);
    this.#parts.stage.after(this.#loops.element);
    this.#mapper = mapper;
    return mapper;
  }

  #offerConnection(): void {
    const mapper = (): LogMapper => this.#openMapper();
    this.#connection = new ConnectionPanel({
      connect: (address) => void this.#act((widget) => {
        this.#hasActed = true;
        widget.act();
        mapper().listen(address);
      }),
      stop: () => mapper().order('cancel'),
      choose: (laser) => mapper().choose(`scan-topic ${laser}`),
      save: (file) => mapper().order(`save ${file}`),
    });
    this.#parts.frame.prepend(this.#connection.element);
  }

  #closeMapper(): void {
    this.#mapper?.close();
    this.#mapper = undefined;
    this.#doctor?.element.remove();
    this.#doctor = undefined;
    this.#loops?.element.remove();
    this.#loops = undefined;
  }

  #deliver(deliveries: readonly Delivery[]): void {
    const panels = [this.#doctor, this.#loops, this.#connection];
    const resized = deliveries.flatMap((delivery) => panels.filter((panel) => panel?.receive(delivery) === true));
    if (resized.length > 0) this.#resized();
    this.#lifecycle.ask((widget) => {
      for (const delivery of deliveries) deliverTo(widget, delivery);
    });
    for (const { kind } of deliveries) if (kind === 'opening' || kind === 'closed') this.#waitForFile(kind === 'closed');
    this.#announce(this.#changes());
    this.#executeOrders();
    this.#lifecycle.wake();
  }

  /** Shows the drop zone over the picture, until there is a file. */
  #waitForFile(waits: boolean): void {
    this.#parts.frame.classList.toggle('without-file', waits);
    this.#offerControls();
  }

  /** Executes an action on the widget, which is started if necessary. */
  async #act(action: (widget: Widget) => void): Promise<void> {
    try {
      await this.#ensureInstance();
    } catch (error) {
      this.#pressFailed(error);
      return;
    }
    this.#lifecycle.ask(action);
    this.#announce(this.#changes());
    this.#executeOrders();
    this.#lifecycle.wake();
  }

  /** Stores changes, and reports them to the controls and the page. */
  #announce(changes: readonly [string, string][]): void {
    for (const [id, text] of changes) this.#state?.keep(id, text);
    this.#controls?.show(changes);
    if (changes.length > 0) this.#offerControls();
    this.#showTimeline();
    this.#showReadouts();
    this.#notifier.changed(changes, this.#shownOutcome());
  }

  /** Shows the controls of the present state. Without an instance these are its first ones, or all. */
  #offerControls(running?: Widget): void {
    const state = this.#state;
    if (state === undefined) return;
    const { spec } = state;
    const isOpen = this.#isOpen;
    const all = (): string[] => [...spec.presets, ...spec.params, ...spec.buttons].map(({ id }) => id);
    const shown = running?.shownControls() ?? this.#lifecycle.ask((widget) => widget.shownControls());
    this.#controls?.offer(shown ?? (isOpen ? all() : spec.opening), isOpen);
    this.#parts.rest.hidden = !isOpen;
  }

  /** Whether everything is shown. */
  get #isOpen(): boolean {
    return this.#state?.texts.get(MORE) !== 'off';
  }

  /** Shows the gesture or the verdict of the picture as drawn; under More its details. */
  #showReadouts(): void {
    const outcome = this.#shownOutcome();
    this.#hasActed ||= this.#lifecycle.ask((widget) => widget.hasActed()) === true;
    this.#parts.whole.hidden = this.#lifecycle.ask((widget) => widget.isZoomed()) !== true;
    if (this.#asks) this.#verdict.ask(this.#state?.spec.gesture ?? '');
    else if (outcome !== undefined) this.#verdict.show(outcome, this.#state?.spec.claim ?? '');
    const details = this.#isOpen ? this.#lifecycle.ask((widget) => widget.details()) : undefined;
    if (details !== undefined) this.#details?.show(details);
  }

  /** Whether the gesture stands in place of the verdict. */
  get #asks(): boolean {
    return this.#lifecycle.ask((widget) => widget.asks()) ?? !(this.#hasActed || this.#isOpen);
  }

  /** Finishes pending work before results are read: they belong to the values that are set. */
  #finishWork(): void {
    if (this.#lifecycle.ask((widget) => widget.finish_work()) === true) this.#lifecycle.wake();
  }

  /** The result of the picture as drawn, which may lag behind the values. */
  #shownOutcome(): Outcome | undefined {
    this.#lastOutcome = this.#lifecycle.ask((_, instance) => instance.outcome()) ?? this.#lastOutcome;
    return this.#lastOutcome;
  }

  #shownSummary(): string {
    return this.#lifecycle.ask((widget) => widget.summary()) ?? this.#state?.spec.summary ?? '';
  }

  #shownTimeline(): Timeline | null {
    return this.#lifecycle.ask((_, instance) => instance.timeline()) ?? null;
  }

  #showTimeline(): void {
    const buttons = this.#lifecycle.ask((_, instance) => instance.buttons());
    if (buttons !== undefined) this.#controls?.showButtons(buttons);
    const timeline = this.#shownTimeline();
    // The marks tell how the run goes.
    this.#controls?.showTimeline(timeline && (this.#asks ? { ...timeline, marks: [] } : timeline));
  }

  #resized(): void {
    this.#verdict.resized();
    this.#reservedHeight.fit();
    this.#lifecycle.ask((widget) => this.#fit(widget));
    this.#lifecycle.wake();
  }

  #fit(widget: Widget): void {
    const { stage } = this.#parts;
    stage.dataset['type'] = String(fitPicture(widget, this, stage.clientWidth, this.#reservedHeight.room));
  }

  // ---- values -------------------------------------------------------------------------------

  /** Sets a parameter; returns the error, if there is one. */
  #set(id: string, input: unknown): string | undefined {
    if (!this.#isSetUp) this.#setUp();
    const state = this.#state;
    if (state === undefined) return 'there is no such widget';
    const parsed = state.parse(id, input);
    if (!parsed.ok) return parsed.problem;
    this.#hasActed = true;
    this.#lifecycle.ask((running) => running.act());
    if (state.text(id) === parsed.text) return undefined;
    let problem: string | undefined;
    const kept = this.#lifecycle.ask((running) => {
      problem = rejection(() => running.set(id, parsed.text));
      return running.text(id);
    });
    if (problem !== undefined) return problem;
    // The result of the old values is invalid now.
    if (kept === undefined) this.#lastOutcome = undefined;
    this.#announce([...new Map([[id, kept ?? parsed.text], ...this.#changes()])]);
    this.#executeOrders();
    this.#lifecycle.wake();
    return undefined;
  }

  /** Sets a value from outside; reports and returns the error, if there is one. */
  #tryToSet(id: string, input: unknown): string | undefined {
    const problem = this.#set(id, input);
    if (problem === undefined) {
      this.#notes.remove(id);
      return undefined;
    }
    const label = this.#state?.label(id);
    const kept = label === undefined ? '' : ` It stays at ${label}.`;
    this.#notifier.invalid('value', `${problem}.${kept}`, id);
    return problem;
  }
}

/** Returns the core's reason to reject a well-formed value; rethrows a panic. */
function rejection(action: () => void): string | undefined {
  try {
    action();
    return undefined;
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError || error instanceof CrashError) throw error;
    return (error as Error).message;
  }
}
