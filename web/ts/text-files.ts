// Text files that a widget opens and saves: a world as JSON.

import type { Widget } from '../pkg/glue.js';
import { saveBlob } from './export';
import { chooseFiles } from './robot/files';

/** Maximum size of a world: two thousand walls take a tenth of it. */
const MAX_BYTES = 1 << 20;

export interface TextFileHost {
  readonly frame: HTMLElement;
  /** Executes an action on the widget, once it runs. */
  act(action: (widget: Widget) => void): void;
  /** Reports a problem with a file. */
  reject(problem: string): void;
}

/** Executes an order of the widget about text files; returns false for other orders. */
export function executeTextOrder(order: string, host: TextFileHost): boolean {
  const [head = '', ...lines] = order.split('\n');
  const [name, argument = ''] = head.split(' ');
  if (name === 'open-text') {
    const wanted = { label: 'A world as JSON', several: false };
    chooseFiles(host.frame, wanted, ([file]) => void (file && takeTextFile(file, host)));
  } else if (name === 'save-text') {
    saveBlob(new Blob([lines.join('\n')], { type: 'application/json' }), argument);
  } else {
    return false;
  }
  return true;
}

/** Passes a reader's file to the widget. */
export async function takeTextFile(file: File, host: TextFileHost): Promise<void> {
  if (file.size > MAX_BYTES) {
    host.reject(`\`${file.name.slice(0, 60)}\` exceeds the 1 MB limit for a world.`);
    return;
  }
  try {
    const bytes = new Uint8Array(await file.arrayBuffer());
    host.act((widget) => widget.deliver('text-file', file.name, new Float64Array(), bytes));
  } catch {
    host.reject(`\`${file.name.slice(0, 60)}\` cannot be read any more; it may have moved or changed.`);
  }
}
