// The widget for Jupyter, marimo and MyST through anywidget: traits `name`, `value`, `outcome`.

// @ts-expect-error: stays a file of its own beside this one.
import './slam-widget.js';
import type { SlamWidget } from './element';
import type { Value } from './values';

/** What anywidget hands over of its model. */
interface Model {
  get(trait: string): unknown;
  set(trait: string, value: unknown): void;
  save_changes(): void;
  on(event: string, callback: () => void): void;
  off(event: string, callback: () => void): void;
}

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const widget = document.createElement('slam-widget') as SlamWidget;
  widget.setAttribute('name', String(model.get('name')));
  el.append(widget);

  const take = (): void => {
    const wanted = (model.get('value') ?? {}) as Record<string, Value>;
    for (const [id, value] of Object.entries(wanted)) {
      if (widget.get(id) !== value) widget.set(id, value);
    }
  };
  const give = (): void => {
    model.set('value', widget.value);
    model.set('outcome', widget.outcome ?? null);
    model.save_changes();
  };
  take();
  widget.addEventListener('slam-ready', give);
  widget.addEventListener('slam-result', give);
  model.on('change:value', take);
  return () => {
    model.off('change:value', take);
    widget.remove();
  };
}

export default { render };
