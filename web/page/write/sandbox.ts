// Runs a reader's function where it can do no harm: in a worker inside a sandboxed frame, without an origin, and whose
// policy allows no connection. The worker is ended if it gives no answer for a second.
//
// The code is the text of the worker itself, not of an eval: a syntax error then has its line.

/** The result of one call, or its error; `line` is that of the reader's code. */
export type Called = { result: unknown } | { error: string; line: number | undefined };

/** Why nothing ran. */
export class NotRun extends Error {
  constructor(message: string, readonly line?: number) {
    super(message);
  }
}

/** Longest time without an answer, ms. */
const PATIENCE_MS = 1000;
/** Longest time until the frame has started, ms: a strict policy of the page stops its script. */
const START_MS = 5000;
const POLICY = "default-src 'none'; script-src 'unsafe-inline' blob:; worker-src blob:";

/** Lines before the reader's first line in the text of the worker. */
const LINES_BEFORE = 1;

/** The text of the worker. It takes its messages before the reader's code runs, which may replace globals. */
function workerText(code: string, name: string): string {
  const before = `'use strict'; const __slam = ((post, on) => ({ post, on }))(self.postMessage.bind(self), self.addEventListener.bind(self));`;
  const after = `
;__slam.on('message', ({ data }) => {
  const name = ${JSON.stringify(name)};
  const written = typeof ${name} === 'function' ? ${name} : undefined;
  if (written === undefined) { __slam.post({ missing: name }); return; }
  for (const given of data) {
    try { __slam.post({ result: written(...given) }); }
    catch (error) { __slam.post({ error: String(error), stack: String(error && error.stack) }); }
  }
});
__slam.post({ ready: true });`;
  return `${before}\n${code}\n${after}`;
}

/** The page of the frame: it starts the worker and passes messages on. Without the frame the worker ends. */
const FRAME = `<!doctype html><meta http-equiv="Content-Security-Policy" content="${POLICY}"><script>
const tell = (message) => parent.postMessage(message, '*');
addEventListener('message', ({ data: { text, calls } }) => {
  let worker;
  try { worker = new Worker(URL.createObjectURL(new Blob([text], { type: 'text/javascript' }))); }
  catch { tell({ refused: true }); return; }
  worker.onerror = (event) => {
    event.preventDefault();
    tell(event.message ? { broken: event.message, line: event.lineno } : { refused: true });
  };
  worker.onmessage = ({ data }) => {
    if (data.ready) worker.postMessage(calls);
    tell(data);
  };
});
tell({ started: true });
</script>`;

interface Told {
  started?: boolean;
  refused?: boolean;
  ready?: boolean;
  missing?: string;
  broken?: string;
  line?: number;
  result?: unknown;
  error?: string;
  stack?: string;
}

/**
 * Calls the function `name` of the code once with each list of arguments.
 * @throws {NotRun} with a sentence, if it cannot be compiled, gives no answer in time, or may not run here.
 */
export async function call(code: string, name: string, calls: unknown[][]): Promise<Called[]> {
  const frame = document.createElement('iframe');
  frame.hidden = true;
  frame.title = 'Your code runs in this frame';
  frame.setAttribute('sandbox', 'allow-scripts');
  frame.srcdoc = FRAME;
  const answers: Called[] = [];
  let timer: ReturnType<typeof setTimeout> | undefined;
  let hear: ((event: MessageEvent<Told>) => void) | undefined;
  try {
    await new Promise<void>((resolve, reject) => {
      const refused = new NotRun('The policy of this page does not let code run here. Open the chapter’s own page.');
      const slow = new NotRun(`There was no answer for ${PATIENCE_MS / 1000} s, and your code was ended. Is there a loop without end?`);
      const wait = (time_ms: number, why: NotRun): void => {
        clearTimeout(timer);
        timer = setTimeout(() => reject(why), time_ms);
      };
      hear = ({ source, data }) => {
        if (source !== frame.contentWindow) return;
        wait(PATIENCE_MS, slow);
        if (data.started === true) {
          frame.contentWindow?.postMessage({ text: workerText(code, name), calls }, '*');
        } else if (data.refused === true) {
          reject(refused);
        } else if (data.missing !== undefined) {
          reject(new NotRun(`There is no function ${data.missing}. Keep its name.`));
        } else if (data.broken !== undefined) {
          reject(new NotRun(data.broken.replace(/^Uncaught /, ''), lineOf(data.line, code)));
        } else if (data.ready !== true) {
          answers.push(data.error === undefined ? { result: data.result } : { error: data.error, line: lineIn(data.stack ?? '', code) });
          if (answers.length === calls.length) resolve();
        }
      };
      addEventListener('message', hear);
      wait(START_MS, refused);
      document.body.append(frame);
    });
  } finally {
    clearTimeout(timer);
    if (hear !== undefined) removeEventListener('message', hear);
    // It ends the worker, too.
    frame.remove();
  }
  return answers;
}

/** A line of the worker's text as a line of the code. */
function lineOf(line: number | undefined, code: string): number | undefined {
  const own = (line ?? 0) - LINES_BEFORE;
  return own >= 1 ? Math.min(own, code.split('\n').length) : undefined;
}

/** The first place of a stack in the code. */
function lineIn(stack: string, code: string): number | undefined {
  const place = /blob:[^\s)]*?:(\d+):\d+/.exec(stack)?.[1];
  return place === undefined ? undefined : lineOf(Number(place), code);
}
