// The anywidget module as one self-contained file, for a notebook without a server.

import { useEmbeddedFiles } from './assets';
// @ts-expect-error: the build puts the compressed files here, as text by their names.
import carried from 'embedded-files';

useEmbeddedFiles(async (file) => {
  const text = (carried as Record<string, string>)[file];
  if (text === undefined) throw new Error(`${file} is not inside`);
  const packed = Uint8Array.from(atob(text), (digit) => digit.charCodeAt(0));
  const body = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(body);
});

export { default } from './anywidget';
