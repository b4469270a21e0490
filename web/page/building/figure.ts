// The first figure of own-robot.html: odometry's scribble becomes a map. The hidden widget below takes its place once the
// reader drops or picks a log, or maps the sample.

import { chooseFiles, acceptDrops } from '../../ts/robot/files';
import { canvasSurface, contextOf, readInks, watchColors } from '../world/surfaces';
import { type Building, draw, LOOPS, formatError } from './drawing';

/** Keyframes of the replay, as time and slider value: first the map comes apart. */
const REPLAY: [number, number][] = [[0, 2], [0.9, 0], [2, 0], [4.4, 1], [5.4, 1], [7.4, 2]];

interface Mapper extends HTMLElement {
  openFile(files: readonly File[]): void;
  press(button: string): Promise<void>;
}

export class BuildingFigure {
  readonly #figure: HTMLElement;
  readonly #story: Building;
  readonly #canvas = document.createElement('canvas');
  readonly #slider: HTMLInputElement;
  readonly #play: HTMLButtonElement;
  #at = LOOPS;
  #startedMs: number | undefined;
  #frame = 0;

  constructor(figure: HTMLElement, story: Building) {
    this.#figure = figure;
    this.#story = story;
    this.#slider = figure.querySelector('input') as HTMLInputElement;
    this.#play = figure.querySelector('[data-building="play"]') as HTMLButtonElement;
    const picture = figure.querySelector('.building-picture') as HTMLElement;
    this.#canvas.setAttribute('role', 'img');
    this.#canvas.setAttribute('aria-label', picture.querySelector('img')?.alt ?? '');
    picture.prepend(this.#canvas);
    figure.classList.add('live');
    this.#slider.addEventListener('input', () => {
      this.#startedMs = undefined;
      this.#show(Number(this.#slider.value));
    });
    this.#play.addEventListener('click', () => {
      if (this.#startedMs === undefined) this.#start();
      else this.#startedMs = undefined;
      this.#show(this.#at);
    });
    new ResizeObserver(() => this.#paint()).observe(this.#canvas);
    watchColors(() => this.#paint());
    this.#takeLogs(picture);
    this.#show(LOOPS);
    if (!matchMedia('(prefers-reduced-motion: reduce)').matches) this.#startWhenSeen();
  }

  #startWhenSeen(): void {
    const observer = new IntersectionObserver((entries) => {
      if (entries.at(-1)?.isIntersecting !== true) return;
      observer.disconnect();
      this.#start();
    }, { threshold: 0.3 });
    observer.observe(this.#canvas);
  }

  #takeLogs(picture: HTMLElement): void {
    const widget = document.querySelector<Mapper>('slam-widget[name="w16.10"]');
    const change = (open: (widget: Mapper) => void): void => {
      if (widget === null) return;
      this.#startedMs = undefined;
      widget.hidden = false;
      open(widget);
      widget.scrollIntoView();
    };
    const take = (files: File[]): void => change((mapper) => mapper.openFile(files));
    acceptDrops(picture, take);
    const choose = this.#figure.querySelector('[data-building="open"]');
    choose?.addEventListener('click', () => chooseFiles(picture, { label: 'A log of your robot', several: true }, take));
    const sample = this.#figure.querySelector('[data-building="sample"]');
    sample?.addEventListener('click', () => change((mapper) => void mapper.press('sample')));
    const connect = this.#figure.querySelector('[data-building="connect"]');
    connect?.addEventListener('click', () => change(askForAddress));
  }

  #start(): void {
    this.#startedMs = performance.now();
    this.#wake();
  }

  #wake(): void {
    if (this.#frame === 0) this.#frame = requestAnimationFrame((now) => this.#next(now));
  }

  #next(now: number): void {
    this.#frame = 0;
    if (this.#startedMs === undefined) return;
    const seconds = Math.max(now - this.#startedMs, 0) / 1000;
    const next = REPLAY.findIndex(([at]) => at > seconds);
    if (next === -1) this.#startedMs = undefined;
    else this.#wake();
    const [[from, there], [to, goal]] = [REPLAY[next - 1] ?? [0, LOOPS], REPLAY[next] ?? [1, LOOPS]];
    const share = next === -1 ? 1 : (seconds - from) / (to - from);
    this.#show(there + share * share * (3 - 2 * share) * (goal - there));
  }

  #show(at: number): void {
    this.#at = at;
    this.#slider.value = String(at);
    const says = wordsAt(this.#story, at);
    this.#slider.setAttribute('aria-valuetext', says);
    (this.#figure.querySelector('.building-says') as HTMLElement).textContent = says;
    this.#play.textContent = this.#startedMs === undefined ? 'Play' : 'Pause';
    this.#paint();
  }

  #paint(): void {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    const context = contextOf(this.#canvas, height);
    if (context !== undefined) draw(this.#story, this.#at, canvasSurface(context, readInks(this.#figure)), width, height);
  }
}

function askForAddress({ shadowRoot }: Mapper): void {
  shadowRoot?.querySelector('.connection details')?.setAttribute('open', '');
  shadowRoot?.querySelector<HTMLInputElement>('.connection input')?.focus();
}

/** Describes the estimate; between two of them the error is unknown. */
export function wordsAt({ worst_cm: [wheels, walls, loops] }: Building, at: number): string {
  if (at === 0) return `With the wheels alone: up to ${formatError(wheels)} out.`;
  if (at === 1) return `Each scan aligned with the walls before it: up to ${formatError(walls)} out.`;
  if (at === LOOPS) return `Places recognized, loops closed: up to ${formatError(loops)} out.`;
  return at < 1 ? 'From the wheels to the walls …' : 'From the walls to the loops …';
}
