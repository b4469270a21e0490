// embed.html: one widget in a frame, and its messages to and from the surrounding page. With `?exercise=5` it shows an
// exercise with its widgets, which also reports to a learning management system.
//
// Every message contains `slam: 1`, the version of this protocol. Other messages are ignored; an invalid one is answered
// with an error.
//
//   in   {slam: 1, type: 'set', values: {heading: 60}}   {slam: 1, type: 'press', button: 'play'}
//        {slam: 1, type: 'get', id?: 'any'}
//   out  ready, changed, result, state (answers get), error, size; answer, from an exercise

// @ts-expect-error: a separate bundle.
import { SlamWidget as Element, widgets as schemas } from './slam-widget.js';
import type { SlamWidget } from './element';
import { showExercise } from './exercise';
import { readQuery } from './links';
import { receive, VERSION, type Message } from './messages';
import { restrict } from './restrict';
import type { WidgetSpec } from './schema';
import type { Value } from './values';

/** Set by the build: what a page may load. */
declare const POLICY: string;

restrict(POLICY);

const [first] = schemas as WidgetSpec[];

const main = document.querySelector('main') ?? document.body;
const linked = readQuery(location.search);
const named = linked !== undefined && 'widget' in linked ? linked : undefined;
const spec = named?.widget ?? first;

const exercise = new URLSearchParams(location.search).get('exercise');
if (exercise === null) showWidget();
else void showQuestions(exercise);

function showWidget(): void {
  const widget = new (Element as typeof SlamWidget)();
  setUp(widget);
  main.querySelector('.absent')?.remove();
  main.append(widget);
  listen(widget);
  for (const message of linked?.problems ?? ['Name a widget, such as ?w=16.1']) reportProblem(message);
}

/** Shows an exercise; its answers go to the surrounding page. */
async function showQuestions(id: string): Promise<void> {
  document.addEventListener('slam-predict', ({ detail }) => post({ type: 'answer', ...detail }));
  new ResizeObserver(tellSize).observe(main);
  try {
    const title = await showExercise(main, id);
    document.title = title;
  } catch (error) {
    reportProblem(error instanceof Error ? error.message : String(error));
  }
  main.querySelector('.absent')?.remove();
}

/** Applies the address to the widget, and its title to the page. */
function setUp(widget: SlamWidget): void {
  widget.setAttribute('name', spec?.id ?? '');
  for (const [id, text] of named?.values ?? []) widget.setAttribute(id, text);
  const theme = new URLSearchParams(location.search).get('theme');
  if (theme === 'light' || theme === 'dark') {
    widget.setAttribute('theme', theme);
    main.style.colorScheme = theme;
  }
  document.title = spec?.title ?? document.title;
  main.querySelector('h1')?.replaceChildren(document.title);
}

/** Reports a problem with the address to the reader and to the surrounding page. */
function reportProblem(message: string): void {
  const line = document.createElement('p');
  line.textContent = message;
  main.querySelector('.problems')?.append(line);
  post({ type: 'error', name: spec?.id ?? null, kind: 'address', message });
}

function listen(element: SlamWidget): void {
  const detail = (event: Event): Message => (event as CustomEvent<Message>).detail;
  element.addEventListener('slam-ready', (event) => {
    post({ type: 'ready', ...detail(event) });
    // The surrounding page may have missed the first size.
    tellSize();
  });
  element.addEventListener('slam-change', (event) => post({ type: 'changed', ...detail(event) }));
  element.addEventListener('slam-result', (event) => post({ type: 'result', ...detail(event) }));
  element.addEventListener('slam-error', (event) => post({ type: 'error', ...detail(event) }));
  new ResizeObserver(tellSize).observe(main);
  const addressed = {
    set: (id: string, value: Value) => element.set(id, value),
    press: (button: string) => element.press(button),
    state: () => ({
      name: element.getAttribute('name'),
      value: element.value,
      outcome: element.outcome ?? null,
      summary: element.summary,
      ...size(),
    }),
  };
  window.addEventListener('message', (event: MessageEvent<unknown>) => {
    if (event.source === window.parent) receive(addressed, event.data, post, reject);
  });
}

function reject({ message }: Error): void {
  post({ type: 'error', name: spec?.id ?? null, kind: 'message', message });
}

/** The size of the content, in CSS pixels. */
function size(): { width: number; height: number } {
  const { width, height } = main.getBoundingClientRect();
  return { width: Math.ceil(width), height: Math.ceil(height) };
}

function tellSize(): void {
  const { width, height } = size();
  post({ type: 'size', width, height });
  // The message that Canvas and other learning management systems expect.
  const lti = { subject: 'lti.frameResize', height };
  if (window.parent !== window) window.parent.postMessage(JSON.stringify(lti), '*');
}

/** Posts to any origin: messages are not secret, and a sandboxed frame does not know the origin of its parent. */
function post(message: Message): void {
  if (window.parent !== window) window.parent.postMessage({ slam: VERSION, ...message }, '*');
}
