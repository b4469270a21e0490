// Decides when a widget draws. eframe requests an animation frame at the end of every frame; here the request waits for
// an event, a change or a playback, because an idle widget should use no CPU.

type Callback = (time: number) => void;

/** Time after an event during which egui may need frames: hover delays and fades end by then. */
const SETTLE_MS = 900;
/** Frames after an event, however long they take: one to process it, two to settle. */
const SETTLE_FRAMES = 3;

/** Longest side of a canvas: browsers leave the rest of a longer one blank. */
const MAX_SIDE_PX = 8192;

export class FrameGate {
  canvas: HTMLCanvasElement | undefined;
  /** Called after each frame; returns whether another one is needed at once. */
  afterFrame: () => boolean = () => false;
  /** Called if a frame throws, or the observer of its size. */
  onCrash: (error: unknown) => void = () => {};

  #waiting: Callback | undefined;
  #scheduled = 0;
  #awakeUntil = 0;
  #framesLeft = 0;
  #open = false;
  #isInFrame = false;
  /** The reduced pixel ratio of a widget that is too long for the screen's. */
  #reducedRatio = Infinity;

  /** eframe calls this in place of `window.requestAnimationFrame`. */
  request(callback: Callback): number {
    this.#waiting = callback;
    // eframe requests a frame at the end of every frame; outside of frames it has a reason, such as a resize.
    if (this.#isInFrame) this.#schedule();
    else this.wake();
    return 1;
  }

  /** eframe calls this in place of `window.cancelAnimationFrame`. */
  cancel(): void {
    this.#waiting = undefined;
    this.#unschedule();
  }

  /** eframe reads this in place of `window.devicePixelRatio`. A very long widget gets a lower resolution. */
  pixelRatio(): number {
    const longest = Math.max(this.canvas?.clientWidth ?? 0, this.canvas?.clientHeight ?? 0, 1);
    const fits = MAX_SIDE_PX / longest;
    if (window.devicePixelRatio <= fits) return window.devicePixelRatio;
    // Hysteresis: another ratio breaks lines differently, which changes the height and so the ratio.
    const isStillGood = this.#reducedRatio <= fits && this.#reducedRatio > fits - 0.25;
    if (!isStillGood) this.#reducedRatio = Math.floor(8 * fits) / 8 || fits;
    return this.#reducedRatio;
  }

  /** eframe reads this in place of `entry.devicePixelContentBoxSize`. */
  deviceSize(entry: ResizeObserverEntry): readonly ResizeObserverSize[] {
    const ratio = this.pixelRatio();
    const { width, height } = entry.contentRect;
    // No Safari has the property, although TypeScript declares it.
    const [exact] = (entry as Partial<ResizeObserverEntry>).devicePixelContentBoxSize ?? [];
    // An emulated or reduced ratio is not in the exact size, which otherwise differs by rounding only.
    if (exact !== undefined && Math.abs(exact.inlineSize - width * ratio) < 2) return [exact];
    const [inlineSize, blockSize] = [width * ratio, height * ratio].map(Math.round);
    // The glue checks the class, which has no public constructor.
    return [
      Object.create(ResizeObserverSize.prototype, {
        inlineSize: { value: inlineSize },
        blockSize: { value: blockSize },
      }) as ResizeObserverSize,
    ];
  }

  failed(error: unknown): void {
    this.onCrash(error);
  }

  /** Allows drawing. */
  open(): void {
    this.#open = true;
    this.wake();
  }

  /** Stops drawing until opened again. */
  close(): void {
    this.#open = false;
    this.#unschedule();
  }

  /** Draws until egui has settled. */
  wake(): void {
    this.#awakeUntil = performance.now() + SETTLE_MS;
    this.#framesLeft = SETTLE_FRAMES;
    this.#schedule();
  }

  #schedule(): void {
    const wanted = this.#open && (this.#framesLeft > 0 || performance.now() < this.#awakeUntil);
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
    this.#framesLeft = Math.max(this.#framesLeft - 1, 0);
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
