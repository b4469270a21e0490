// The glue of wasm-bindgen, wrapped by the build in one function: a page can hold many instances.

export type Glue = typeof wasm_bindgen;
export type Widget = wasm_bindgen.Widget;

/** Glue with separate state; eframe sees this window and this class. */
export function createGlue(self?: object, observer?: typeof ResizeObserver): Glue;
