// Types of the anywidget module `slam-widgets/anywidget`: https://anywidget.dev.

/** The notebook's interface to its model; the traits are `name`, `value` and `outcome`. */
export interface Model {
  get(trait: string): unknown;
  set(trait: string, value: unknown): void;
  save_changes(): void;
  on(event: string, callback: () => void): void;
  off(event: string, callback: () => void): void;
  /** Messages besides the traits, if the notebook has them: files in, and requested files out. */
  on(event: 'msg:custom', callback: (message: unknown, buffers: DataView[]) => void): void;
  off(event: 'msg:custom', callback: (message: unknown, buffers: DataView[]) => void): void;
  send?(message: unknown, callbacks?: unknown, buffers?: ArrayBuffer[]): void;
}

declare const module: {
  /** Puts the widget into an output cell; returns a function that removes it. */
  render(cell: { model: Model; el: HTMLElement }): () => void;
};
export default module;
