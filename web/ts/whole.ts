// The anywidget module as one file that works alone: what a notebook gets that reaches no server.

import { carryProgram } from './beside';
// @ts-expect-error: the build puts the compressed program here, as text.
import program from 'program.wasm.gz';

carryProgram(async () => {
  const packed = Uint8Array.from(atob(program as string), (digit) => digit.charCodeAt(0));
  const body = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(body);
});

export { default } from './anywidget';
