// Types of the anywidget module `slam-widgets/anywidget`: https://anywidget.dev.

/** What a notebook hands over of its model; the traits are `name`, `value` and `outcome`. */
export interface Model {
  get(trait: string): unknown;
  set(trait: string, value: unknown): void;
  save_changes(): void;
  on(event: string, callback: () => void): void;
  off(event: string, callback: () => void): void;
  /** Messages beside the traits, where the notebook has them: files in, and files that were asked for. */
  on(event: 'msg:custom', callback: (message: unknown, buffers: DataView[]) => void): void;
  off(event: 'msg:custom', callback: (message: unknown, buffers: DataView[]) => void): void;
  send?(message: unknown, callbacks?: unknown, buffers?: ArrayBuffer[]): void;
}

declare const module: {
  /** Puts the widget into an output cell; what it returns takes it away. */
  render(cell: { model: Model; el: HTMLElement }): () => void;
};
export default module;
