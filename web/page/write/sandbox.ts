// Runs a reader's function where it can do no harm: in a worker inside a sandboxed frame, without an origin, and whose
// policy allows no connection. The worker is ended if the code gives no answer for a second.
//
// The code is the text of the worker itself, not of an eval: a syntax error then has its line.

/** The result of one call, or its error; `line` is that of the reader's code. */
export type Called = { result: unknown } | { error: string; line: number | undefined };

/** Why nothing ran, or why the code was ended. */
export class NotRun extends Error {
  constructor(message: string, readonly line?: number) {
    super(message);
  }
}

/** Longest time without an answer of running code, ms. */
const PATIENCE_MS = 1000;
/** Longest time until the frame, the worker or the program has started, ms: a busy machine is late. */
const START_MS = 5000;
/** Longest time until a worker that runs takes up a request, ms. */
const TAKE_UP_MS = 3000;

/** Lines before the reader's first line in the text of the worker. */
const LINES_BEFORE = 1;

/** To the worker: calls of the function, the program of the widgets, or an order for it. */
export type Request = { calls: unknown[][] } | { program: ArrayBuffer } | { order: string };

/** A name that the reader's code cannot guess: of what the worker's text keeps from it, and of what is no message of its own. */
function newKey(): string {
  return `slam_${[...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, '0')).join('')}`;
}

/**
 * A result as far as a test reads it: numbers, texts and truth values, also in an array of arrays, or `{chi2, accepted}`.
 * `ch16-mark` reads the same.
 */
const PLAIN = `(function plain(value, depth) {
  if (value === null || ['number', 'boolean', 'string'].includes(typeof value)) return value;
  if (depth === 0 || !['object', 'function'].includes(typeof value)) return undefined;
  if (typeof value.then === 'function') throw new Error('a promise: leave out async');
  const length = value.length;
  if (typeof value === 'object' && typeof length === 'number') {
    const items = [];
    for (let k = 0; k < length && k < 1000; k += 1) items[k] = plain(value[k], depth - 1);
    return items;
  }
  return { chi2: plain(value.chi2, 0), accepted: plain(value.accepted, 0) };
})`.replaceAll('\n', ' ');

/** The text of the worker. It takes its messages before the reader's code runs, which may replace globals. */
function workerText(code: string, name: string, core: string, key: string): string {
  const before = `'use strict'; const ${key} = ((send, on) => ({ post: (told) => send({ key: '${key}', ...told }), on, plain: ${PLAIN} }))(self.postMessage.bind(self), self.addEventListener.bind(self)); ${key}.post({ running: true });`;
  const after = `
;${core}
;(({ post, on, plain }) => {
  const name = ${JSON.stringify(name)};
  const written = typeof ${name} === 'function' ? ${name} : undefined;
  const attempt = (run) => {
    try { post({ result: run() }); }
    catch (error) { post({ error: String(error), stack: String(error && error.stack) }); }
  };
  let execute;
  on('message', async ({ data }) => {
    if (written === undefined) { post({ missing: name }); return; }
    if (data.program !== undefined) {
      try { execute = await __slamCore.start(data.program, name, written); }
      catch (error) { post({ unstarted: String(error) }); return; }
    } else post({ running: true });
    for (const given of data.calls ?? []) attempt(() => plain(written(...given), 2));
    if (data.order !== undefined) attempt(() => execute(data.order, () => post({ working: true })));
    post({ done: true });
  });
  post({ ready: true });
})(${key});`;
  return `${before}\n${code}\n${after}`;
}

/** The page of the frame, which has a policy of its own: that of the page that shows it allows no such script. */
const FRAME = 'your-code.html';

/** What the frame says, or passes on from the worker, in which the reader's code may post anything. */
type Heard = { worker: Told & { key?: string } } | Told;

interface Told {
  started?: boolean;
  rejected?: boolean;
  /** From here on it is the reader's code that takes the time. */
  running?: boolean;
  ready?: boolean;
  working?: boolean;
  done?: boolean;
  missing?: string;
  broken?: string;
  unstarted?: string;
  line?: number;
  result?: unknown;
  error?: string;
  stack?: string;
}

/** A request under way. */
interface Pending {
  answers: Called[];
  patience_ms: number;
  /** The reason if nothing is heard for so long. */
  late(patience_ms: number): NotRun;
  resolve(answers: Called[]): void;
  reject(why: NotRun): void;
}

/** A reader's function in its worker. */
export class Sandbox {
  readonly #frame = document.createElement('iframe');
  readonly #code: string;
  readonly #key = newKey();
  #pending: Pending | undefined;
  #timer: ReturnType<typeof setTimeout> | undefined;
  readonly #hear = ({ source, data }: MessageEvent<Heard>): void => {
    if (source !== this.#frame.contentWindow) return;
    if (!('worker' in data)) this.#heard(data);
    else if (data.worker?.key === this.#key) this.#heard(data.worker);
  };

  private constructor(code: string) {
    this.#code = code;
  }

  /**
   * Starts the worker; with the script of the core it takes a program and orders, too.
   * @throws {NotRun} with a sentence, if it cannot be compiled, gives no answer in time, or may not run here.
   */
  static async start(code: string, name: string, core = ''): Promise<Sandbox> {
    const sandbox = new Sandbox(code);
    const frame = sandbox.#frame;
    frame.hidden = true;
    frame.title = 'Your code runs in this frame';
    frame.setAttribute('sandbox', 'allow-scripts');
    frame.src = new URL(FRAME, document.baseURI).href;
    addEventListener('message', sandbox.#hear);
    const started = sandbox.#wait(START_MS, rejected);
    document.body.append(frame);
    await started;
    const ready = sandbox.#wait(START_MS, unstarted);
    frame.contentWindow?.postMessage({ text: workerText(code, name, core, sandbox.#key) }, '*');
    await ready;
    return sandbox;
  }

  /**
   * The answers to a request; one after the other, never two at a time.
   * @throws {NotRun} with a sentence; the worker is then ended.
   */
  ask(request: Request): Promise<Called[]> {
    const answered = 'program' in request ? this.#wait(START_MS, unstarted) : this.#wait(TAKE_UP_MS, slow);
    this.#frame.contentWindow?.postMessage({ request }, '*');
    return answered;
  }

  /** Ends the worker. */
  end(): void {
    clearTimeout(this.#timer);
    removeEventListener('message', this.#hear);
    this.#frame.remove();
    this.#pending?.reject(new NotRun('Your code was stopped.'));
    this.#pending = undefined;
  }

  /** Waits for what begins now; `late` is the reason if it does not. */
  #wait(patience_ms: number, late: Pending['late']): Promise<Called[]> {
    return new Promise((resolve, reject) => {
      this.#pending = { answers: [], patience_ms, late, resolve, reject };
      this.#wind(this.#pending);
    });
  }

  /** Ends the worker if nothing is heard for too long. */
  #wind({ patience_ms, late }: Pending): void {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#fail(late(patience_ms)), patience_ms);
  }

  #fail(why: NotRun): void {
    this.#pending?.reject(why);
    this.#pending = undefined;
    this.end();
  }

  #heard(told: Told): void {
    const pending = this.#pending;
    if (pending === undefined) return;
    if (told.running === true) Object.assign(pending, { patience_ms: PATIENCE_MS, late: slow });
    this.#wind(pending);
    if (told.rejected === true) {
      this.#fail(rejected());
    } else if (told.missing !== undefined) {
      this.#fail(new NotRun(`There is no function ${told.missing}. Keep its name.`));
    } else if (told.unstarted !== undefined) {
      this.#fail(new NotRun(`The widgets’ program did not start alongside your code (${told.unstarted}). ${AGAIN}`));
    } else if (told.broken !== undefined) {
      this.#fail(new NotRun(told.broken.replace(/^Uncaught /, ''), lineOf(told.line, this.#code)));
    } else if (told.done === true || told.ready === true || told.started === true) {
      clearTimeout(this.#timer);
      this.#pending = undefined;
      pending.resolve(pending.answers);
    } else if (told.working !== true && told.running !== true) {
      pending.answers.push(told.error === undefined ? { result: told.result } : { error: told.error, line: lineIn(told.stack ?? '', this.#code) });
    }
  }
}

/**
 * Calls the function `name` of the code once with each list of arguments.
 * @throws {NotRun} as {@link Sandbox}.
 */
export async function call(code: string, name: string, calls: unknown[][]): Promise<Called[]> {
  const sandbox = await Sandbox.start(code, name);
  try {
    return await sandbox.ask({ calls });
  } finally {
    sandbox.end();
  }
}

function rejected(): NotRun {
  return new NotRun('The policy of this page does not let code run here. Open the chapter’s own page.');
}

const AGAIN = 'Close other tabs and press the button again, or reload the page.';

function unstarted(patience_ms: number): NotRun {
  return new NotRun(`The browser did not start your code within ${patience_ms / 1000} s. ${AGAIN}`);
}

function slow(patience_ms: number): NotRun {
  return new NotRun(`There was no answer for ${patience_ms / 1000} s, and your code was stopped. Is there an infinite loop?`);
}

/** A line of the worker's text as a line of the code. */
function lineOf(line: number | undefined, code: string): number | undefined {
  const own = (line ?? 0) - LINES_BEFORE;
  return own >= 1 ? Math.min(own, code.split('\n').length) : undefined;
}

/** The first place of a stack in the code. */
function lineIn(stack: string, code: string): number | undefined {
  const lines = code.split('\n').length;
  for (const [, line] of stack.matchAll(/blob:[^\s)]*?:(\d+):\d+/g)) {
    const own = Number(line) - LINES_BEFORE;
    // After the reader's code stands the core.
    if (own >= 1 && own <= lines) return own;
  }
  return undefined;
}
