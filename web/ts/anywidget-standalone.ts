// The anywidget module with all files embedded, for a notebook without a server.

import { useEmbeddedFiles } from './assets';
// @ts-expect-error: web/package.mjs resolves it to the gzipped files as base64, by name.
import embedded from 'embedded-files';

useEmbeddedFiles(async (file) => {
  const text = (embedded as Record<string, string>)[file];
  if (text === undefined) throw new Error(`${file} is not embedded`);
  const packed = Uint8Array.from(atob(text), (digit) => digit.charCodeAt(0));
  const body = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(body);
});

export { default } from './anywidget';
