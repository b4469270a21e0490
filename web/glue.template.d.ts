// The glue of wasm-bindgen, wrapped by the build in one function: a page can hold many instances.

export type Glue = typeof wasm_bindgen;
export type Widget = wasm_bindgen.Widget;

export interface FrameSource {
  request(callback: (time: number) => void): number;
  cancel(): void;
  pixelRatio(): number;
  deviceSize(entry: ResizeObserverEntry): readonly ResizeObserverSize[];
}

/** Glue with separate state; `frames` replaces functions of the window. */
export function createGlue(frames: FrameSource): Glue;
