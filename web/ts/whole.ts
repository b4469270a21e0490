// The anywidget module as one file that works alone: what a notebook gets that reaches no server.

import { carryFiles } from './beside';
// @ts-expect-error: the build puts the compressed program here, as text.
import program from 'program.wasm.gz';

/** Set by the build: the name of the one file that is inside. */
declare const WASM_FILE: string;

carryFiles(async (file) => {
  if (file !== WASM_FILE) throw new Error(`${file} is not inside`);
  const packed = Uint8Array.from(atob(program as string), (digit) => digit.charCodeAt(0));
  const body = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(body);
});

export { default } from './anywidget';
