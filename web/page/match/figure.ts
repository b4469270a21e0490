// The matcher: the reader aligns one sweep with another, and ICP refines the pose. Who wins enters the next room.

import type { Glue } from '../../pkg/glue.js';
import { between } from '../lap/story';
import type { Point, Pose } from '../world/surfaces';
import { pngOfSvg, send } from '../../ts/export';
import { type Answer, pairLines, placedAt, ROOMS, type Scene, startOf, sweeps, viewBox } from './drawing';
import { recordOf } from './record';

/** The output of the module's `PageMatcher.run`. */
interface Run {
  /** The initial guess and the pose after each iteration. */
  poses: Pose[];
  rmse: number;
  /** Pairing distance, m. */
  reach: number;
  ending: string;
}

type Matcher = InstanceType<Glue['PageMatcher']>;

/** Steps of an arrow key: translation, and rotation with Shift. */
const KEY_M = 0.05;
const KEY_RAD = (2 * Math.PI) / 180;
/** Duration of an iteration in the animation. */
const ITERATION_MS = 110;
/** The parameter of the page's address that opens a room. */
const ROOM_PARAM = 'room';
/** Pixels per metre of a sent picture. */
const SENT_PX_PER_M = 100;
const UNREACHABLE = 'ICP could not be fetched. Try again once there is a connection.';
const ARROWS: Record<string, Point> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class MatchFigure {
  readonly #figure: HTMLElement;
  readonly #core: () => Promise<Glue>;
  readonly #svg: SVGSVGElement;
  /** World positions of the pressed pointers. */
  readonly #pointers = new Map<number, Point>();
  /** Whether the first pointer grabbed the ring. */
  #turns = false;
  #room = ROOMS[0];
  #scene: Answer;
  #pose: Pose;
  /** When the reader first acted in the room; starts the clock. */
  #begun: number | undefined;
  #loading: Promise<[Matcher, Scene]> | undefined;
  /** Increases with every action of the reader: an outdated run of ICP stops. */
  #generation = 0;

  constructor(figure: HTMLElement, scene: Answer, core: () => Promise<Glue>) {
    this.#figure = figure;
    this.#scene = scene;
    this.#core = core;
    this.#svg = figure.querySelector('svg') as SVGSVGElement;
    this.#pose = startOf(scene, this.#room);
    this.#svg.tabIndex = 0;
    this.#listen();
    this.#show();
    figure.classList.add('live');
    const room = ROOMS.find(({ name }) => name === new URLSearchParams(location.search).get(ROOM_PARAM));
    if (room !== undefined && room !== ROOMS[0]) void this.#enter(room);
  }

  #listen(): void {
    const svg = this.#svg;
    svg.addEventListener('pointerdown', (event) => this.#grab(event));
    // Chromium scrolls by a touch on a part of a drawing, whatever its `touch-action`.
    svg.addEventListener('touchstart', (event) => {
      if ((event.target as Element).closest('[data-grab]') !== null) event.preventDefault();
    }, { passive: false });
    svg.addEventListener('pointermove', (event) => this.#drag(event));
    for (const type of ['pointerup', 'pointercancel'] as const) {
      svg.addEventListener(type, (event) => {
        if (this.#pointers.delete(event.pointerId) && this.#pointers.size === 0) this.#announcePose();
      });
    }
    svg.addEventListener('keydown', (event) => {
      svg.classList.remove('held');
      this.#press(event);
    });
    svg.addEventListener('blur', () => svg.classList.remove('held'));
    const presses = {
      icp: () => void this.#runIcp(),
      quarter: () => {
        const [x, y, heading] = this.#scene.truth;
        this.#place([x, y, heading + Math.PI / 2]);
        void this.#runIcp();
      },
      again: () => {
        this.#place(startOf(this.#scene, this.#room));
        this.#begun = undefined;
        this.#announcePose();
      },
      next: () => void this.#enter(ROOMS[(ROOMS.indexOf(this.#room) + 1) % ROOMS.length] ?? ROOMS[0]),
      send: () => {
        this.#sent().then((said) => this.#announce(said), (error: Error) => this.#announce(`Send failed: ${error.message}.`));
      },
    };
    for (const [name, press] of Object.entries(presses)) {
      const button = this.#figure.querySelector<HTMLButtonElement>(`[data-match="${name}"]`);
      button?.addEventListener('click', press);
      button?.removeAttribute('disabled');
    }
  }

  #grab(event: PointerEvent): void {
    const grab = (event.target as Element).closest<SVGElement>('[data-grab]');
    if (grab === null || event.button !== 0) return;
    event.preventDefault();
    // Browsers show the ring of a focus that a script sets: it is for the keyboard.
    this.#svg.classList.add('held');
    this.#svg.focus({ preventScroll: true });
    this.#svg.setPointerCapture(event.pointerId);
    if (this.#pointers.size === 0) this.#turns = grab.dataset['grab'] === 'turn';
    this.#pointers.set(event.pointerId, this.#worldAt(event));
    this.#place(this.#pose);
    // Prefetches the core, which is needed when the reader lets go.
    void this.#loaded().catch(() => {});
  }

  #drag(event: PointerEvent): void {
    const before = this.#pointers.get(event.pointerId);
    if (before === undefined) return;
    const now = this.#worldAt(event);
    this.#pointers.set(event.pointerId, now);
    const other = [...this.#pointers].find(([id]) => id !== event.pointerId)?.[1];
    const [x, y] = this.#pose;
    if (other !== undefined) this.#place(this.#turned(other, turnBetween(other, before, now)));
    else if (this.#turns) this.#place(this.#turned([x, y], turnBetween([x, y], before, now)));
    else this.#place(this.#moved([now[0] - before[0], now[1] - before[1]]));
  }

  #press(event: KeyboardEvent): void {
    const way = ARROWS[event.key];
    if (way === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    const [x, y] = this.#pose;
    // Right and down turn clockwise.
    if (event.shiftKey) this.#place(this.#turned([x, y], KEY_RAD * (way[1] - way[0])));
    else this.#place(this.#moved([KEY_M * way[0], KEY_M * way[1]]));
    this.#announcePose();
  }

  #worldAt({ clientX, clientY }: PointerEvent): Point {
    const { x, y } = new DOMPoint(clientX, clientY).matrixTransform(this.#svg.getScreenCTM()?.inverse());
    return [x, -y];
  }

  #moved([dx, dy]: Point): Pose {
    const [x, y, heading] = this.#pose;
    return [x + dx, y + dy, heading];
  }

  #turned([aboutX, aboutY]: Point, angle: number): Pose {
    const [x, y, heading] = this.#pose;
    const [dx, dy] = [x - aboutX, y - aboutY];
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    return [aboutX + cos * dx - sin * dy, aboutY + sin * dx + cos * dy, heading + angle];
  }

  /** Sets the pose by hand. */
  #place(pose: Pose): void {
    this.#generation += 1;
    this.#begun ??= performance.now();
    this.#pose = pose;
    this.#showGhost(undefined);
    this.#showPairs();
    this.#showWon(false);
    this.#show();
  }

  /** Replaces the sweeps by those of another room. */
  async #enter(room: (typeof ROOMS)[number]): Promise<void> {
    const before = this.#room;
    this.#generation += 1;
    const generation = this.#generation;
    this.#room = room;
    this.#loading = undefined;
    const scene = (await this.#loaded().catch(() => undefined))?.[1];
    if (generation !== this.#generation) return;
    if (scene === undefined) {
      this.#room = before;
      this.#announce(UNREACHABLE);
      return;
    }
    this.#scene = scene;
    this.#svg.innerHTML = sweeps(scene, room);
    this.#svg.setAttribute('viewBox', viewBox(room));
    this.#figure.dataset['room'] = room.name;
    this.#place(startOf(scene, room));
    this.#begun = undefined;
    this.#announce(`${room.hint} Lay one sweep on the other.`);
  }

  /** Sends the picture with a link that opens the room. */
  async #sent(): Promise<string> {
    const link = new URL(location.href);
    link.search = this.#room === ROOMS[0] ? '' : `?${ROOM_PARAM}=${this.#room.name}`;
    link.hash = this.#figure.id;
    const side = this.#room.view[2] * SENT_PX_PER_M;
    return send(await pngOfSvg(this.#still(side), { width: side, height: side }, 'my-match'), link.href);
  }

  /** The SVG with its present looks: a file has no style sheet of the page. */
  #still(side: number): string {
    const still = this.#svg.cloneNode(true) as SVGSVGElement;
    const shown = this.#svg.querySelectorAll('*');
    for (const [at, part] of still.querySelectorAll('*').entries()) {
      const { fill, stroke, strokeWidth, strokeLinecap, opacity, stopColor } = getComputedStyle(shown[at] as Element);
      Object.assign((part as SVGElement).style, { fill, stroke, strokeWidth, strokeLinecap, opacity, stopColor });
    }
    still.style.background = getComputedStyle(document.body).backgroundColor;
    for (const [name, value] of Object.entries({ xmlns: 'http://www.w3.org/2000/svg', width: side, height: side })) {
      still.setAttribute(name, `${value}`);
    }
    return still.outerHTML;
  }

  async #runIcp(): Promise<void> {
    this.#generation += 1;
    const generation = this.#generation;
    const from = this.#pose;
    this.#begun ??= performance.now();
    const seconds = Math.max(1, Math.round((performance.now() - this.#begun) / 1000));
    this.#announce('ICP is running.');
    const loaded = await this.#loaded().catch(() => undefined);
    if (generation !== this.#generation) return;
    if (loaded === undefined) {
      this.#announce(UNREACHABLE);
      return;
    }
    const [matcher, scene] = loaded;
    const run = JSON.parse(matcher.run(...from)) as Run;
    this.#showGhost(from);
    const isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (!isStill) await this.#play(run.poses, generation);
    if (generation !== this.#generation) return;
    this.#pose = run.poses.at(-1) ?? from;
    this.#show();
    this.#showPairs(pairLines(scene, this.#pose, run.reach));
    const isWon = run.ending === 'right minimum';
    this.#showWon(isWon);
    this.#announce(isWon ? this.#summaryOfWin(run, seconds) : this.#summary(run));
  }

  /** Animates the iterations until the reader intervenes. */
  #play(poses: readonly Pose[], generation: number): Promise<void> {
    return new Promise((end) => {
      let first: number | undefined;
      const next = (now: number): void => {
        first ??= now;
        const at = (now - first) / ITERATION_MS;
        const [before, after] = [poses[Math.floor(at)], poses[Math.floor(at) + 1]];
        if (generation !== this.#generation || before === undefined || after === undefined) {
          end();
          return;
        }
        this.#pose = between(before, after, at % 1);
        this.#show();
        this.#readout(`step ${Math.floor(at) + 1}`);
        requestAnimationFrame(next);
      };
      requestAnimationFrame(next);
    });
  }

  /** Fetches the core on the reader's first action; a failure can be retried. */
  #loaded(): Promise<[Matcher, Scene]> {
    const { name } = this.#room;
    this.#loading ??= this.#core().then((glue) => {
      const matcher = new glue.PageMatcher(name);
      return [matcher, JSON.parse(matcher.scene()) as Scene];
    });
    this.#loading.catch(() => { this.#loading = undefined; });
    return this.#loading;
  }

  #show(): void {
    for (const part of this.#svg.querySelectorAll('.match-moved')) part.setAttribute('transform', placedAt(this.#pose));
    this.#figure.classList.toggle('home', this.#isHome());
    this.#readout('');
  }

  /** Shows the pose from which ICP started. */
  #showGhost(pose: Pose | undefined): void {
    const ghost = this.#svg.querySelector('.match-left');
    ghost?.setAttribute('visibility', pose === undefined ? 'hidden' : 'visible');
    if (pose !== undefined) ghost?.setAttribute('transform', placedAt(pose));
  }

  #showPairs({ lines, threads } = { lines: '', threads: '' }): void {
    this.#svg.querySelector('.match-pairs')?.setAttribute('d', lines);
    const drawn = this.#svg.querySelector('.match-threads');
    if (drawn !== null) drawn.innerHTML = threads;
  }

  /** Offers the next room in place of ICP, and the way back when the reader moves the sweep again. */
  #showWon(isWon: boolean): void {
    const shown = { icp: !isWon, quarter: !isWon && this.#room === ROOMS[0], next: isWon, send: isWon };
    const hadFocus = document.activeElement instanceof HTMLElement && document.activeElement.dataset['match'] === 'icp';
    for (const [name, isShown] of Object.entries(shown)) {
      const button = this.#figure.querySelector<HTMLButtonElement>(`[data-match="${name}"]`);
      if (button !== null) button.hidden = !isShown;
    }
    if (isWon && hadFocus) this.#figure.querySelector<HTMLButtonElement>('[data-match="next"]')?.focus({ preventScroll: true });
  }

  #error(): { metres: number; degrees: number } {
    const [x, y, heading] = this.#pose;
    const [trueX, trueY, trueHeading] = this.#scene.truth;
    return { metres: Math.hypot(x - trueX, y - trueY), degrees: Math.abs(wrapped(heading - trueHeading)) * (180 / Math.PI) };
  }

  #isHome(): boolean {
    const { metres, degrees } = this.#error();
    return metres < this.#scene.home[0] && degrees <= this.#scene.home[1];
  }

  #readout(step: string): void {
    const { metres, degrees } = this.#error();
    this.#write('.match-cm', `${Math.round(100 * metres)} cm`);
    this.#write('.match-degrees', `${degrees.toFixed(degrees < 10 ? 1 : 0)}°`);
    this.#write('.match-step', step === '' ? 'off the truth' : step);
  }

  #announcePose(): void {
    const hint = this.#isHome() ? 'That is the right place: the walls are sharp. Can ICP do better?' : 'Closer, or let ICP take over.';
    this.#announce(`By hand: ${this.#errorText()} off. ${hint}`);
  }

  #summaryOfWin({ poses }: Run, seconds: number): string {
    const cm = Math.round(100 * this.#error().metres);
    const best = recordOf(this.#room.name, { seconds, cm });
    return `ICP found the right place in ${counted(poses.length - 1)}: ${this.#errorText()} off, after ${seconds} s. Your record: ${best.cm} cm, ${best.seconds} s.`;
  }

  #summary({ poses, rmse, ending }: Run): string {
    const off = `${this.#errorText()} off`;
    const fit = `Its pairs are ${Math.round(100 * rmse)} cm apart`;
    if (this.#room === ROOMS[0] && (ending === 'quarter turn' || ending === 'half turn')) {
      return `ICP stopped a ${ending} out, ${off}. ${fit}. The room is nearly square, so the place looks right at first; the pairs show that it is not.`;
    }
    return `ICP stopped after ${counted(poses.length - 1)} in the wrong place, ${off}. ${fit}. Move it closer, and let it try again.`;
  }

  #errorText(): string {
    const { metres, degrees } = this.#error();
    return `${Math.round(100 * metres)} cm and ${degrees.toFixed(degrees < 10 ? 1 : 0)}°`;
  }

  #announce(sentence: string): void {
    this.#write('#match-says', sentence);
  }

  #write(selector: string, text: string): void {
    const element = this.#figure.querySelector(selector);
    if (element !== null && element.textContent !== text) element.textContent = text;
  }
}

function counted(steps: number): string {
  return `${steps} ${steps === 1 ? 'step' : 'steps'}`;
}

/** The angle of a movement about a centre. */
function turnBetween([x, y]: Point, before: Point, now: Point): number {
  return wrapped(Math.atan2(now[1] - y, now[0] - x) - Math.atan2(before[1] - y, before[0] - x));
}

function wrapped(angle: number): number {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}
