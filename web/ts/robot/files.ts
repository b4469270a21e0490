// File input: dropped on the element, or chosen in the system's dialog.

import { create } from '../dom';

/** The file types that the picker offers first; a recording of several files may have a description. */
export const LOGS = '.yaml,.log,.clf,.mcap,.db3,.bag,.jsonl,.gz,.zst,.zstd,.g2o,.graph,.toro,.slam2d';

/** The request of a dialog. */
export interface Wanted {
  accept: string;
  label: string;
  several: boolean;
}

/** Takes files that are dropped on the frame; returns a function that ends it. */
export function takeDrops(frame: HTMLElement, take: (files: File[]) => void): () => void {
  const listening = new AbortController();
  // The canvas handles drops as well, reads each file completely, and stops the event: the frame comes first.
  const first = { signal: listening.signal, capture: true };
  const holdsFiles = ({ dataTransfer }: DragEvent): boolean => dataTransfer?.types.includes('Files') ?? false;
  const show = (isOver: boolean): void => void frame.classList.toggle('dropping', isOver);
  const keep = (event: DragEvent): void => {
    // Otherwise the browser shows the file instead of the page.
    event.preventDefault();
    event.stopPropagation();
  };
  frame.addEventListener(
    'dragover',
    (event) => {
      if (!holdsFiles(event)) return;
      keep(event);
      show(true);
    },
    first,
  );
  frame.addEventListener('dragleave', () => show(false), first);
  frame.addEventListener(
    'drop',
    (event) => {
      show(false);
      if (!holdsFiles(event) || event.dataTransfer === null) return;
      keep(event);
      const { files, items } = event.dataTransfer;
      // Entries are available only during the event.
      const entries = [...items].map((item) => item.webkitGetAsEntry());
      if (entries.some((entry) => entry?.isDirectory === true)) void filesOf(entries).then(take);
      else take([...files]);
    },
    first,
  );
  return () => listening.abort();
}

/** The dropped files, and those of dropped folders, without nested folders. */
async function filesOf(entries: readonly (FileSystemEntry | null)[]): Promise<File[]> {
  const found: Promise<File>[] = [];
  const take = (entry: FileSystemEntry | null): void => {
    if (entry?.isFile !== true) return;
    found.push(new Promise((file, failed) => (entry as FileSystemFileEntry).file(file, failed)));
  };
  for (const entry of entries) {
    take(entry);
    if (entry?.isDirectory !== true) continue;
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    const next = (): Promise<FileSystemEntry[]> => new Promise((some, failed) => reader.readEntries(some, failed));
    // A browser returns a hundred at a time.
    for (let some = await next(); some.length > 0; some = await next()) some.forEach(take);
  }
  return Promise.all(found);
}

/** Opens the system's dialog; the field for it stays until files are chosen, or the next dialog. */
export function chooseFiles(frame: HTMLElement, { accept, label, several }: Wanted, chosen: (files: File[]) => void): void {
  frame.querySelector('input[type=file]')?.remove();
  const field = create('input', { type: 'file', accept, hidden: '', 'aria-label': label });
  field.multiple = several;
  field.addEventListener('change', () => {
    const files = [...(field.files ?? [])];
    if (files.length > 0) chosen(files);
    field.remove();
  });
  frame.append(field);
  field.click();
}
