// Files between a notebook and w16.10: a log comes in pieces from the kernel's disk, and requested files go
// back. None of it is a trait, so no notebook stores a log in its file.

import type { Model } from '../slam-anywidget';
import type { SlamWidget } from './element';
import type { FileUse } from './robot/desk';

/** From the kernel. */
type Wish =
  /** A piece of a file; the last one comes with `last`. */
  | { type: 'piece'; name: string; use: FileUse; first: boolean; last: boolean }
  | { type: 'file'; name: string };

/** Transfers files while a cell shows the widget; `tell` sends the tables, `end` ends it. */
export function exchangeFiles(model: Model, widget: SlamWidget): { tell: () => void; end: () => void } {
  if (widget.name !== 'w16.10' || model.send === undefined) return { tell: () => {}, end: () => {} };
  const pieces = new Map<FileUse, Uint8Array<ArrayBuffer>[]>();

  const hear = (message: unknown, buffers: DataView[]): void => {
    const wish = message as Wish;
    if (wish.type === 'piece') {
      const kept = wish.first ? [] : (pieces.get(wish.use) ?? []);
      const copies = buffers.map((view) => {
        return new Uint8Array(view.buffer as ArrayBuffer, view.byteOffset, view.byteLength).slice();
      });
      pieces.set(wish.use, [...kept, ...copies]);
      if (!wish.last) return;
      widget.openFile(new File(pieces.get(wish.use) ?? [], wish.name), wish.use);
      pieces.delete(wish.use);
    } else if (wish.type === 'file') void give(wish.name);
  };
  const give = async (name: string): Promise<void> => {
    try {
      const bytes = await (await widget.savedFile(name)).arrayBuffer();
      model.send?.({ type: 'file', name }, undefined, [bytes]);
    } catch (error) {
      model.send?.({ type: 'refused', name, why: (error as Error).message });
    }
  };
  /** Once no transfer is under way. */
  const tell = (): void => {
    void widget.tables().then((tables) => {
      model.set('tables', Object.fromEntries(tables.map(({ id, csv }) => [id, csv])));
      model.save_changes();
    });
  };
  model.on('msg:custom', hear);
  // A cell that is shown again needs its files again.
  widget.addEventListener('slam-ready', () => model.send?.({ type: 'ready' }), { once: true });
  return { tell, end: () => model.off('msg:custom', hear) };
}
