// <slam-widget name="w16.1" heading="60">: a widget on any page.
//
// The element keeps the values and speaks with the page; what draws them comes and goes with the
// place of the widget on the screen (life.ts).

import { Controls } from './controls';
import { create, listen, reveal } from './dom';
import { takeAwayBar } from './export';
import { CrashError, type CsvFile, type Outcome, type Timeline } from './instance';
import { Life, type LifeHost } from './life';
import { readQuery, writeQuery } from './links';
import { build, failureBox, type Parts } from './parts';
import { findParam, findWidget, widgets, type WidgetSpec } from './schema';
import { themeOf, watchTheme, type Theme } from './theme';
import { defaultText, parseValue, toValue, type Value } from './values';
import { unwatchVisibility, watchVisibility } from './visibility';

/** After the last change, before the result is told: not every frame of a drag is news. */
const SETTLED_MS = 350;

const reducedMotion = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)');

export class SlamWidget extends HTMLElement {
  static readonly observedAttributes: string[] = ['name', 'theme'];

  readonly #parts: Parts;
  readonly #life: Life;
  #spec: WidgetSpec | undefined;
  #values = new Map<string, string>();
  #controls: Controls | undefined;
  #lastOutcome: Outcome | undefined;
  #resultTimer: ReturnType<typeof setTimeout> | undefined;
  #unwatch: (() => void)[] = [];
  #wantPicture: ((picture: ImageBitmap) => void)[] = [];

  constructor() {
    super();
    this.#parts = build(this.attachShadow({ mode: 'open' }));
    this.#life = new Life(this.#parts, this.#lifeHost());
  }

  connectedCallback(): void {
    // What moves within its page, or was set up before, keeps its state.
    if (this.#spec === undefined) this.#setUp();
    this.#unwatch = [
      watchTheme(() => this.#showTheme()),
      listen(window, 'error', () => this.#life.checkCrash()),
      listen(window, 'beforeprint', () => this.#drawPicture('light')),
      listen(window, 'resize', () => this.#life.wake()),
      listen(document, 'visibilitychange', () => this.#life.wake()),
    ];
    if (reducedMotion !== undefined) {
      this.#unwatch.push(listen(reducedMotion, 'change', () => this.#showMotion()));
    }
    watchVisibility(this, this.#life);
  }

  disconnectedCallback(): void {
    unwatchVisibility(this);
    for (const end of this.#unwatch) end();
    this.#unwatch = [];
    clearTimeout(this.#resultTimer);
    this.#life.leave();
  }

  attributeChangedCallback(name: string, old: string | null, value: string | null): void {
    // Before the set-up there is nothing to change: it reads all attributes.
    if (this.#spec === undefined && !this.isConnected) return;
    if (name === 'name') {
      if (old === value) return;
      this.#life.suspend();
      this.#setUp();
      this.#life.restart();
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
    await this.#life.ensureInstance();
    this.#life.ask((widget) => widget.press(id));
    this.#sync();
    this.#controls?.showTimeline(this.timeline);
    this.#life.wake();
  }

  /** The latest result, once the widget has run. */
  get outcome(): Outcome | undefined {
    this.#lastOutcome = this.#life.ask((_, instance) => instance.outcome()) ?? this.#lastOutcome;
    return this.#lastOutcome;
  }

  /** The run that can be scrubbed, while the widget runs. */
  get timeline(): Timeline | null {
    return this.#life.ask((_, instance) => instance.timeline()) ?? null;
  }

  /** The text that stands for the picture. */
  get summary(): string {
    return this.#life.ask((widget) => widget.summary()) ?? this.#spec?.summary ?? '';
  }

  /** The state as the query of a link. */
  get query(): string {
    return this.#spec === undefined ? '' : writeQuery(this.#spec, this.#values);
  }

  /** Every plot and table as CSV. */
  async tables(): Promise<CsvFile[]> {
    await this.#life.ensureInstance();
    return this.#life.ask((_, instance) => instance.tables()) ?? [];
  }

  /** What the canvas shows, pixel by pixel; waits until the widget runs and draws. */
  snapshot(): Promise<ImageBitmap> {
    return new Promise((resolve) => {
      this.#wantPicture.push(resolve);
      this.#life.wake();
    });
  }

  /** `running` while it has a canvas. */
  get state(): 'running' | 'resting' {
    return this.#life.isRunning ? 'running' : 'resting';
  }

  /** Frames drawn since this instance started. */
  get frames(): number {
    return this.#life.ask((widget) => widget.frames()) ?? 0;
  }

  /** Whether something that drags lies there, in CSS pixels from the canvas's corner. */
  dragsAt(x: number, y: number): boolean {
    return this.#life.ask((widget) => widget.dragsAt(x, y)) ?? false;
  }

  /** Where a control lies on the canvas: left, top, width, height; null while it rests. */
  controlBox(id: string): [number, number, number, number] | null {
    const box = this.#life.ask((widget) => widget.controlBox(id));
    return box === undefined ? null : ([...box] as [number, number, number, number]);
  }

  /** Where a point of a panel lies on the canvas, in CSS pixels; null where it is not shown. */
  panelToScreen(panel: string, x: number, y: number): [number, number] | null {
    const at = this.#life.ask((widget) => widget.panelToScreen(panel, x, y));
    return at === undefined ? null : [at[0] ?? 0, at[1] ?? 0];
  }

  /** Panics in the widget on purpose, for tests of a page's recovery. */
  crashForTest(): void {
    this.#life.ask((widget) => widget.crashForTest());
  }

  /** Gives context and memory back; the values stay, and the picture shows them. */
  suspend(): void {
    this.#life.suspend();
  }

  // ---- setting up ---------------------------------------------------------------------------

  #setUp(): void {
    const parts = this.#parts;
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
      press: (id) => void this.press(id).catch((error: unknown) => this.#life.fail(error)),
      focus: (id) => this.#showFocus(id),
    });
    parts.bar.append(this.#controls.element, takeAwayBar(this, spec.id, parts.status));
    parts.frame.setAttribute('aria-label', `Widget ${spec.id.replace(/^w/, '')}: ${spec.title}`);
    parts.picture.alt = spec.summary;
    parts.summary.textContent = spec.summary;
    this.#showTheme();
    for (const param of spec.params) {
      const text = this.getAttribute(param.id);
      if (text !== null) this.#tryToSet(param.id, text);
    }
    if (this.hasAttribute('linked')) this.#readAddress(spec);
    this.#controls.show(this.#values);
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

  // ---- running ------------------------------------------------------------------------------

  #lifeHost(): LifeHost {
    const spec = (): WidgetSpec | undefined => this.#spec;
    return {
      get widget() {
        return spec();
      },
      prepare: (widget) => {
        for (const [id, text] of this.#values) widget.set(id, text);
        widget.setTheme(themeOf(this));
        widget.setReducedMotion(reducedMotion?.matches === true);
      },
      live: (milliseconds) => {
        this.#controls?.showTimeline(this.timeline);
        this.#lastOutcome = this.outcome;
        this.#emit('slam-ready', { value: this.value, ms: milliseconds });
      },
      drew: (canvas) => {
        for (const resolve of this.#wantPicture.splice(0)) {
          void createImageBitmap(canvas).then(resolve);
        }
        this.#sync();
      },
      leaving: () => this.#drawPicture(themeOf(this)),
      failed: (error) => this.#showFailure(error),
    };
  }

  /** Takes over what changed in the widget: pointer, playback, presets. */
  #sync(): void {
    const changes = this.#takeChanges();
    if (changes.length === 0) return;
    for (const [id, text] of changes) this.#values.set(id, text);
    this.#told(changes);
  }

  #takeChanges(): [string, string][] {
    return this.#life.ask((_, instance) => instance.takeChanges()) ?? [];
  }

  /** Tells controls and page of changes. */
  #told(changes: [string, string][]): void {
    this.#controls?.show(changes);
    this.#controls?.showTimeline(this.timeline);
    const outcome = this.outcome;
    for (const [parameter, text] of changes) {
      this.#emit('slam-change', { parameter, value: this.get(parameter), text, outcome });
    }
    clearTimeout(this.#resultTimer);
    this.#resultTimer = setTimeout(() => this.#settled(), SETTLED_MS);
  }

  #settled(): void {
    const { outcome } = this;
    this.#parts.summary.textContent = this.summary;
    if (outcome !== undefined) {
      this.#parts.live.textContent = outcome.sentence;
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
    if (this.#spec === undefined) this.#setUp();
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
    this.#life.ask((running) => running.set(id, parsed.text));
    const also = this.#takeChanges();
    for (const [other, text] of also) this.#values.set(other, text);
    this.#told([[id, parsed.text], ...also.filter(([other]) => other !== id)]);
    this.#life.wake();
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

  // ---- looks --------------------------------------------------------------------------------

  #showTheme(): void {
    const theme = themeOf(this);
    this.#parts.frame.classList.toggle('dark', theme === 'dark');
    this.#life.ask((widget) => widget.setTheme(theme));
    this.#life.wake();
    if (!this.#life.hasInstance) this.#showStaticPicture(theme);
  }

  #showMotion(): void {
    const reduced = reducedMotion?.matches === true;
    this.#life.ask((widget) => widget.setReducedMotion(reduced));
  }

  #showFocus(id: string | undefined): void {
    this.#life.ask((widget) => widget.setFocus(id));
    this.#life.wake();
    const box = id === undefined ? null : this.controlBox(id);
    const { stage, bar } = this.#parts;
    // The ring is on the canvas, not where the focus is.
    if (box !== null) reveal(stage, box, bar.offsetHeight);
  }

  /** The picture that the build drew: the state at the start. */
  #showStaticPicture(theme: Theme): void {
    const { picture } = this.#parts;
    if (this.#spec === undefined) return;
    // A picture of the state that the reader left is better.
    if (picture.src.startsWith('data:')) return;
    picture.src = new URL(`pictures/${this.#spec.id}-${theme}.svg`, import.meta.url).href;
  }

  /** The picture of the state of now, drawn by the widget itself. */
  #drawPicture(theme: Theme): void {
    const { picture } = this.#parts;
    const width = Math.max(this.clientWidth, 320);
    const svg = this.#life.ask((widget) => widget.picture(width, theme));
    if (svg === undefined) return;
    picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
    picture.alt = this.summary;
  }

  // ---- trouble ------------------------------------------------------------------------------

  #showFailure(error: unknown): void {
    const box = failureBox(error, () => {
      box.remove();
      this.#life.restart();
    });
    this.#parts.note.append(box);
    const message = error instanceof Error ? error.message : String(error);
    this.#emit('slam-error', { kind: error instanceof CrashError ? 'crash' : 'load', message });
  }

  /** Names something that was wrong with what came from outside; as text, never as HTML. */
  #tell(kind: string, message: string): void {
    const line = create('p');
    line.textContent = message;
    this.#parts.note.append(line);
    this.#emit('slam-error', { kind, message });
  }

  #emit(type: string, detail: Record<string, unknown>): void {
    const name = this.#spec?.id ?? this.getAttribute('name');
    this.dispatchEvent(
      new CustomEvent(type, { detail: { name, ...detail }, bubbles: true, composed: true }),
    );
  }
}
