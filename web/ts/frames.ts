// When a widget may draw. eframe asks for the next animation frame at the end of every frame, for
// ever; here its question waits until there is a reason: an event, a change, something that plays.

type Callback = (time: number) => void;

/** How long after an event egui may still want frames: hover delays and fades end by then. */
const SETTLE_MS = 900;

export class FrameGate {
  /** Called after each frame that ran; says whether another one is wanted at once. */
  afterFrame: () => boolean = () => false;
  /** Called where a frame throws, which only a panic does. */
  onCrash: (error: unknown) => void = () => {};

  #waiting: Callback | undefined;
  #scheduled = 0;
  #awakeUntil = 0;
  #open = false;

  /** The glue calls this in place of `window.requestAnimationFrame`. */
  request(callback: Callback): number {
    this.#waiting = callback;
    this.#schedule();
    return 1;
  }

  /** The glue calls this in place of `window.cancelAnimationFrame`. */
  cancel(): void {
    this.#waiting = undefined;
    this.#unschedule();
  }

  /** The glue calls this in place of `entry.devicePixelContentBoxSize`. */
  deviceSize(entry: ResizeObserverEntry): readonly ResizeObserverSize[] {
    const ratio = window.devicePixelRatio;
    const { width, height } = entry.contentRect;
    const [exact] = entry.devicePixelContentBoxSize;
    // The exact size differs from the rounded one by less than a pixel, but under an emulated
    // ratio by far.
    if (exact !== undefined && Math.abs(exact.inlineSize - width * ratio) < 2) return [exact];
    const [inlineSize, blockSize] = [width * ratio, height * ratio].map(Math.round);
    // The glue asks for an instance of the class, which has no constructor.
    return [
      Object.create(ResizeObserverSize.prototype, {
        inlineSize: { value: inlineSize },
        blockSize: { value: blockSize },
      }) as ResizeObserverSize,
    ];
  }

  /** Draws while open, when there is a reason. */
  open(): void {
    this.#open = true;
    this.wake();
  }

  /** Draws nothing until opened again. */
  close(): void {
    this.#open = false;
    this.#unschedule();
  }

  /** Something happened: draw for a moment. */
  wake(): void {
    this.#awakeUntil = performance.now() + SETTLE_MS;
    this.#schedule();
  }

  #schedule(): void {
    const wanted = this.#open && performance.now() < this.#awakeUntil;
    if (!wanted || this.#waiting === undefined || this.#scheduled !== 0) return;
    this.#scheduled = requestAnimationFrame((time) => this.#run(time));
  }

  #unschedule(): void {
    cancelAnimationFrame(this.#scheduled);
    this.#scheduled = 0;
  }

  #run(time: number): void {
    this.#scheduled = 0;
    const callback = this.#waiting;
    this.#waiting = undefined;
    if (callback === undefined) return;
    try {
      // The glue asks for the next frame in here.
      callback(time);
      if (this.afterFrame()) this.wake();
    } catch (error) {
      this.onCrash(error);
    }
  }
}
