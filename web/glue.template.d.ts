// The glue of wasm-bindgen, wrapped by the build in one function: a page can hold many instances.

export type Glue = typeof wasm_bindgen;
export type Widget = wasm_bindgen.Widget;

export interface FrameSource {
  request(callback: (time: number) => void): number;
  cancel(): void;
  pixelRatio(): number;
  deviceSize(entry: ResizeObserverEntry): readonly ResizeObserverSize[];
}

/** A glue with state of its own; `frames` takes the place of what the window would answer. */
export function createGlue(frames: FrameSource): Glue;
