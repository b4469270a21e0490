// How a file comes in: dropped on the element, or chosen in the system's dialog.

import { create } from '../dom';

/** Takes files that are dropped on the frame; returns what ends it. */
export function takeDrops(frame: HTMLElement, take: (files: File[]) => void): () => void {
  const listening = new AbortController();
  const { signal } = listening;
  const holdsFiles = ({ dataTransfer }: DragEvent): boolean => dataTransfer?.types.includes('Files') ?? false;
  const show = (isOver: boolean): void => void frame.classList.toggle('dropping', isOver);
  frame.addEventListener(
    'dragover',
    (event) => {
      if (!holdsFiles(event)) return;
      // Else the browser shows the file in place of the page.
      event.preventDefault();
      show(true);
    },
    { signal },
  );
  frame.addEventListener('dragleave', () => show(false), { signal });
  frame.addEventListener(
    'drop',
    (event) => {
      show(false);
      if (!holdsFiles(event) || event.dataTransfer === null) return;
      event.preventDefault();
      take([...event.dataTransfer.files]);
    },
    { signal },
  );
  return () => listening.abort();
}

/** Opens the system's dialog; the field for it stays until a file is chosen, or the next dialog. */
export function chooseFile(frame: HTMLElement, accept: string, label: string, chosen: (file: File) => void): void {
  frame.querySelector('input[type=file]')?.remove();
  const field = create('input', { type: 'file', accept, hidden: '', 'aria-label': label });
  field.addEventListener('change', () => {
    const [file] = field.files ?? [];
    if (file !== undefined) chosen(file);
    field.remove();
  });
  frame.append(field);
  field.click();
}
