// When a widget may draw. eframe asks for the next animation frame at the end of every frame, for
// ever; here its question waits until there is a reason: an event, a change, something that plays.

type Callback = (time: number) => void;

/** How long after an event egui may still want frames: hover delays and fades end by then. */
const SETTLE_MS = 900;
/** So many frames follow an event however slow they are: one to take it in, two to settle. */
const SETTLE_FRAMES = 3;

/** Pixels along a side of a canvas at most: browsers cut a longer one, and what is cut stays blank. */
const MOST_PIXELS = 8192;

export class FrameGate {
  /** What is drawn on. */
  canvas: HTMLCanvasElement | undefined;
  /** Called after each frame that ran; says whether another one is wanted at once. */
  afterFrame: () => boolean = () => false;
  /** Called where a frame throws, which only a panic does. */
  onCrash: (error: unknown) => void = () => {};

  #waiting: Callback | undefined;
  #scheduled = 0;
  #awakeUntil = 0;
  #owed = 0;
  #open = false;
  #isInFrame = false;
  /** The ratio of a widget that is too long for the screen's own. */
  #held = Infinity;

  /** The glue calls this in place of `window.requestAnimationFrame`. */
  request(callback: Callback): number {
    this.#waiting = callback;
    // At the end of a frame it always asks; at any other time it has a reason, such as a new size.
    if (this.#isInFrame) this.#schedule();
    else this.wake();
    return 1;
  }

  /** The glue calls this in place of `window.cancelAnimationFrame`. */
  cancel(): void {
    this.#waiting = undefined;
    this.#unschedule();
  }

  /** The glue calls this in place of `window.devicePixelRatio`. A very long widget is drawn coarser. */
  pixelRatio(): number {
    const longest = Math.max(this.canvas?.clientWidth ?? 0, this.canvas?.clientHeight ?? 0, 1);
    const fits = MOST_PIXELS / longest;
    if (window.devicePixelRatio <= fits) return window.devicePixelRatio;
    // Lines break elsewhere at another ratio, and then the height changes: the ratio must not follow each change.
    const isHeld = this.#held <= fits && this.#held > fits - 0.25;
    if (!isHeld) this.#held = Math.floor(8 * fits) / 8 || fits;
    return this.#held;
  }

  /** The glue calls this in place of `entry.devicePixelContentBoxSize`. */
  deviceSize(entry: ResizeObserverEntry): readonly ResizeObserverSize[] {
    const ratio = this.pixelRatio();
    const { width, height } = entry.contentRect;
    const [exact] = entry.devicePixelContentBoxSize;
    // The exact size differs from the rounded one by less than a pixel, but under an emulated
    // ratio, or one that is held down, by far.
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
      // The glue asks for the next frame in here.
      callback(time);
      if (this.afterFrame()) this.wake();
    } catch (error) {
      this.onCrash(error);
    } finally {
      this.#isInFrame = false;
    }
  }
}
