// A file that is requested before the script that needs it has run: the two share only the window.

interface EarlyRequest {
  href: string;
  response: Promise<Response>;
  abort: () => void;
}

const holder: Window & { slamEarly?: EarlyRequest } = window;

/** Requests a file for {@link takeEarly}. */
export function requestEarly(href: string): void {
  const controller = new AbortController();
  const response = fetch(href, { signal: controller.signal });
  // Who takes it hears of its failure; if nobody does, it is none.
  response.catch(() => undefined);
  holder.slamEarly = { href, response, abort: () => controller.abort() };
}

/** The response of an early request, once, which `signal` then aborts. */
export function takeEarly(href: string, signal: AbortSignal): Promise<Response> | undefined {
  const early = holder.slamEarly;
  if (early?.href !== href) return undefined;
  delete holder.slamEarly;
  signal.addEventListener('abort', early.abort);
  return early.response;
}
