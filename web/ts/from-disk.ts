// Replaces fetch and Worker in a page opened from the disk: its files are embedded in the script offline-files.js.

/** Files by their paths relative to the page: scripts as text, others gzipped as base64. */
const files = (globalThis as unknown as { slamFiles: Record<string, string> }).slamFiles;

const TYPES: Record<string, string> = { wasm: 'application/wasm', json: 'application/json' };

/** The path of an embedded file; undefined for other addresses. */
function embeddedPath(address: string | URL): string | undefined {
  const url = new URL(address, document.baseURI);
  const folder = new URL('.', document.baseURI).href;
  const path = url.href.startsWith(folder) ? url.pathname.slice(new URL(folder).pathname.length) : '';
  return path in files ? path : undefined;
}

const originalFetch = globalThis.fetch;
globalThis.fetch = async (input, init) => {
  const path = input instanceof Request ? undefined : embeddedPath(input);
  if (path === undefined) return originalFetch(input, init);
  if (path.endsWith('.js')) return new Response(files[path]);
  const packed = Uint8Array.from(atob(files[path] ?? ''), (digit) => digit.charCodeAt(0));
  const body = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  const type = TYPES[path.split('.').at(-1) ?? ''] ?? 'text/plain';
  return new Response(body, { headers: { 'Content-Type': type } });
};

globalThis.Worker = class extends Worker {
  constructor(address: string | URL, options?: WorkerOptions) {
    const path = embeddedPath(address);
    super(path === undefined ? address : `data:text/javascript,${encodeURIComponent(files[path] ?? '')}`, options);
  }
};

export {};
