// The first figure of the page: the reader aligns one sweep with another, and ICP refines the pose.

import type { Glue } from '../../pkg/glue.js';
import { type Point, type Pose, between } from '../lap/story';
import { type Answer, placedAt, startOf } from './drawing';

/** The output of the module's `Matcher.run`. */
interface Run {
  /** The initial guess and the pose after each iteration. */
  poses: Pose[];
  rmse: number;
  ending: string;
}

type Matcher = InstanceType<Glue['Matcher']>;

/** Steps of an arrow key: translation, and rotation with Shift. */
const KEY_M = 0.05;
const KEY_RAD = (2 * Math.PI) / 180;
/** Duration of an iteration in the animation. */
const ITERATION_MS = 110;
const ARROWS: Record<string, Point> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class MatchFigure {
  readonly #figure: HTMLElement;
  readonly #scene: Answer;
  readonly #core: () => Promise<Glue>;
  readonly #svg: SVGSVGElement;
  /** World positions of the pressed pointers. */
  readonly #pointers = new Map<number, Point>();
  /** Whether the first pointer grabbed the ring. */
  #turns = false;
  #pose: Pose;
  #matcher: Promise<Matcher> | undefined;
  /** Increases with every action of the reader: an outdated run of ICP stops. */
  #generation = 0;

  constructor(figure: HTMLElement, scene: Answer, core: () => Promise<Glue>) {
    this.#figure = figure;
    this.#scene = scene;
    this.#core = core;
    this.#svg = figure.querySelector('svg') as SVGSVGElement;
    this.#pose = startOf(scene);
    this.#svg.tabIndex = 0;
    this.#listen();
    this.#show();
    figure.classList.add('live');
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
    svg.addEventListener('keydown', (event) => this.#press(event));
    const presses = {
      icp: () => void this.#runIcp(),
      quarter: () => {
        const [x, y, heading] = this.#scene.truth;
        this.#place([x, y, heading + Math.PI / 2]);
        void this.#runIcp();
      },
      again: () => {
        this.#place(startOf(this.#scene));
        this.#announcePose();
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
    this.#pose = pose;
    this.#showGhost(undefined);
    this.#show();
  }

  async #runIcp(): Promise<void> {
    this.#generation += 1;
    const generation = this.#generation;
    const from = this.#pose;
    this.#announce('ICP is running.');
    const matcher = await this.#loaded().catch(() => undefined);
    if (generation !== this.#generation) return;
    if (matcher === undefined) {
      this.#announce('ICP could not be fetched. Try again once there is a connection.');
      return;
    }
    const run = JSON.parse(matcher.run(...from)) as Run;
    this.#showGhost(from);
    const isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (!isStill) await this.#play(run.poses, generation);
    if (generation !== this.#generation) return;
    this.#pose = run.poses.at(-1) ?? from;
    this.#show();
    this.#announce(this.#summary(run));
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
  #loaded(): Promise<Matcher> {
    this.#matcher ??= this.#core().then((glue) => new glue.Matcher());
    this.#matcher.catch(() => { this.#matcher = undefined; });
    return this.#matcher;
  }

  #show(): void {
    this.#svg.querySelector('.match-moved')?.setAttribute('transform', placedAt(this.#pose));
    this.#figure.classList.toggle('home', this.#isHome());
    this.#readout('');
  }

  /** Shows the pose from which ICP started. */
  #showGhost(pose: Pose | undefined): void {
    const ghost = this.#svg.querySelector('.match-left');
    ghost?.setAttribute('visibility', pose === undefined ? 'hidden' : 'visible');
    if (pose !== undefined) ghost?.setAttribute('transform', placedAt(pose));
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
    const hint = this.#isHome() ? 'That is home: the walls are sharp. Can ICP do better?' : 'Nearer, or let ICP take over.';
    this.#announce(`By hand: ${this.#errorText()} off. ${hint}`);
  }

  #summary({ poses, rmse, ending }: Run): string {
    const steps = poses.length - 1;
    const by = `${steps} ${steps === 1 ? 'step' : 'steps'}`;
    const off = `${this.#errorText()} off`;
    if (ending === 'right minimum') return `ICP came home in ${by}: ${off}.`;
    const fit = `Its pairs are ${Math.round(100 * rmse)} cm apart`;
    if (ending === 'quarter turn' || ending === 'half turn') {
      return `ICP stopped a ${ending} wrong, ${off}. ${fit}: the room is nearly square, so a wrong turn looks right, to you and to ICP.`;
    }
    return `ICP stopped after ${by} in a wrong place, ${off}. ${fit}. Lay it nearer, and let it try again.`;
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

/** The angle of a movement about a centre. */
function turnBetween([x, y]: Point, before: Point, now: Point): number {
  return wrapped(Math.atan2(now[1] - y, now[0] - x) - Math.atan2(before[1] - y, before[0] - x));
}

function wrapped(angle: number): number {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}
