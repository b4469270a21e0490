// What a reader takes away: the picture, the data, a link to the state.

import type { CsvFile } from './instance';

export async function savePng(picture: ImageBitmap, name: string): Promise<void> {
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  canvas.getContext('2d')?.drawImage(picture, 0, 0);
  saveBlob(await canvas.convertToBlob({ type: 'image/png' }), `${name}.png`);
}

/** All tables as files of their own, or as one where there is but one. */
export function saveCsv(files: CsvFile[], name: string): void {
  for (const file of files) {
    saveBlob(new Blob([file.csv], { type: 'text/csv;charset=utf-8' }), `${name}-${file.id}.csv`);
  }
}

function saveBlob(blob: Blob, fileName: string): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = url;
  link.download = fileName;
  link.click();
  // The browser has taken the blob when the click returns; Safari wants a moment more.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Copies a text; false where the browser refuses. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}
