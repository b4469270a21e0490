// The strip under the title: a replay of the canonical lap, which the core computed in the build.
//
// It plays once while it is in view, unless the reader prefers reduced motion. The slider sets the time at any moment.

import { canvasSurface, contextOf, type Inks, type Point, readInks, watchColors } from '../world/surfaces';
import { aspectAt, camera, draw, drawGrip, worldAt } from './drawing';
import { type Moment, Replay, type Story } from './story';

/** Step of the slider and of an arrow key. */
const STEP_S = 0.05;
/** Distance from the robot within which a press drags it. */
const GRAB_RADIUS_PX = 40;

export class LapPlayer {
  readonly #figure: HTMLElement;
  readonly #story: Story;
  readonly #replay: Replay;
  readonly #canvas = document.createElement('canvas');
  readonly #slider = document.createElement('input');
  readonly #button = document.createElement('button');
  /** The captions, which begin with the name of their act. */
  readonly #acts: HTMLElement[];
  #inks: Inks | undefined;
  #seconds = 0;
  /** The camera's closeness while the robot is dragged: it stays under the hand. */
  #heldCloseness: number | undefined;
  #wasDragged = false;
  #isPlaying = false;
  #isSeen = false;
  #lastFrame: number | undefined;
  #frame = 0;

  constructor(figure: HTMLElement, story: Story) {
    this.#figure = figure;
    this.#story = story;
    this.#replay = new Replay(story);
    this.#acts = [...figure.querySelectorAll<HTMLElement>('.lap-acts > li')];
    this.#addParts();
    this.#listen();
    const isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.#seconds = isStill ? this.#replay.doubledS : 0;
    this.#isPlaying = !isStill;
    this.#show();
  }

  #addParts(): void {
    const picture = this.#figure.querySelector('.lap-picture');
    this.#canvas.setAttribute('role', 'img');
    this.#canvas.setAttribute('aria-label', picture?.querySelector('img')?.alt ?? '');
    picture?.append(this.#canvas);
    this.#button.type = 'button';
    Object.assign(this.#slider, { type: 'range', min: '0', max: String(this.#replay.lengthS), step: String(STEP_S) });
    this.#slider.setAttribute('aria-label', 'Moment of the lap');
    const controls = document.createElement('div');
    controls.className = 'lap-controls';
    controls.append(this.#button, this.#slider);
    picture?.after(controls);
    this.#figure.classList.add('live');
  }

  #listen(): void {
    this.#button.addEventListener('click', () => (this.#isPlaying ? this.#stop() : this.#play()));
    this.#slider.addEventListener('input', () => {
      this.#isPlaying = false;
      this.#goTo(Number(this.#slider.value));
    });
    this.#acts.forEach((caption, act) => {
      const name = caption.querySelector('b');
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = name?.textContent ?? '';
      button.addEventListener('click', () => {
        this.#goTo(this.#replay.actsS[act] ?? 0);
        this.#play();
      });
      name?.replaceChildren(button);
    });
    this.#letDrag();
    new IntersectionObserver((entries) => {
      this.#isSeen = entries.at(-1)?.isIntersecting === true;
      this.#wake();
    }, { threshold: 0.3 }).observe(this.#canvas);
    new ResizeObserver(() => this.#paint()).observe(this.#canvas);
    const repaint = (): void => {
      this.#inks = undefined;
      this.#paint();
    };
    watchColors(repaint);
    document.addEventListener('visibilitychange', () => this.#wake());
  }

  /** The robot can be dragged along its path, out and on the way back. */
  #letDrag(): void {
    const canvas = this.#canvas;
    let ahead = 0;
    const isNear = ({ offsetX, offsetY }: PointerEvent): boolean => {
      const [x, y] = this.#robotPx();
      return Math.hypot(offsetX - x, offsetY - y) < GRAB_RADIUS_PX;
    };
    canvas.addEventListener('pointerdown', (event) => {
      if (event.button !== 0 || !isNear(event)) return;
      canvas.setPointerCapture(event.pointerId);
      this.#heldCloseness = this.#moment().closeness;
      this.#wasDragged = true;
      this.#stop();
      ahead = 1;
    });
    canvas.addEventListener('pointermove', (event) => {
      if (ahead === 0) {
        canvas.style.cursor = isNear(event) ? 'grab' : '';
        return;
      }
      // A busy browser joins moves; the robot follows each, or it would stay behind a fast hand.
      let at = this.#seconds;
      for (const { offsetX, offsetY } of movesOf(event)) {
        const pointer = worldAt([offsetX, offsetY], this.#moment().closeness, canvas.clientWidth);
        const next = this.#replay.nearest(pointer, at, ahead);
        if (next !== at) ahead = Math.sign(next - at);
        at = next;
      }
      this.#goTo(at);
    });
    for (const type of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(type, () => {
      ahead = 0;
      this.#heldCloseness = undefined;
      this.#paint();
    });
    // A touch on the robot drags it; elsewhere it scrolls the page.
    canvas.addEventListener('touchstart', (event) => { if (ahead !== 0) event.preventDefault(); }, { passive: false });
  }

  /** What is shown. */
  #moment(): Moment {
    const moment = this.#replay.at(this.#seconds);
    return { ...moment, closeness: this.#heldCloseness ?? moment.closeness };
  }

  #robotPx(): Point {
    const { robot, closeness } = this.#moment();
    return camera(closeness, this.#canvas.clientWidth)([robot[0], robot[1]]);
  }

  #play(): void {
    if (this.#seconds >= this.#replay.lengthS) this.#seconds = 0;
    this.#isPlaying = true;
    this.#show();
    this.#wake();
  }

  #stop(): void {
    this.#isPlaying = false;
    this.#show();
  }

  #goTo(seconds: number): void {
    this.#seconds = seconds;
    this.#show();
  }

  /** Requests a frame if the replay plays in view. */
  #wake(): void {
    if (!this.#isPlaying || !this.#isSeen || document.hidden || this.#frame !== 0) return;
    this.#lastFrame = undefined;
    this.#frame = requestAnimationFrame((now) => this.#next(now));
  }

  #next(now: number): void {
    this.#frame = 0;
    if (!this.#isPlaying || !this.#isSeen || document.hidden) return;
    // The first frame after a pause only starts the clock.
    const elapsedS = this.#lastFrame === undefined ? 0 : (now - this.#lastFrame) / 1000;
    this.#lastFrame = now;
    this.#seconds = Math.min(this.#seconds + elapsedS, this.#replay.lengthS);
    if (this.#seconds === this.#replay.lengthS) this.#isPlaying = false;
    else this.#frame = requestAnimationFrame((next) => this.#next(next));
    this.#show();
  }

  #show(): void {
    const { act, tick } = this.#replay.at(this.#seconds);
    const isOver = this.#seconds >= this.#replay.lengthS;
    this.#slider.value = String(this.#seconds);
    this.#slider.setAttribute('aria-valuetext', `${nameOf(this.#acts[act])}, tick ${tick}`);
    const does = this.#isPlaying ? 'Pause' : isOver ? 'Play again' : 'Play';
    if (this.#button.textContent !== does) this.#button.textContent = does;
    this.#figure.dataset['tick'] = String(tick);
    this.#acts.forEach((caption, number) => {
      if (number === act) caption.setAttribute('aria-current', 'step');
      else caption.removeAttribute('aria-current');
    });
    this.#paint();
  }

  #paint(): void {
    const width = this.#canvas.clientWidth;
    const context = contextOf(this.#canvas, width / aspectAt(width));
    if (context === undefined) return;
    this.#inks ??= readInks(this.#figure);
    const [moment, surface] = [this.#moment(), canvasSurface(context, this.#inks)];
    draw(this.#story, moment, surface, width);
    if (this.#heldCloseness === undefined) drawGrip(moment, surface, width, this.#isPlaying || this.#wasDragged ? '' : 'drag me');
  }
}

function nameOf(act: HTMLElement | undefined): string {
  return act?.querySelector('b')?.textContent?.replace(/\.$/, '') ?? '';
}

/** The moves that an event stands for. Safari before 18.2 does not tell them. */
function movesOf(event: PointerEvent): PointerEvent[] {
  const moves = 'getCoalescedEvents' in event ? event.getCoalescedEvents() : [];
  return moves.length > 0 ? moves : [event];
}
