// Decides when a widget may draw. eframe requests the next animation frame at the end of every frame,
// forever; here the request waits for a reason: an event, a change, a playback.

type Callback = (time: number) => void;

/** Time after an event during which egui may need frames: hover delays and fades end by then. */
const SETTLE_MS = 900;
/** Number of frames after an event, however slow they are: one to process it, two to settle. */
const SETTLE_FRAMES = 3;

/** Largest number of pixels along a side of a canvas: browsers clip a longer one, and leave the rest blank. */
const MOST_PIXELS = 8192;

export class FrameGate {
  /** The canvas. */
  canvas: HTMLCanvasElement | undefined;
  /** Called after each frame; returns whether another one is needed at once. */
  afterFrame: () => boolean = () => false;
  /** Called if a frame throws, which only a panic does. */
  onCrash: (error: unknown) => void = () => {};

  #waiting: Callback | undefined;
  #scheduled = 0;
  #awakeUntil = 0;
  #owed = 0;
  #open = false;
  #isInFrame = false;
  /** The pixel ratio of a widget that is too long for the screen's own. */
  #held = Infinity;

  /** The glue calls this in place of `window.requestAnimationFrame`. */
  request(callback: Callback): number {
    this.#waiting = callback;
    // At the end of a frame eframe always requests one; at any other time it has a reason, such as a new
    // size.
    if (this.#isInFrame) this.#schedule();
    else this.wake();
    return 1;
  }

  /** The glue calls this in place of `window.cancelAnimationFrame`. */
  cancel(): void {
    this.#waiting = undefined;
    this.#unschedule();
  }

  /** The glue calls this in place of `window.devicePixelRatio`. A very long widget gets a lower resolution. */
  pixelRatio(): number {
    const longest = Math.max(this.canvas?.clientWidth ?? 0, this.canvas?.clientHeight ?? 0, 1);
    const fits = MOST_PIXELS / longest;
    if (window.devicePixelRatio <= fits) return window.devicePixelRatio;
    // Lines break differently at another ratio, which changes the height, so the ratio must not follow each
    // change.
    const isHeld = this.#held <= fits && this.#held > fits - 0.25;
    if (!isHeld) this.#held = Math.floor(8 * fits) / 8 || fits;
    return this.#held;
  }

  /** The glue calls this in place of `entry.devicePixelContentBoxSize`. */
  deviceSize(entry: ResizeObserverEntry): readonly ResizeObserverSize[] {
    const ratio = this.pixelRatio();
    const { width, height } = entry.contentRect;
    const [exact] = entry.devicePixelContentBoxSize;
    // The exact size differs from the rounded one by less than a pixel, except under an emulated or limited
    // ratio.
    if (exact !== undefined && Math.abs(exact.inlineSize - width * ratio) < 2) return [exact];
    const [inlineSize, blockSize] = [width * ratio, height * ratio].map(Math.round);
    // The glue expects an instance of the class, which has no constructor.
    return [
      Object.create(ResizeObserverSize.prototype, {
        inlineSize: { value: inlineSize },
        blockSize: { value: blockSize },
      }) as ResizeObserverSize,
    ];
  }

  /** Draws while open, if there is a reason. */
  open(): void {
    this.#open = true;
    this.wake();
  }

  /** Stops drawing until opened again. */
  close(): void {
    this.#open = false;
    this.#unschedule();
  }

  /** Draws for a moment after an event. */
  wake(): void {
    this.#awakeUntil = performance.now() + SETTLE_MS;
    this.#owed = SETTLE_FRAMES;
    this.#schedule();
  }

  #schedule(): void {
    const wanted = this.#open && (this.#owed > 0 || performance.now() < this.#awakeUntil);
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
    this.#owed = Math.max(this.#owed - 1, 0);
    this.#isInFrame = true;
    try {
      // The glue requests the next frame in here.
      callback(time);
      if (this.afterFrame()) this.wake();
    } catch (error) {
      this.onCrash(error);
    } finally {
      this.#isInFrame = false;
    }
  }
}
