// Decides between page and widget for a touch on something draggable: a vertical swipe scrolls the page; a horizontal
// swipe, a tap and a long press belong to the widget. On a full-size map two fingers zoom and drag nothing, wherever they
// start.

/** Maximum movement of a tap or a long press. */
const SLACK_PX = 6;
/** Duration of a long press, after which a vertical move drags. */
const LONG_PRESS_MS = 220;

/** A position far outside, where a press has no effect. */
const OFFSCREEN_PX = -1e4;
/** A touch id that no browser uses. */
const UNUSED_ID = 1e6;

/** A touch whose owner is undecided. */
interface PendingTouch {
  touch: Touch;
  timer: ReturnType<typeof setTimeout>;
}

export interface TouchTarget {
  /** Whether something can be dragged at a position, in CSS pixels from the canvas's corner. */
  dragsAt(x: number, y: number): boolean;
  /** Ends the drag. */
  letGo(): void;
}

export class TouchGate {
  readonly #canvas: HTMLCanvasElement;
  readonly #widget: TouchTarget;
  /** Whether two fingers zoom the widget. */
  readonly #pinchZooms: boolean;
  #pending: PendingTouch | undefined;
  /** Who gets the touch, once decided. */
  #owner: 'page' | 'widget' | undefined;

  constructor(stage: HTMLElement, canvas: HTMLCanvasElement, widget: TouchTarget, signal: AbortSignal) {
    this.#canvas = canvas;
    this.#widget = widget;
    this.#pinchZooms = stage.closest('.takes-files') !== null;
    const early = { capture: true, passive: true, signal };
    stage.addEventListener('pointerdown', (event) => this.#press(event), early);
    stage.addEventListener('touchstart', (event) => this.#start(event), early);
    // Not passive: the browser scrolls unless the first touchmove is cancelled.
    stage.addEventListener('touchmove', (event) => this.#move(event), { capture: true, passive: false, signal });
    stage.addEventListener('touchend', (event) => this.#end(event), early);
    stage.addEventListener('touchcancel', () => this.#forget(), early);
    signal.addEventListener('abort', () => this.#forget());
  }

  /** The pointer event comes before the touch event. */
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
    // Untrusted events are our own, dispatched below.
    if (!event.isTrusted || touch === undefined || event.target !== this.#canvas) return;
    if (event.touches.length > 1) {
      this.#pinch(event, touch);
      return;
    }
    this.#owner = undefined;
    if (!this.#isHandle(touch)) return;
    event.stopPropagation();
    this.#pending = { touch, timer: setTimeout(() => this.#replay(), LONG_PRESS_MS) };
  }

  /** A second finger ends the drag of the first, and cancels a pending one. */
  #pinch(event: TouchEvent, second: Touch): void {
    const first = this.#pending?.touch;
    const isOurs = this.#pinchZooms && this.#owner !== 'page' && event.touches.length === 2;
    this.#forget();
    this.#owner = isOurs ? 'widget' : undefined;
    if (!isOurs) return;
    event.stopPropagation();
    if (first === undefined) this.#widget.letGo();
    // eframe presses where the finger is that it follows, and keeps following that finger while it is down. A finger far
    // outside makes it let go.
    const [clientX, clientY] = [OFFSCREEN_PX, OFFSCREEN_PX];
    const offscreen = { identifier: UNUSED_ID, target: this.#canvas, clientX, clientY, pageX: clientX, pageY: clientY, force: 0 };
    for (const changedTouches of [[], first === undefined ? [second] : [first, second]]) {
      this.#canvas.dispatchEvent(touchStart([offscreen], changedTouches));
    }
  }

  #move(event: TouchEvent): void {
    const [touch] = event.changedTouches;
    if (this.#pending !== undefined && touch !== undefined) this.#decide(this.#pending.touch, touch);
    if (this.#owner !== 'widget') {
      if (this.#owner === 'page' || this.#pending !== undefined) event.stopPropagation();
    } else if (event.cancelable) {
      event.preventDefault();
    }
  }

  #decide(from: Touch, to: Touch): void {
    const across = Math.abs(to.clientX - from.clientX);
    const along = Math.abs(to.clientY - from.clientY);
    if (Math.max(across, along) <= SLACK_PX) return;
    if (along <= across) {
      this.#replay();
    } else {
      this.#forget();
      this.#owner = 'page';
    }
  }

  #end(event: TouchEvent): void {
    if (this.#owner === 'page') event.stopPropagation();
    // Still undecided: it was a tap.
    this.#replay();
    this.#owner = undefined;
  }

  /** Replays the start of the pending touch to the widget. */
  #replay(): void {
    const pending = this.#pending;
    if (pending === undefined) return;
    this.#forget();
    this.#owner = 'widget';
    const touches = [pending.touch];
    const { clientX, clientY } = pending.touch;
    // On this event eframe runs a frame at once, so the press and the next event are in separate frames.
    this.#canvas.dispatchEvent(
      new PointerEvent('pointerdown', { pointerType: 'touch', clientX, clientY, buttons: 1, bubbles: true }),
    );
    this.#canvas.dispatchEvent(touchStart(touches, touches));
  }

  #forget(): void {
    clearTimeout(this.#pending?.timer);
    this.#pending = undefined;
  }
}

/** What eframe reads of a touch. */
type AnyTouch = Pick<Touch, 'identifier' | 'target' | 'clientX' | 'clientY' | 'pageX' | 'pageY' | 'force'>;

/** The event of a touch that begins. Where a script cannot construct one, an event with the same properties stands for it. */
function touchStart(touches: readonly AnyTouch[], changedTouches: readonly AnyTouch[]): Event {
  const how = { bubbles: true, cancelable: true };
  try {
    const real = (touch: AnyTouch): Touch => (touch instanceof Touch ? touch : new Touch(touch));
    const [all, changed] = [touches.map(real), changedTouches.map(real)];
    return new TouchEvent('touchstart', { ...how, touches: all, targetTouches: all, changedTouches: changed });
  } catch {
    const lists = Object.entries({ touches, targetTouches: touches, changedTouches });
    const asBrowsers = (list: readonly AnyTouch[]): object => Object.assign([...list], { item: (at: number) => list[at] ?? null });
    return Object.defineProperties(new Event('touchstart', how), Object.fromEntries(lists.map(([name, list]) => [name, { value: asBrowsers(list) }])));
  }
}
