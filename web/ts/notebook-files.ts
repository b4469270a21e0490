// Files between a notebook and w16.10. The kernel sends a log in pieces and requests files. Both are messages instead of
// traits, because a notebook stores its traits.

import type { Model } from '../slam-anywidget';
import type { SlamWidget } from './element';
import type { FileUse } from './robot/log-mapper';

/** A message from the kernel. */
type Request =
  /** A piece of a file; the last one comes with `last`. */
  | { type: 'piece'; name: string; use: FileUse; first: boolean; last: boolean }
  | { type: 'file'; name: string };

/** Transfers files until `end` is called; `writeTables` copies the tables to their trait. */
export function exchangeFiles(model: Model, widget: SlamWidget): { writeTables: () => void; end: () => void } {
  if (widget.name !== 'w16.10' || model.send === undefined) return { writeTables: () => {}, end: () => {} };
  const pieces = new Map<FileUse, Uint8Array<ArrayBuffer>[]>();

  const receive = (message: unknown, buffers: DataView[]): void => {
    const request = message as Request;
    if (request.type === 'piece') {
      const earlier = request.first ? [] : (pieces.get(request.use) ?? []);
      const copies = buffers.map((view) => {
        return new Uint8Array(view.buffer as ArrayBuffer, view.byteOffset, view.byteLength).slice();
      });
      pieces.set(request.use, [...earlier, ...copies]);
      if (!request.last) return;
      widget.openFile(new File(pieces.get(request.use) ?? [], request.name), request.use);
      pieces.delete(request.use);
    } else if (request.type === 'file') void send(request.name);
  };
  const send = async (name: string): Promise<void> => {
    try {
      const bytes = await (await widget.savedFile(name)).arrayBuffer();
      model.send?.({ type: 'file', name }, undefined, [bytes]);
    } catch (error) {
      model.send?.({ type: 'rejected', name, why: (error as Error).message });
    }
  };
  const writeTables = (): void => {
    void widget.tables().then((tables) => {
      model.set('tables', Object.fromEntries(tables.map(({ id, csv }) => [id, csv])));
      model.save_changes();
    });
  };
  model.on('msg:custom', receive);
  // A new cell has no files yet: the kernel sends them again.
  widget.addEventListener('slam-ready', () => model.send?.({ type: 'ready' }), { once: true });
  return { writeTables, end: () => model.off('msg:custom', receive) };
}
