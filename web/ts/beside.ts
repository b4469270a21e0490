// What the build put beside this script: at addresses, or, in a file that has to work alone, inside.

let carried: ((file: string) => Promise<Response>) | undefined;

/** From now on files come from `open`, and nothing is asked of any server. */
export function carryFiles(open: (file: string) => Promise<Response>): void {
  carried = open;
}

/** Asks for a file; an attempt after one in vain goes past every cache. */
export function openFile(file: string, isRetry: boolean, signal: AbortSignal): Promise<Response> {
  if (carried !== undefined) return carried(file);
  const url = new URL(file, import.meta.url);
  return fetch(url, { cache: isRetry ? 'reload' : 'default', signal });
}

/** The address of a file; none where no file has one. */
export function addressOf(file: string): string | undefined {
  return carried === undefined ? new URL(file, import.meta.url).href : undefined;
}
