// Decides who gets a touch that starts on something draggable: a vertical swipe scrolls the page; a
// horizontal swipe, a tap, and a finger that rests for a moment belong to the widget. Two fingers zoom a
// full-size map, wherever they start, and drag nothing.

/** Largest movement of a finger that rests. */
const SLACK_PX = 6;
/** Time for which a finger rests before a vertical drag. */
const HOLD_MS = 220;

/** Far outside, where a press has no effect. */
const NOWHERE_PX = -1e4;
/** A pointer id that no browser uses. */
const NO_FINGER = 1e6;

interface Held {
  touch: Touch;
  timer: ReturnType<typeof setTimeout>;
}

/** The touched widget. */
export interface Touched {
  /** Whether something draggable is at that position, in CSS pixels from the canvas's corner. */
  dragsAt(x: number, y: number): boolean;
  /** Ends the drag. */
  letGo(): void;
}

export class TouchGate {
  readonly #canvas: HTMLCanvasElement;
  readonly #widget: Touched;
  /** Whether two fingers belong to the widget. */
  readonly #isPinched: boolean;
  #held: Held | undefined;
  /** The owner of the touch until its end. */
  #owner: 'page' | 'widget' | undefined;

  constructor(stage: HTMLElement, canvas: HTMLCanvasElement, widget: Touched, signal: AbortSignal) {
    this.#canvas = canvas;
    this.#widget = widget;
    this.#isPinched = stage.closest('.takes-files') !== null;
    const early = { capture: true, passive: true, signal };
    stage.addEventListener('pointerdown', (event) => this.#press(event), early);
    stage.addEventListener('touchstart', (event) => this.#start(event), early);
    // Not passive: a browser scrolls unless the first reported move is cancelled.
    stage.addEventListener('touchmove', (event) => this.#move(event), { capture: true, passive: false, signal });
    stage.addEventListener('touchend', (event) => this.#end(event), early);
    stage.addEventListener('touchcancel', () => this.#forget(), early);
    signal.addEventListener('abort', () => this.#forget());
  }

  /** It comes before the touch itself. */
  #press(event: PointerEvent): void {
    if (!event.isTrusted || event.pointerType !== 'touch' || event.target !== this.#canvas) return;
    if (this.#isHandle(event)) event.stopPropagation();
  }

  #isHandle({ clientX, clientY }: Touch | PointerEvent): boolean {
    const { left, top } = this.#canvas.getBoundingClientRect();
    return this.#widget.dragsAt(clientX - left, clientY - top);
  }

  #start(event: TouchEvent): void {
    const [touch] = event.changedTouches;
    // One of our own events.
    if (!event.isTrusted || touch === undefined || event.target !== this.#canvas) return;
    if (event.touches.length > 1) {
      this.#pinch(event, touch);
      return;
    }
    this.#owner = undefined;
    if (!this.#isHandle(touch)) return;
    event.stopPropagation();
    this.#held = { touch, timer: setTimeout(() => this.#sendOn(), HOLD_MS) };
  }

  /** A second finger ends the drag of the first one, and cancels a pending one. */
  #pinch(event: TouchEvent, second: Touch): void {
    const first = this.#held?.touch;
    const isOurs = this.#isPinched && this.#owner !== 'page' && event.touches.length === 2;
    this.#forget();
    this.#owner = isOurs ? 'widget' : undefined;
    if (!isOurs) return;
    event.stopPropagation();
    if (first === undefined) this.#widget.letGo();
    // eframe presses at the position of the finger that it follows. If a finger of that number is down, it
    // follows the same one as before, so it first gets one far outside.
    const nowhere = new Touch({
      identifier: NO_FINGER,
      target: this.#canvas,
      clientX: NOWHERE_PX,
      clientY: NOWHERE_PX,
    });
    for (const changedTouches of [[], first === undefined ? [second] : [first, second]]) {
      const options = { touches: [nowhere], changedTouches, bubbles: true, cancelable: true };
      this.#canvas.dispatchEvent(new TouchEvent('touchstart', options));
    }
  }

  #move(event: TouchEvent): void {
    const [touch] = event.changedTouches;
    if (this.#held !== undefined && touch !== undefined) this.#decide(this.#held.touch, touch);
    if (this.#owner !== 'widget') {
      if (this.#owner === 'page' || this.#held !== undefined) event.stopPropagation();
    } else if (event.cancelable) {
      event.preventDefault();
    }
  }

  #decide(from: Touch, to: Touch): void {
    const across = Math.abs(to.clientX - from.clientX);
    const along = Math.abs(to.clientY - from.clientY);
    if (Math.max(across, along) <= SLACK_PX) return;
    if (along <= across) {
      this.#sendOn();
    } else {
      this.#forget();
      this.#owner = 'page';
    }
  }

  #end(event: TouchEvent): void {
    if (this.#owner === 'page') event.stopPropagation();
    // Neither movement nor a rest: it was a tap.
    this.#sendOn();
    this.#owner = undefined;
  }

  /** Passes the touch to the widget as if it had just begun. */
  #sendOn(): void {
    const held = this.#held;
    if (held === undefined) return;
    this.#forget();
    this.#owner = 'widget';
    const touches = [held.touch];
    const { clientX, clientY } = held.touch;
    // eframe runs at once on this event: a press and the next event are never in the same frame.
    this.#canvas.dispatchEvent(
      new PointerEvent('pointerdown', { pointerType: 'touch', clientX, clientY, buttons: 1, bubbles: true }),
    );
    const options = { touches, targetTouches: touches, changedTouches: touches, bubbles: true, cancelable: true };
    this.#canvas.dispatchEvent(new TouchEvent('touchstart', options));
  }

  #forget(): void {
    clearTimeout(this.#held?.timer);
    this.#held = undefined;
  }
}
