// The compiled module of the page. Every widget is an instance of it with separate memory.

import { fetchAsset } from './assets';

/** Set by the build: the name of the wasm file contains a hash of its content. */
declare const WASM_FILE: string;

/** Set by the build: the oldest browsers, as in a sentence. */
declare const BROWSERS: string;

export class LoadError extends Error {}

/** What nobody foresaw, such as a function that the browser lacks: its own words, and what to do. */
export class UnexpectedError extends LoadError {
  constructor(cause: unknown) {
    super(`${String(cause)}. It needs ${BROWSERS}, or a later version`);
  }
}

/** The module does not start: another build, or no memory for it. */
export function startProblem(error: unknown): LoadError {
  const isOutOfMemory = error instanceof RangeError || /memory/i.test(String(error));
  return isOutOfMemory ? new LoadError('the browser gives it no memory; close other tabs, and try again') : new StaleError();
}

/** The module is complete, but from another build than this script. */
export class StaleError extends LoadError {
  constructor() {
    super('this page and the program of its widgets have different versions');
  }
}

/** The custom section with the build id, which `web/wasm-file.mjs` writes. */
const BUILD_ID_SECTION = 'build';

/** Timeout for the response and for each chunk after it. */
export const STALL_TIMEOUT_MS = 10_000;

type Listener = (share: number) => void;

/** A wasm file, fetched and compiled once for all instances. */
export class ModuleFile {
  readonly #name: string;
  #compiled: Promise<WebAssembly.Module> | undefined;
  #share = 0;
  /** Whether to bypass the HTTP cache, which may hold a damaged copy. */
  #isRetry = false;
  readonly #listeners = new Set<Listener>();

  constructor(name: string) {
    this.#name = name;
  }

  /** Compiles the file once for the page; `progress` gets the downloaded share, 0 to 1. */
  load(progress: Listener): Promise<WebAssembly.Module> {
    this.#listeners.add(progress);
    progress(this.#share);
    this.#compiled ??= this.#compile().catch((error: unknown) => {
      this.forget();
      throw error;
    });
    return this.#compiled.finally(() => this.#listeners.delete(progress));
  }

  /** Makes the next attempt bypass the HTTP cache. */
  forget(): void {
    this.#compiled = undefined;
    this.#share = 0;
    this.#isRetry = true;
  }

  async #compile(): Promise<WebAssembly.Module> {
    if (typeof WebAssembly !== 'object') {
      throw new LoadError('this browser has no WebAssembly');
    }
    const module = await this.#attempt();
    if (this.#isOurs(module)) return module;
    // A cache may hold another build under the same name.
    this.#isRetry = true;
    const fresh = await this.#attempt();
    if (this.#isOurs(fresh)) return fresh;
    throw new StaleError();
  }

  /** Whether the module has the build id of its file name. Names in the standalone module have none. */
  #isOurs(module: WebAssembly.Module): boolean {
    const id = /-([0-9a-f]+)\.wasm$/.exec(this.#name)?.[1];
    if (id === undefined) return true;
    const sections = WebAssembly.Module.customSections(module, BUILD_ID_SECTION);
    return sections.some((bytes) => new TextDecoder().decode(bytes) === id);
  }

  async #attempt(): Promise<WebAssembly.Module> {
    const timeout = new StallTimeout();
    try {
      return await this.#fetchAndCompile(timeout);
    } catch (error) {
      throw timeout.hasExpired ? new LoadError('the server of the program does not answer') : error;
    } finally {
      timeout.clear();
    }
  }

  async #fetchAndCompile(timeout: StallTimeout): Promise<WebAssembly.Module> {
    let response: Response;
    try {
      response = await fetchAsset(this.#name, this.#isRetry, timeout.signal);
    } catch (error) {
      // A function that the browser lacks, where files are embedded.
      if (error instanceof ReferenceError) throw error;
      throw new LoadError('the program could not be fetched');
    }
    if (!response.ok || response.body === null) {
      throw new LoadError(`the program could not be fetched (${response.status})`);
    }
    const onShare = (share: number): void => this.#reportProgress(share);
    const module = new Response(withProgress(response.body, expectedLength(response), timeout, onShare), {
      // Overrides the server's type: the magic number already rejects anything but wasm.
      headers: { 'Content-Type': 'application/wasm' },
    });
    try {
      if (typeof WebAssembly.compileStreaming === 'function') return await WebAssembly.compileStreaming(module);
      return await WebAssembly.compile(await module.arrayBuffer());
    } catch (error) {
      if (error instanceof EvalError || String(error).includes('Content Security Policy')) {
        throw new LoadError("the page's security policy lacks 'wasm-unsafe-eval'");
      }
      throw new LoadError(`the program arrived incomplete, or the browser is older than ${BROWSERS}`);
    }
  }

  #reportProgress(share: number): void {
    this.#share = share;
    for (const listener of this.#listeners) listener(share);
  }
}

const widgets = new ModuleFile(WASM_FILE);

/** Compiles the module of the widgets, once for the page. */
export function loadModule(progress: Listener): Promise<WebAssembly.Module> {
  return widgets.load(progress);
}

/** Makes the next attempt bypass the HTTP cache. */
export function forgetModule(): void {
  widgets.forget();
}

function expectedLength(response: Response): number {
  // With a content encoding the header counts compressed bytes, and the stream decompressed ones.
  const encoded = response.headers.get('Content-Encoding') !== null;
  return encoded ? 0 : Number(response.headers.get('Content-Length') ?? 0);
}

/** Aborts a fetch that stalls. */
class StallTimeout {
  readonly #controller = new AbortController();
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    this.restart();
  }

  get signal(): AbortSignal {
    return this.#controller.signal;
  }

  get hasExpired(): boolean {
    return this.signal.aborted;
  }

  restart(): void {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#controller.abort(), STALL_TIMEOUT_MS);
  }

  clear(): void {
    clearTimeout(this.#timer);
  }
}

function withProgress(
  body: ReadableStream<Uint8Array>,
  expected: number,
  timeout: StallTimeout,
  onShare: Listener,
): ReadableStream<Uint8Array> {
  let arrived = 0;
  return body.pipeThrough(
    new TransformStream<Uint8Array, Uint8Array>({
      transform(chunk, controller) {
        timeout.restart();
        arrived += chunk.byteLength;
        onShare(expected > 0 ? Math.min(arrived / expected, 1) : arrived / (arrived + 1e6));
        controller.enqueue(chunk);
      },
      // Compilation after the download has no time limit.
      flush: () => timeout.clear(),
    }),
  );
}
