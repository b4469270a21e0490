// File input by drag and drop, or by the file dialog.

import { create } from '../dom';

export interface DialogOptions {
  label: string;
  several: boolean;
}

/** Calls `take` with files that are dropped on the frame; returns a function that removes the listeners. */
export function acceptDrops(frame: HTMLElement, take: (files: File[]) => void): () => void {
  const listening = new AbortController();
  // Capture: the canvas handles drops as well, reads each file completely, and stops the event.
  const capture = { signal: listening.signal, capture: true };
  const hasFiles = ({ dataTransfer }: DragEvent): boolean => dataTransfer?.types.includes('Files') ?? false;
  const show = (isOver: boolean): void => void frame.classList.toggle('dropping', isOver);
  const consume = (event: DragEvent): void => {
    // The default action navigates to the file.
    event.preventDefault();
    event.stopPropagation();
  };
  frame.addEventListener(
    'dragover',
    (event) => {
      if (!hasFiles(event)) return;
      consume(event);
      show(true);
    },
    capture,
  );
  frame.addEventListener('dragleave', () => show(false), capture);
  frame.addEventListener(
    'drop',
    (event) => {
      show(false);
      if (!hasFiles(event) || event.dataTransfer === null) return;
      consume(event);
      const { files, items } = event.dataTransfer;
      // Entries are available only during the event.
      const entries = [...items].map((item) => item.webkitGetAsEntry());
      if (entries.some((entry) => entry?.isDirectory === true)) void filesOf(entries).then(take);
      else take([...files]);
    },
    capture,
  );
  return () => listening.abort();
}

/** The dropped files and the files of dropped folders, not recursive. */
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
    // Browsers return at most a hundred entries at a time.
    for (let some = await next(); some.length > 0; some = await next()) some.forEach(take);
  }
  return Promise.all(found);
}

/**
 * Opens the file dialog. Its hidden field stays until files are chosen, or until the next dialog. The dialog offers every
 * file: of a list of extensions iOS knows few, and greys out the files of all others.
 */
export function chooseFiles(frame: HTMLElement, { label, several }: DialogOptions, chosen: (files: File[]) => void): void {
  frame.querySelector('input[type=file]')?.remove();
  const field = create('input', { type: 'file', hidden: '', 'aria-label': label });
  field.multiple = several;
  field.addEventListener('change', () => {
    const files = [...(field.files ?? [])];
    if (files.length > 0) chosen(files);
    field.remove();
  });
  frame.append(field);
  field.click();
}
