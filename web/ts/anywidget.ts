// The widget for Jupyter, marimo and MyST through anywidget: traits `name`, `value` and `outcome`. w16.10 also has
// `tables`, and exchanges files as messages (notebook-files.ts).

// @ts-expect-error: a separate bundle.
import './slam-widget.js';
import type Declared from '../slam-anywidget';
import type { Model } from '../slam-anywidget';
import type { SlamWidget } from './element';
import { exchangeFiles } from './notebook-files';
import type { Value } from './values';

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const widget = document.createElement('slam-widget') as SlamWidget;
  const problems = document.createElement('div');
  problems.setAttribute('role', 'status');
  widget.setAttribute('name', String(model.get('name') ?? ''));
  el.append(widget, problems);

  // The last values that kernel and widget had in common.
  const synced = new Map<string, Value>();
  // Some hosts also call back for values that the widget wrote.
  let isWriting = false;
  const readModel = (): void => {
    if (!isWriting) problems.textContent = setChanged(widget, model.get('value'), synced).join(' ');
  };
  const writeModel = (): void => {
    isWriting = true;
    const value = widget.value;
    for (const [id, current] of Object.entries(value)) synced.set(id, current);
    model.set('value', value);
    model.set('outcome', widget.outcome ?? null);
    isWriting = false;
    model.save_changes();
  };
  const files = exchangeFiles(model, widget);
  readModel();
  widget.addEventListener('slam-ready', writeModel);
  widget.addEventListener('slam-result', writeModel);
  widget.addEventListener('slam-result', files.writeTables);
  model.on('change:value', readModel);
  return () => {
    model.off('change:value', readModel);
    files.end();
    widget.remove();
    problems.remove();
  };
}

/**
 * Sets the valid values that differ from the synced ones; returns a sentence for each invalid value.
 *
 * JupyterLab requests all values from the kernel when it shows the first cell. If the reader changes a value before the
 * answer comes, the answer must not revert it.
 */
function setChanged(widget: SlamWidget, wanted: unknown, synced: Map<string, Value>): string[] {
  if (wanted === undefined || wanted === null) return [];
  if (typeof wanted !== 'object' || Array.isArray(wanted)) {
    return ['`value` takes an object of parameters, such as {"noise": 2}.'];
  }
  const problems: string[] = [];
  for (const [id, value] of Object.entries(wanted) as [string, Value][]) {
    if (synced.get(id) === value) continue;
    try {
      if (widget.get(id) !== value) widget.set(id, value);
      synced.set(id, value);
    } catch (error) {
      const kept = widget.get(id) === undefined ? '' : ' It keeps its value.';
      problems.push(`${(error as Error).message}.${kept}`);
    }
  }
  return problems;
}

const module: typeof Declared = { render };
export default module;
