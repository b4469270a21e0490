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

  // Values that kernel and widget agree on.
  const agreed = new Map<string, Value>();
  // Some hosts call back for values that the widget itself wrote; these need no reaction.
  let isGiving = false;
  const take = (): void => {
    if (!isGiving) refused.textContent = setChanged(widget, model.get('value'), agreed).join(' ');
  };
  const give = (): void => {
    isGiving = true;
    const value = widget.value;
    for (const [id, given] of Object.entries(value)) agreed.set(id, given);
    model.set('value', value);
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

/**
 * Sets values that are valid and not yet agreed on; returns a sentence for each invalid value.
 *
 * JupyterLab requests all values from the kernel when the first cell is shown. The answer may come after the
 * reader has changed something, and then contains nothing new.
 */
function setChanged(widget: SlamWidget, wanted: unknown, agreed: Map<string, Value>): string[] {
  if (wanted === undefined || wanted === null) return [];
  if (typeof wanted !== 'object' || Array.isArray(wanted)) {
    return ['`value` takes an object of parameters, such as {"noise": 2}.'];
  }
  const problems: string[] = [];
  for (const [id, value] of Object.entries(wanted) as [string, Value][]) {
    if (agreed.get(id) === value) continue;
    try {
      if (widget.get(id) !== value) widget.set(id, value);
      agreed.set(id, value);
    } catch (error) {
      const stands = widget.get(id) === undefined ? '' : ' It keeps its value.';
      problems.push(`${(error as Error).message}.${stands}`);
    }
  }
  return problems;
}

const module: typeof Declared = { render };
export default module;
