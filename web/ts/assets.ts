// The files that this script loads: fetched from the same folder, or embedded in the standalone module.

import { takeEarly } from './early-request';

let embedded: ((file: string) => Promise<Response>) | undefined;

/** From now on files come from `open` instead of the server. */
export function useEmbeddedFiles(open: (file: string) => Promise<Response>): void {
  embedded = open;
}

/** Fetches a file; a retry bypasses the HTTP cache. */
export function fetchAsset(file: string, isRetry: boolean, signal: AbortSignal): Promise<Response> {
  if (embedded !== undefined) return embedded(file);
  const url = new URL(file, import.meta.url);
  const request = (): Promise<Response> => fetch(url, { cache: isRetry ? 'reload' : 'default', signal });
  const early = isRetry ? undefined : takeEarly(url.href, signal);
  // What failed early may succeed now.
  return early?.catch(request) ?? request();
}

/** The URL of a file; undefined if files are embedded. */
export function assetUrl(file: string): string | undefined {
  return embedded === undefined ? new URL(file, import.meta.url).href : undefined;
}
