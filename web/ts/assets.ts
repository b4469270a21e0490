// The files beside this script: at addresses or, in a file that has to work alone, inside it.

let carried: ((file: string) => Promise<Response>) | undefined;

/** Reads files from `open` from now on, without any request to a server. */
export function useEmbeddedFiles(open: (file: string) => Promise<Response>): void {
  carried = open;
}

/** Requests a file; a retry bypasses every cache. */
export function fetchAsset(file: string, isRetry: boolean, signal: AbortSignal): Promise<Response> {
  if (carried !== undefined) return carried(file);
  const url = new URL(file, import.meta.url);
  return fetch(url, { cache: isRetry ? 'reload' : 'default', signal });
}

/** The address of a file; undefined if files have no address. */
export function assetUrl(file: string): string | undefined {
  return carried === undefined ? new URL(file, import.meta.url).href : undefined;
}
