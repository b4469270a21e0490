// Exports for the reader: the picture, the data, a link to the state.

import { create } from './dom';
import type { CsvFile } from './instance';

/** The exported widget. */
interface Source extends HTMLElement {
  /** The page, or a separate page, with the widget in its present state. */
  readonly link: string;
  snapshot(): Promise<ImageBitmap>;
  tables(): Promise<CsvFile[]>;
}

/** The menu of the exports; `status` is the live region for their results. */
export function exportMenu(source: Source, name: string, status: HTMLElement): HTMLElement {
  const menu = create('details', { class: 'menu' });
  const heading = create('summary');
  const items = create('div');
  heading.textContent = 'Share';
  menu.addEventListener('focusout', ({ relatedTarget }) => {
    if (relatedTarget instanceof Node && !menu.contains(relatedTarget)) menu.open = false;
  });
  menu.addEventListener('keydown', ({ key }) => {
    if (key !== 'Escape' || !menu.open) return;
    menu.open = false;
    heading.focus();
  });
  const button = (label: string, press: () => Promise<void>): HTMLElement => {
    const element = create('button', { type: 'button' });
    element.textContent = label;
    element.addEventListener('click', () => {
      press().catch((error: Error) => (status.textContent = `${label} failed: ${error.message}.`));
    });
    return element;
  };
  items.append(
    button('Send', async () => {
      status.textContent = await send(await pngOf(await source.snapshot(), name), source.link);
    }),
    button('Save picture', async () => saveBlob(await pngOf(await source.snapshot(), name), `${name}.png`)),
    button('Save data', async () => saveCsv(await source.tables(), name)),
    button('Copy link', async () => {
      status.textContent = (await copyText(source.link)) ? 'The link is copied.' : source.link;
    }),
  );
  items.append(status);
  menu.append(heading, items);
  return menu;
}

/** Sends a picture with a link by the system's dialog; without one, saves it and copies the link. Returns what was done. */
export async function send(picture: File, link: string): Promise<string> {
  const parcel = { files: [picture], title: document.title, url: link };
  if (navigator.canShare?.(parcel) === true) {
    await navigator.share(parcel);
    return '';
  }
  saveBlob(picture, picture.name);
  return (await copyText(link)) ? 'The picture is saved, the link copied.' : link;
}

async function pngOf(picture: ImageBitmap, name: string): Promise<File> {
  return pngOfSize(picture, picture, name);
}

/** Draws an SVG at a size into a file. */
export async function pngOfSvg(svg: string, size: { width: number; height: number }, name: string): Promise<File> {
  const picture = document.createElement('img');
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await picture.decode();
  return pngOfSize(picture, size, name);
}

async function pngOfSize(picture: CanvasImageSource, { width, height }: { width: number; height: number }, name: string): Promise<File> {
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d')?.drawImage(picture, 0, 0, width, height);
  return new File([await canvas.convertToBlob({ type: 'image/png' })], `${name}.png`, { type: 'image/png' });
}

/** Saves each table as a file. */
function saveCsv(files: CsvFile[], name: string): void {
  for (const file of files) {
    saveBlob(new Blob([file.csv], { type: 'text/csv;charset=utf-8' }), `${name}-${file.id}.csv`);
  }
}

/** Saves a file for the reader. */
export function saveBlob(blob: Blob, fileName: string): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = url;
  link.download = fileName;
  link.click();
  // Safari reads the blob after the click has returned.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** A browser that has not copied by then asks the reader first, or never answers. */
const COPY_MS = 1_000;

/** Copies a text; returns false if the browser does not allow it, or does not say so in time. */
export async function copyText(text: string): Promise<boolean> {
  const late = new Promise<boolean>((resolve) => setTimeout(resolve, COPY_MS, false));
  const copied = async (): Promise<boolean> => {
    await navigator.clipboard.writeText(text);
    return true;
  };
  return Promise.race([copied().catch(() => false), late]);
}
