// Whose a touch is that starts on something that drags: a swipe up or down is the page's, which
// scrolls; a swipe across, a tap, and a finger that stays for a moment are the widget's.

/** A finger that lies still moves by less. */
const SLACK_PX = 6;
/** So long a finger stays that means to drag upwards or downwards. */
const HOLD_MS = 220;

interface Held {
  touch: Touch;
  timer: ReturnType<typeof setTimeout>;
}

export class TouchGate {
  readonly #canvas: HTMLCanvasElement;
  readonly #dragsAt: (x: number, y: number) => boolean;
  #held: Held | undefined;
  /** Who has the touch until its end. */
  #owner: 'page' | 'widget' | undefined;

  constructor(
    stage: HTMLElement,
    canvas: HTMLCanvasElement,
    dragsAt: (x: number, y: number) => boolean,
    signal: AbortSignal,
  ) {
    this.#canvas = canvas;
    this.#dragsAt = dragsAt;
    const early = { capture: true, passive: true, signal };
    stage.addEventListener('pointerdown', (event) => this.#press(event), early);
    stage.addEventListener('touchstart', (event) => this.#start(event), early);
    // Not passive: a browser scrolls unless it is told not to at the first move that it tells of.
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
    return this.#dragsAt(clientX - left, clientY - top);
  }

  #start(event: TouchEvent): void {
    const [touch] = event.changedTouches;
    // One of ours, sent on.
    if (!event.isTrusted || touch === undefined || event.target !== this.#canvas) return;
    this.#owner = undefined;
    if (event.touches.length > 1) {
      this.#forget();
      return;
    }
    if (!this.#isHandle(touch)) return;
    event.stopPropagation();
    this.#held = { touch, timer: setTimeout(() => this.#sendOn(), HOLD_MS) };
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
    // What neither moved nor stayed was a tap.
    this.#sendOn();
    this.#owner = undefined;
  }

  /** The widget hears of the touch as if it had just begun. */
  #sendOn(): void {
    const held = this.#held;
    if (held === undefined) return;
    this.#forget();
    this.#owner = 'widget';
    const touches = [held.touch];
    const { clientX, clientY } = held.touch;
    // At this one eframe runs at once: a press and what follows it are never of the same frame.
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
