// Pages that are opened from the disk: what they fetch is inside the script offline-files.js.

/** By their paths from the page: scripts as text, other files as base64 of gzip. */
const files = (globalThis as unknown as { slamFiles: Record<string, string> }).slamFiles;

const TYPES: Record<string, string> = { wasm: 'application/wasm', json: 'application/json' };

/** The path of a file that is inside; undefined for other addresses. */
function inside(address: string | URL): string | undefined {
  const url = new URL(address, document.baseURI);
  const folder = new URL('.', document.baseURI).href;
  const path = url.href.startsWith(folder) ? url.pathname.slice(new URL(folder).pathname.length) : '';
  return path in files ? path : undefined;
}

const fetchOutside = globalThis.fetch;
globalThis.fetch = (input, init) => {
  const path = input instanceof Request ? undefined : inside(input);
  if (path === undefined) return fetchOutside(input, init);
  if (path.endsWith('.js')) return Promise.resolve(new Response(files[path]));
  const packed = Uint8Array.from(atob(files[path] ?? ''), (digit) => digit.charCodeAt(0));
  const body = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  const type = TYPES[path.split('.').at(-1) ?? ''] ?? 'text/plain';
  return Promise.resolve(new Response(body, { headers: { 'Content-Type': type } }));
};

globalThis.Worker = class extends Worker {
  constructor(address: string | URL, options?: WorkerOptions) {
    const path = inside(address);
    super(path === undefined ? address : `data:text/javascript,${encodeURIComponent(files[path] ?? '')}`, options);
  }
};

export {};
