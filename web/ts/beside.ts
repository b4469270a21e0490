// What the build put beside this script, and where it is: at addresses, or, in a file that has to work alone, inside.

/** Set by the build: the wasm file's name holds a hash of its content. */
declare const WASM_FILE: string;

let carried: (() => Promise<Response>) | undefined;

/** From now on the program comes from `open`, and nothing is asked of any server. */
export function carryProgram(open: () => Promise<Response>): void {
  carried = open;
}

/** Asks for the compiled program; an attempt after one in vain goes past every cache. */
export function openProgram(isRetry: boolean, signal: AbortSignal): Promise<Response> {
  if (carried !== undefined) return carried();
  const url = new URL(WASM_FILE, import.meta.url);
  return fetch(url, { cache: isRetry ? 'reload' : 'default', signal });
}

/** The address of a file beside this script; none where nothing stands beside it. */
export function addressOf(file: string): string | undefined {
  return carried === undefined ? new URL(file, import.meta.url).href : undefined;
}
