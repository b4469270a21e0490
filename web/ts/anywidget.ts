// The widget for Jupyter, marimo and MyST through anywidget: traits `name`, `value`, `outcome`; and for w16.10
// `tables`, with files as messages (notebook-files.ts).

// @ts-expect-error: stays a file of its own beside this one.
import './slam-widget.js';
import type Declared from '../slam-anywidget';
import type { Model } from '../slam-anywidget';
import type { SlamWidget } from './element';
import { exchangeFiles } from './notebook-files';
import type { Value } from './values';

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const widget = document.createElement('slam-widget') as SlamWidget;
  const refused = document.createElement('div');
  refused.setAttribute('role', 'status');
  widget.setAttribute('name', String(model.get('name') ?? ''));
  el.append(widget, refused);

  // Some hosts call back for what the widget itself wrote: that asks for nothing.
  let isGiving = false;
  const take = (): void => {
    if (!isGiving) refused.textContent = setAll(widget, model.get('value')).join(' ');
  };
  const give = (): void => {
    isGiving = true;
    model.set('value', widget.value);
    model.set('outcome', widget.outcome ?? null);
    isGiving = false;
    model.save_changes();
  };
  const files = exchangeFiles(model, widget);
  take();
  widget.addEventListener('slam-ready', give);
  widget.addEventListener('slam-result', give);
  widget.addEventListener('slam-result', files.tell);
  model.on('change:value', take);
  return () => {
    model.off('change:value', take);
    files.end();
    widget.remove();
    refused.remove();
  };
}

/** Sets what fits; returns a sentence for each value that does not. */
function setAll(widget: SlamWidget, wanted: unknown): string[] {
  if (wanted === undefined || wanted === null) return [];
  if (typeof wanted !== 'object' || Array.isArray(wanted)) {
    return ['`value` takes an object of parameters, such as {"noise": 2}.'];
  }
  const problems: string[] = [];
  for (const [id, value] of Object.entries(wanted) as [string, Value][]) {
    try {
      if (widget.get(id) !== value) widget.set(id, value);
    } catch (error) {
      const stands = widget.get(id) === undefined ? '' : ' It keeps its value.';
      problems.push(`${(error as Error).message}.${stands}`);
    }
  }
  return problems;
}

const module: typeof Declared = { render };
export default module;
