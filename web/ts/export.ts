// What a reader takes away: the picture, the data, a link to the state.

import { create } from './dom';
import type { CsvFile } from './instance';

/** What can be taken from: a widget. */
interface Source extends HTMLElement {
  readonly query: string;
  snapshot(): Promise<ImageBitmap>;
  tables(): Promise<CsvFile[]>;
}

/** The buttons for it; `status` says what became of the link. */
export function takeAwayBar(source: Source, name: string, status: HTMLElement): HTMLElement {
  const bar = create('div', { class: 'tools', role: 'group', 'aria-label': 'Take away' });
  const button = (label: string, press: () => Promise<void>): HTMLElement => {
    const element = create('button', { type: 'button' });
    element.textContent = label;
    element.addEventListener('click', () => void press());
    return element;
  };
  bar.append(
    button('Save picture', async () => savePng(await source.snapshot(), name)),
    button('Save data', async () => saveCsv(await source.tables(), name)),
    button('Copy link', async () => {
      const link = linkTo(source);
      status.textContent = (await copyText(link)) ? 'The link is copied.' : link;
    }),
    status,
  );
  return bar;
}

/** This page, where it takes the state from its address; else the widget on a page of its own. */
function linkTo(source: Source): string {
  const isLinked = source.hasAttribute('linked');
  const link = new URL(isLinked ? location.href : new URL('embed.html', import.meta.url));
  link.search = source.query;
  return link.href;
}

async function savePng(picture: ImageBitmap, name: string): Promise<void> {
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  canvas.getContext('2d')?.drawImage(picture, 0, 0);
  saveBlob(await canvas.convertToBlob({ type: 'image/png' }), `${name}.png`);
}

/** All tables as files of their own, or as one where there is but one. */
function saveCsv(files: CsvFile[], name: string): void {
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
