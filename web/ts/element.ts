// <slam-widget name="w16.1" heading="60">: a widget on any page.
//
// The element keeps the values; an instance of the module draws them. An instance lives while the
// widget is near the screen and is made anew from the values whenever it is needed again: after
// scrolling back, after a panic, after a lost context. One path for all of them.

import { Controls, create } from './controls';
import { copyText, saveCsv, savePng } from './export';
import { CrashError, Instance, type CsvFile, type Outcome, type Timeline } from './instance';
import { readQuery, writeQuery } from './links';
import { hasWebGl2, LoadError } from './module';
import { build, crashDetails, type Parts } from './parts';
import { findParam, findWidget, widgets, type WidgetSpec } from './schema';
import { Stage } from './stage';
import { themeOf, watchTheme, type Theme } from './theme';
import { defaultText, parseValue, toValue, type Value } from './values';
import { unwatchVisibility, watchVisibility } from './visibility';

/** Live contexts at most; browsers drop the oldest beyond sixteen. */
const MAX_RUNNING = 8;
/** After the last change, before the result is told: not every frame of a drag is news. */
const SETTLED_MS = 350;

const running = new Set<SlamWidget>();
const reducedMotion = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)');

export class SlamWidget extends HTMLElement {
  static readonly observedAttributes: string[] = ['name', 'theme'];

  #spec: WidgetSpec | undefined;
  #values = new Map<string, string>();
  #instance: Instance | undefined;
  #creating: Promise<Instance> | undefined;
  #stage: Stage | undefined;
  #parts: Parts | undefined;
  #controls: Controls | undefined;
  #isInView = false;
  #isNear = false;
  #isFar = false;
  #startedAt = 0;
  #lastOutcome: Outcome | undefined;
  #resultTimer: ReturnType<typeof setTimeout> | undefined;
  #unwatch: (() => void)[] = [];
  #wantPicture: ((picture: ImageBitmap) => void)[] = [];
  #generation = 0;

  connectedCallback(): void {
    this.#parts ??= build(this.attachShadow({ mode: 'open' }));
    this.#setUp();
    this.#unwatch = [
      watchTheme(() => this.#showTheme()),
      listen(window, 'error', () => this.#checkCrash()),
      listen(window, 'beforeprint', () => this.#drawPicture('light')),
      listen(window, 'resize', () => this.#wake()),
      listen(document, 'visibilitychange', () => this.#wake()),
    ];
    if (reducedMotion !== undefined) {
      this.#unwatch.push(listen(reducedMotion, 'change', () => this.#showMotion()));
    }
    watchVisibility(this, {
      near: (isNear) => {
        this.#isNear = isNear;
        this.#runOrSuspend();
      },
      inView: (isInView) => {
        this.#isInView = isInView;
        this.#openOrClose();
      },
      far: (isFar) => {
        this.#isFar = isFar;
        this.#runOrSuspend();
      },
    });
  }

  disconnectedCallback(): void {
    unwatchVisibility(this);
    for (const end of this.#unwatch) end();
    this.#unwatch = [];
    clearTimeout(this.#resultTimer);
    this.#isNear = false;
    this.#isInView = false;
    this.suspend();
  }

  attributeChangedCallback(name: string, old: string | null, value: string | null): void {
    if (!this.isConnected) return;
    if (name === 'name') {
      if (old === value) return;
      this.suspend();
      this.#setUp();
      if (this.#isNear) void this.#run();
    } else if (name === 'theme') {
      this.#showTheme();
    } else {
      const spec = this.#spec && findParam(this.#spec, name);
      if (spec !== undefined) this.#tryToSet(name, value ?? defaultText(spec));
    }
  }

  // ---- for programs -------------------------------------------------------------------------

  /** The whole state as JSON; setting takes an object or its text, all of it or some. */
  get value(): Record<string, Value> {
    const spec = this.#spec;
    if (spec === undefined) return {};
    return Object.fromEntries(
      spec.params.map((param) => [param.id, toValue(param, this.#text(param.id))]),
    );
  }

  set value(given: Record<string, Value> | string) {
    const state: unknown = typeof given === 'string' ? JSON.parse(given) : given;
    if (typeof state !== 'object' || state === null || Array.isArray(state)) {
      throw new TypeError('value takes an object of parameters');
    }
    for (const [id, value] of Object.entries(state)) this.set(id, value as Value);
  }

  /** One parameter; undefined where this widget has none of that name. */
  get(id: string): Value | undefined {
    const spec = this.#spec && findParam(this.#spec, id);
    return spec && toValue(spec, this.#text(id));
  }

  /** Sets one parameter; throws a RangeError that names what would be right. */
  set(id: string, value: Value): void {
    const problem = this.#set(id, value);
    if (problem !== undefined) throw new RangeError(problem);
  }

  /** Presses a button or a preset by its name. */
  async press(id: string): Promise<void> {
    const instance = await this.#ensureInstance();
    this.#guard(() => instance.use((widget) => widget.press(id)));
    this.#sync();
    this.#controls?.showTimeline(this.timeline);
    instance.frames.wake();
  }

  /** The latest result, once the widget has run. */
  get outcome(): Outcome | undefined {
    this.#guard(() => (this.#lastOutcome = this.#instance?.outcome() ?? this.#lastOutcome));
    return this.#lastOutcome;
  }

  /** The run that can be scrubbed, while the widget runs. */
  get timeline(): Timeline | null {
    return this.#guard(() => this.#instance?.timeline()) ?? null;
  }

  /** The text that stands for the picture. */
  get summary(): string {
    const now = this.#guard(() => this.#instance?.use((widget) => widget.summary()));
    return now ?? this.#spec?.summary ?? '';
  }

  /** The state as the query of a link. */
  get query(): string {
    return this.#spec === undefined ? '' : writeQuery(this.#spec, this.#values);
  }

  /** Every plot and table as CSV. */
  async tables(): Promise<CsvFile[]> {
    const instance = await this.#ensureInstance();
    return this.#guard(() => instance.tables()) ?? [];
  }

  /** What the canvas shows, pixel by pixel; waits until the widget runs and draws. */
  snapshot(): Promise<ImageBitmap> {
    return new Promise((resolve) => {
      this.#wantPicture.push(resolve);
      this.#wake();
    });
  }

  /** `running` while it has a canvas. */
  get state(): 'running' | 'resting' {
    return this.#stage === undefined ? 'resting' : 'running';
  }

  /** Frames drawn since this instance started. */
  get frames(): number {
    return this.#guard(() => this.#instance?.use((widget) => widget.frames())) ?? 0;
  }

  /** Whether something that drags lies there, in CSS pixels from the canvas's corner. */
  dragsAt(x: number, y: number): boolean {
    return this.#guard(() => this.#instance?.use((widget) => widget.dragsAt(x, y))) ?? false;
  }

  /** Where a control lies on the canvas: left, top, width, height; null while it rests. */
  controlBox(id: string): [number, number, number, number] | null {
    const box = this.#guard(() => this.#instance?.use((widget) => widget.controlBox(id)));
    return box === undefined ? null : ([...box] as [number, number, number, number]);
  }

  /** Where a point of a panel lies on the canvas, in CSS pixels; null where it is not shown. */
  panelToScreen(panel: string, x: number, y: number): [number, number] | null {
    const at = this.#guard(() =>
      this.#instance?.use((widget) => widget.panelToScreen(panel, x, y)),
    );
    return at === undefined ? null : [at[0] ?? 0, at[1] ?? 0];
  }

  /** Panics in the widget on purpose, for tests of a page's recovery. */
  crashForTest(): void {
    this.#guard(() => this.#instance?.use((widget) => widget.crashForTest()));
  }

  /** Gives context and memory back; the values stay, and the picture shows them. */
  suspend(): void {
    this.#generation += 1;
    running.delete(this);
    if (this.#stage !== undefined) this.#drawPicture(themeOf(this));
    this.#stage?.dispose();
    this.#stage = undefined;
    this.#instance?.dispose();
    this.#instance = undefined;
    this.#creating = undefined;
    this.#parts?.stage.classList.remove('live', 'waiting');
    this.#parts?.progress.setAttribute('hidden', '');
  }

  // ---- setting up ---------------------------------------------------------------------------

  #setUp(): void {
    const parts = this.#parts;
    if (parts === undefined) return;
    const name = this.getAttribute('name') ?? '';
    const spec = findWidget(name);
    this.#spec = spec;
    this.#values.clear();
    this.#lastOutcome = undefined;
    parts.note.replaceChildren();
    parts.bar.replaceChildren();
    if (spec === undefined) {
      const known = widgets.map((widget) => widget.id).join(', ');
      this.#tell('name', `There is no widget \`${name.slice(0, 60)}\`; there are ${known}.`);
      return;
    }
    this.#values = new Map(spec.params.map((param) => [param.id, defaultText(param)]));
    this.#controls = new Controls(spec, {
      set: (id, text) => this.#tryToSet(id, text),
      press: (id) => void this.press(id).catch((error: unknown) => this.#fail(error)),
      focus: (id) => this.#showFocus(id),
    });
    parts.bar.append(this.#controls.element, this.#tools(parts));
    parts.frame.setAttribute('aria-label', `Widget ${spec.id.replace(/^w/, '')}: ${spec.title}`);
    parts.picture.alt = spec.summary;
    parts.summary.textContent = spec.summary;
    this.#showTheme();
    this.#readAttributes(spec);
    if (this.hasAttribute('linked')) this.#readAddress(spec);
    this.#controls.show(this.#values);
  }

  #readAttributes(spec: WidgetSpec): void {
    for (const param of spec.params) {
      const text = this.getAttribute(param.id);
      if (text !== null) this.#tryToSet(param.id, text);
    }
  }

  #readAddress(spec: WidgetSpec): void {
    const linked = readQuery(location.search);
    if (linked === undefined) return;
    if (!('widget' in linked)) {
      // One of them speaks for all.
      if (document.querySelector('slam-widget[linked]') !== this) return;
      for (const problem of linked.problems) this.#tell('name', problem);
      return;
    }
    if (linked.widget !== spec) return;
    for (const [id, text] of linked.values) this.#tryToSet(id, text);
    for (const problem of linked.problems) this.#tell('value', problem);
  }

  #tools(parts: Parts): HTMLElement {
    const tools = create('div', { class: 'tools', role: 'group', 'aria-label': 'Take away' });
    const button = (label: string, press: () => void): void => {
      const element = create('button', { type: 'button' });
      element.textContent = label;
      element.addEventListener('click', press);
      tools.append(element);
    };
    button('Save picture', () => {
      void this.snapshot().then((picture) => savePng(picture, this.#spec?.id ?? 'widget'));
    });
    button('Save data', () => {
      void this.tables().then((files) => saveCsv(files, this.#spec?.id ?? 'widget'));
    });
    button('Copy link', () => void this.#copyLink());
    tools.append(parts.status);
    return tools;
  }

  // ---- running ------------------------------------------------------------------------------

  async #run(): Promise<void> {
    const parts = this.#parts;
    if (this.#stage !== undefined || this.#spec === undefined || parts === undefined) return;
    if (parts.stage.classList.contains('waiting')) return;
    // After a failure the reader decides.
    if (parts.note.querySelector('.failure') !== null) return;
    const generation = this.#generation;
    try {
      if (!hasWebGl2()) throw new LoadError('this browser draws no WebGL 2');
      parts.stage.classList.add('waiting');
      const instance = await this.#ensureInstance();
      if (generation !== this.#generation) return;
      makeRoom(this);
      const stage = await Stage.start(parts.stage, instance, this.#spec.title, () =>
        this.#restart(),
      );
      if (generation !== this.#generation) {
        stage.dispose();
        return;
      }
      this.#stage = stage;
      this.#startedAt = performance.now();
      instance.frames.afterFrame = () => this.#afterFrame(instance, stage);
      instance.frames.onCrash = (error) => this.#fail(instance.crash() ?? error);
      this.#showMotion();
      this.#openOrClose();
      // The first frames are drawn even before the widget is seen.
      instance.frames.open();
    } catch (error) {
      if (generation === this.#generation) this.#fail(error);
    }
  }

  /** The observers tell one after the other, and while a window changes not always the truth. */
  #runOrSuspend(): void {
    if (this.#isNear) void this.#run();
    else if (this.#isFar) this.suspend();
  }

  #ensureInstance(): Promise<Instance> {
    const spec = this.#spec;
    if (spec === undefined) return Promise.reject(new LoadError('there is no such widget'));
    const generation = this.#generation;
    this.#creating ??= (async () => {
      const progress = this.#parts?.progress;
      progress?.removeAttribute('hidden');
      const instance = await Instance.create(spec.id, (share) => {
        if (progress !== undefined) progress.value = share;
      });
      if (generation !== this.#generation) {
        instance.dispose();
        throw new LoadError('the widget was taken away while it loaded');
      }
      this.#instance = instance;
      for (const [id, text] of this.#values) instance.use((widget) => widget.set(id, text));
      instance.use((widget) => widget.setTheme(themeOf(this)));
      instance.takeChanges();
      return instance;
    })();
    return this.#creating;
  }

  /** The context was lost: everything anew, from the values. */
  #restart(): void {
    this.suspend();
    if (this.#isNear) void this.#run();
  }

  #openOrClose(): void {
    if (this.#stage === undefined) return;
    if (this.#isInView) this.#instance?.frames.open();
    else if (this.#parts?.stage.classList.contains('live') === true) this.#instance?.frames.close();
  }

  #wake(): void {
    this.#guard(() => this.#instance?.use((widget) => widget.requestFrame()));
    this.#instance?.frames.wake();
  }

  /** Runs after every frame; says whether another is wanted. */
  #afterFrame(instance: Instance, stage: Stage): boolean {
    const parts = this.#parts;
    const crash = instance.crash();
    if (crash !== undefined || parts === undefined) throw crash ?? new Error('no parts');
    this.#handOutPicture(stage.canvas);
    const height = Math.ceil(instance.use((widget) => widget.contentHeight()));
    const fits = Math.abs(height - stage.canvas.clientHeight) <= 1;
    if (!fits && height > 0) stage.canvas.style.height = `${height}px`;
    else if (!parts.stage.classList.contains('live')) this.#showLive(parts);
    this.#sync();
    // A new height asks for a frame at that height, however slow the machine is.
    return !fits || instance.use((widget) => widget.wantsFrame());
  }

  /** A canvas holds its pixels until the end of the task that drew them, so now is the time. */
  #handOutPicture(canvas: HTMLCanvasElement): void {
    for (const resolve of this.#wantPicture.splice(0)) {
      void createImageBitmap(canvas).then(resolve);
    }
  }

  #showLive(parts: Parts): void {
    parts.progress.setAttribute('hidden', '');
    parts.stage.classList.replace('waiting', 'live');
    running.add(this);
    this.#controls?.showTimeline(this.timeline);
    this.#lastOutcome = this.outcome;
    this.#openOrClose();
    this.#emit('slam-ready', { value: this.value, ms: performance.now() - this.#startedAt });
  }

  /** Takes over what changed in the widget: pointer, playback, presets. */
  #sync(): void {
    const changes = this.#guard(() => this.#instance?.takeChanges()) ?? [];
    if (changes.length === 0) return;
    for (const [id, text] of changes) this.#values.set(id, text);
    this.#told(changes);
  }

  /** Tells controls and page of changes. */
  #told(changes: [string, string][]): void {
    this.#controls?.show(changes);
    this.#guard(() => this.#instance && this.#controls?.showTimeline(this.#instance.timeline()));
    const outcome = this.outcome;
    for (const [parameter, text] of changes) {
      this.#emit('slam-change', { parameter, value: this.get(parameter), text, outcome });
    }
    clearTimeout(this.#resultTimer);
    this.#resultTimer = setTimeout(() => this.#settled(), SETTLED_MS);
  }

  #settled(): void {
    const { outcome } = this;
    const parts = this.#parts;
    if (parts === undefined) return;
    parts.summary.textContent = this.summary;
    if (outcome !== undefined) {
      parts.live.textContent = outcome.sentence;
      this.#emit('slam-result', { value: this.value, outcome });
    }
    if (this.hasAttribute('linked')) this.#writeAddress();
  }

  // ---- values -------------------------------------------------------------------------------

  #text(id: string): string {
    return this.#values.get(id) ?? '';
  }

  /** Sets a parameter; returns what was wrong. */
  #set(id: string, given: unknown): string | undefined {
    const widget = this.#spec;
    if (widget === undefined) return 'there is no such widget';
    const spec = findParam(widget, id);
    if (spec === undefined) {
      const known = widget.params.map((param) => param.id).join(', ');
      return `${widget.id} has no parameter \`${id.slice(0, 60)}\`; it has ${known}`;
    }
    const parsed = parseValue(spec, given);
    if (!parsed.ok) return parsed.problem;
    if (this.#values.get(id) === parsed.text) return undefined;
    this.#values.set(id, parsed.text);
    this.#guard(() => this.#instance?.use((running) => running.set(id, parsed.text)));
    const also = this.#guard(() => this.#instance?.takeChanges()) ?? [];
    for (const [other, text] of also) this.#values.set(other, text);
    this.#told([[id, parsed.text], ...also.filter(([other]) => other !== id)]);
    this.#instance?.frames.wake();
    return undefined;
  }

  #tryToSet(id: string, given: unknown): void {
    const problem = this.#set(id, given);
    if (problem !== undefined) this.#tell('value', `${problem}. The default stands.`);
  }

  #writeAddress(): void {
    const address = new URL(location.href);
    address.search = this.query;
    history.replaceState(history.state, '', address);
  }

  async #copyLink(): Promise<void> {
    const page = this.hasAttribute('linked') ? location.href : new URL('embed.html', import.meta.url);
    const link = new URL(page);
    link.search = this.query;
    const copied = await copyText(link.href);
    if (this.#parts !== undefined) {
      this.#parts.status.textContent = copied ? 'The link is copied.' : link.href;
    }
  }

  // ---- looks --------------------------------------------------------------------------------

  #showTheme(): void {
    const theme = themeOf(this);
    this.#parts?.frame.classList.toggle('dark', theme === 'dark');
    this.#guard(() => this.#instance?.use((widget) => widget.setTheme(theme)));
    this.#instance?.frames.wake();
    if (this.#instance === undefined) this.#showStaticPicture(theme);
  }

  #showMotion(): void {
    const reduced = reducedMotion?.matches === true;
    this.#guard(() => this.#instance?.use((widget) => widget.setReducedMotion(reduced)));
  }

  #showFocus(id: string | undefined): void {
    this.#guard(() => this.#instance?.use((widget) => widget.setFocus(id)));
    this.#instance?.frames.wake();
    if (id !== undefined) this.#scrollTo(id);
  }

  /** Brings the control on the canvas, with its ring, to where it can be seen. */
  #scrollTo(id: string): void {
    const box = this.controlBox(id);
    const stage = this.#parts?.stage;
    if (box === null || stage === undefined || this.#stage === undefined) return;
    const [left, top, width, height] = box;
    const at = stage.getBoundingClientRect().top + top;
    const free = window.innerHeight - (this.#parts?.bar.offsetHeight ?? 0);
    if (at >= 0 && at + height <= free) return;
    const marker = create('span');
    const place = { left, top, width, height };
    marker.style.position = 'absolute';
    for (const [side, value] of Object.entries(place)) marker.style.setProperty(side, `${value}px`);
    stage.append(marker);
    marker.scrollIntoView({ block: 'center', inline: 'nearest' });
    marker.remove();
  }

  /** The picture that the build drew: the state at the start. */
  #showStaticPicture(theme: Theme): void {
    const picture = this.#parts?.picture;
    if (picture === undefined || this.#spec === undefined) return;
    // A picture of the state that the reader left is better.
    if (picture.src.startsWith('data:')) return;
    picture.src = new URL(`pictures/${this.#spec.id}-${theme}.svg`, import.meta.url).href;
  }

  /** The picture of the state of now, drawn by the widget itself. */
  #drawPicture(theme: Theme): void {
    const parts = this.#parts;
    if (this.#instance === undefined || parts === undefined) return;
    const width = Math.max(this.clientWidth, 320);
    const svg = this.#guard(() => this.#instance?.use((widget) => widget.picture(width, theme)));
    if (svg === undefined) return;
    parts.picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
    parts.picture.alt = this.summary;
  }

  // ---- trouble ------------------------------------------------------------------------------

  /** Calls into the instance; a panic ends the instance, not the page. */
  #guard<T>(call: () => T): T | undefined {
    try {
      return call();
    } catch (error) {
      if (!(error instanceof CrashError)) throw error;
      this.#fail(error);
      return undefined;
    }
  }

  #checkCrash(): void {
    const crash = this.#instance?.crash();
    if (crash !== undefined) this.#fail(crash);
  }

  #fail(error: unknown): void {
    const parts = this.#parts;
    if (parts === undefined || parts.note.querySelector('.failure') !== null) return;
    const isCrash = error instanceof CrashError;
    // A crashed instance cannot draw its picture any more.
    if (isCrash) this.#instance?.frames.close();
    this.#instance = isCrash ? undefined : this.#instance;
    this.suspend();
    const reason = error instanceof Error ? error.message : String(error);
    const message = isCrash
      ? 'This widget stopped because of an error in its program. Your settings are kept.'
      : `The interactive widget cannot run here: ${reason}. The picture shows its start.`;
    const box = create('div', { class: 'failure' });
    const sentence = create('p');
    sentence.textContent = message;
    box.append(sentence);
    if (isCrash) box.append(crashDetails(error.details));
    const again = create('button', { type: 'button' });
    again.textContent = isCrash ? 'Restart with these settings' : 'Try again';
    again.addEventListener('click', () => {
      box.remove();
      void this.#run();
    });
    box.append(again);
    parts.note.append(box);
    this.#emit('slam-error', { kind: isCrash ? 'crash' : 'load', message: reason });
  }

  /** Names something that was wrong with what came from outside; as text, never as HTML. */
  #tell(kind: string, message: string): void {
    const line = create('p');
    line.textContent = message;
    this.#parts?.note.append(line);
    this.#emit('slam-error', { kind, message });
  }

  #emit(type: string, detail: Record<string, unknown>): void {
    const name = this.#spec?.id ?? this.getAttribute('name');
    this.dispatchEvent(
      new CustomEvent(type, { detail: { name, ...detail }, bubbles: true, composed: true }),
    );
  }
}

/** Suspends widgets out of view while too many run. */
function makeRoom(newcomer: SlamWidget): void {
  const resting = [...running].filter((widget) => widget !== newcomer && !isOnScreen(widget));
  while (running.size >= MAX_RUNNING && resting.length > 0) resting.shift()?.suspend();
}

function isOnScreen(element: Element): boolean {
  const box = element.getBoundingClientRect();
  return box.bottom > 0 && box.top < window.innerHeight;
}

function listen(target: EventTarget, type: string, callback: () => void): () => void {
  target.addEventListener(type, callback);
  return () => target.removeEventListener(type, callback);
}
