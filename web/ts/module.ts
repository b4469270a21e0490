// The compiled module of the page. Every widget is an instance of it with separate memory.

import { fetchAsset } from './assets';

/** Set by the build: the name of the wasm file contains a hash of its content. */
declare const WASM_FILE: string;

export class LoadError extends Error {}

/** A complete module, but from another build than this script. */
export class StaleError extends LoadError {
  constructor() {
    super('this page and the program of its widgets are of two versions');
  }
}

/** The section of a module that holds the mark of its build, as `web/wasm-file.mjs` writes it. */
const MARK = 'build';

/** So long may a server say nothing, before or between two parts of the program. */
const SILENCE_MS = 10_000;

type Listener = (share: number) => void;

/** A wasm file beside this script: fetched once, compiled once, for all instances. */
export class ModuleFile {
  readonly #name: string;
  #compiled: Promise<WebAssembly.Module> | undefined;
  #share = 0;
  /** Whether the last attempt failed: a cache may contain a damaged copy. */
  #isRetry = false;
  readonly #listeners = new Set<Listener>();

  constructor(name: string) {
    this.#name = name;
  }

  /** Compiles it, once for the page; `progress` gets the share that has arrived, 0 to 1. */
  load(progress: Listener): Promise<WebAssembly.Module> {
    this.#listeners.add(progress);
    progress(this.#share);
    this.#compiled ??= this.#compile().catch((error: unknown) => {
      this.forget();
      throw error;
    });
    return this.#compiled.finally(() => this.#listeners.delete(progress));
  }

  /** Makes the next attempt bypass every cache. */
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
    // A cache may hold another build under this name.
    this.#isRetry = true;
    const fresh = await this.#attempt();
    if (this.#isOurs(fresh)) return fresh;
    throw new StaleError();
  }

  /** Whether it is of the build whose mark stands in its name; in a file that works alone names have none. */
  #isOurs(module: WebAssembly.Module): boolean {
    const mark = /-([0-9a-f]+)\.wasm$/.exec(this.#name)?.[1];
    if (mark === undefined) return true;
    const marks = WebAssembly.Module.customSections(module, MARK);
    return marks.some((bytes) => new TextDecoder().decode(bytes) === mark);
  }

  async #attempt(): Promise<WebAssembly.Module> {
    const silence = new Silence();
    try {
      return await this.#fetchAndCompile(silence);
    } catch (error) {
      throw silence.isOver ? new LoadError('the server of the program does not answer') : error;
    } finally {
      silence.end();
    }
  }

  async #fetchAndCompile(silence: Silence): Promise<WebAssembly.Module> {
    let response: Response;
    try {
      response = await fetchAsset(this.#name, this.#isRetry, silence.signal);
    } catch {
      throw new LoadError('the program could not be fetched');
    }
    if (!response.ok || response.body === null) {
      throw new LoadError(`the program could not be fetched (${response.status})`);
    }
    const onShare = (share: number): void => this.#tell(share);
    const counted = new Response(count(response.body, expectedLength(response), silence, onShare), {
      // Regardless of the server's type: anything else than wasm is rejected by its first bytes.
      headers: { 'Content-Type': 'application/wasm' },
    });
    try {
      return await WebAssembly.compileStreaming(counted);
    } catch (error) {
      if (error instanceof EvalError || String(error).includes('Content Security Policy')) {
        throw new LoadError("the page's security policy lacks 'wasm-unsafe-eval'");
      }
      throw new LoadError('the program arrived incomplete or is too new for this browser');
    }
  }

  #tell(share: number): void {
    this.#share = share;
    for (const listener of this.#listeners) listener(share);
  }
}

const widgets = new ModuleFile(WASM_FILE);

/** Compiles the module of the widgets, once for the page. */
export function loadModule(progress: Listener): Promise<WebAssembly.Module> {
  return widgets.load(progress);
}

/** Makes the next attempt bypass every cache. */
export function forgetModule(): void {
  widgets.forget();
}

function expectedLength(response: Response): number {
  // With a content encoding the header counts other bytes than those that arrive here.
  const encoded = response.headers.get('Content-Encoding') !== null;
  return encoded ? 0 : Number(response.headers.get('Content-Length') ?? 0);
}

/** Aborts a fetch after too long a silence. */
class Silence {
  readonly #giveUp = new AbortController();
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    this.heard();
  }

  get signal(): AbortSignal {
    return this.#giveUp.signal;
  }

  get isOver(): boolean {
    return this.signal.aborted;
  }

  /** Data have arrived. */
  heard(): void {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#giveUp.abort(), SILENCE_MS);
  }

  /** The transfer is complete. */
  end(): void {
    clearTimeout(this.#timer);
  }
}

function count(
  body: ReadableStream<Uint8Array>,
  expected: number,
  silence: Silence,
  onShare: Listener,
): ReadableStream<Uint8Array> {
  let arrived = 0;
  return body.pipeThrough(
    new TransformStream<Uint8Array, Uint8Array>({
      transform(chunk, controller) {
        silence.heard();
        arrived += chunk.byteLength;
        onShare(expected > 0 ? Math.min(arrived / expected, 1) : arrived / (arrived + 1e6));
        controller.enqueue(chunk);
      },
      // A complete module may take its time to compile.
      flush: () => silence.end(),
    }),
  );
}
