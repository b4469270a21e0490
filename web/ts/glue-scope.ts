// What eframe sees in place of the page's window and of its observer of sizes. It has no option for the frames, timers
// and pixels that it takes from there.

export interface FrameSource {
  /** Stands for `requestAnimationFrame`, and for the timer that eframe uses in a hidden page. */
  request(callback: (time: number) => void): number;
  cancel(): void;
  pixelRatio(): number;
  deviceSize(entry: ResizeObserverEntry): readonly ResizeObserverSize[];
  /** Called with an exception of eframe's, which would otherwise end in the console only. */
  failed(error: unknown): void;
}

export function windowOf(frames: FrameSource): Window {
  const own: Partial<Record<string | symbol, unknown>> = {
    // Without it `constructor` and `toString` would be those of this object.
    __proto__: null,
    requestAnimationFrame: (callback: FrameRequestCallback) => frames.request(callback),
    cancelAnimationFrame: () => frames.cancel(),
    setTimeout: (callback: () => void) => frames.request(callback),
    clearTimeout: () => frames.cancel(),
  };
  return new Proxy(window, {
    get(page, name) {
      if (name === 'devicePixelRatio') return frames.pixelRatio();
      const value: unknown = own[name] ?? Reflect.get(page, name);
      // The page's functions accept only its own window; a class has statics, and needs none.
      return typeof value === 'function' && !Object.hasOwn(value, 'prototype') ? value.bind(page) : value;
    },
  });
}

export function observerOf(frames: FrameSource): typeof ResizeObserver {
  return class extends ResizeObserver {
    constructor(callback: ResizeObserverCallback) {
      super((entries, observer) => {
        try {
          for (const entry of entries) {
            Object.defineProperty(entry, 'devicePixelContentBoxSize', { value: frames.deviceSize(entry) });
          }
          callback(entries, observer);
        } catch (error) {
          frames.failed(error);
        }
      });
    }
  };
}
