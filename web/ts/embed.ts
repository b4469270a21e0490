// embed.html: one widget that fills a frame, and its conversation with the page around.
//
// Every message carries `slam: 1`, the version of this protocol. Messages of other programs are
// none of our business; one of ours that does not fit is refused with an error message.
//
//   in   {slam: 1, type: 'set', values: {heading: 60}}   {slam: 1, type: 'press', button: 'play'}
//        {slam: 1, type: 'get', id?: 'any'}
//   out  ready, changed, result, state (answers get), error, size

// @ts-expect-error: stays a file of its own beside this one.
import { SlamWidget as Element, widgets as schemas } from './slam-widget.js';
import type { SlamWidget } from './element';
import { readQuery } from './links';
import type { WidgetSpec } from './schema';
import type { Value } from './values';

const VERSION = 1;

type Message = Record<string, unknown>;

const widget = new (Element as typeof SlamWidget)();
const problems = open(widget);
document.body.append(widget);
for (const message of problems) post({ type: 'error', message });
listen(widget);

/** Sets the widget up from the address; returns what was wrong with it. */
function open(element: SlamWidget): string[] {
  const linked = readQuery(location.search);
  const [first] = schemas as WidgetSpec[];
  const known = linked !== undefined && 'widget' in linked ? linked : undefined;
  element.setAttribute('name', known?.widget.id ?? first?.id ?? '');
  for (const [id, text] of known?.values ?? []) element.setAttribute(id, text);
  const theme = new URLSearchParams(location.search).get('theme');
  if (theme === 'light' || theme === 'dark') element.setAttribute('theme', theme);
  if (linked === undefined) return ['The address names no widget: ?w=16.1'];
  return linked.problems;
}

function listen(element: SlamWidget): void {
  const detail = (event: Event): Message => (event as CustomEvent<Message>).detail;
  element.addEventListener('slam-ready', (event) => post({ type: 'ready', ...detail(event) }));
  element.addEventListener('slam-change', (event) => post({ type: 'changed', ...detail(event) }));
  element.addEventListener('slam-result', (event) => post({ type: 'result', ...detail(event) }));
  element.addEventListener('slam-error', (event) => post({ type: 'error', ...detail(event) }));
  new ResizeObserver(() => tellSize(element)).observe(element);
  window.addEventListener('message', (event: MessageEvent<unknown>) => {
    const { data } = event;
    if (event.source !== window.parent || !isOurs(data)) return;
    try {
      answer(element, data);
    } catch (error) {
      post({ type: 'error', kind: 'message', message: (error as Error).message });
    }
  });
}

function isOurs(data: unknown): data is Message {
  return typeof data === 'object' && data !== null && 'slam' in data;
}

function answer(element: SlamWidget, message: Message): void {
  if (message['slam'] !== VERSION) {
    throw new RangeError(`this widget speaks version ${VERSION}, not ${String(message['slam'])}`);
  }
  switch (message['type']) {
    case 'set': {
      const values = message['values'];
      if (typeof values !== 'object' || values === null) {
        throw new TypeError('set takes `values`, an object of parameters');
      }
      for (const [id, value] of Object.entries(values)) element.set(id, value as Value);
      break;
    }
    case 'press': {
      const { button } = message;
      if (typeof button !== 'string') throw new TypeError('press takes `button`, a name');
      element.press(button).catch((error: Error) => {
        post({ type: 'error', kind: 'message', message: error.message });
      });
      break;
    }
    case 'get':
      post({
        type: 'state',
        id: message['id'] ?? null,
        name: element.getAttribute('name'),
        value: element.value,
        outcome: element.outcome ?? null,
        summary: element.summary,
      });
      break;
    default:
      throw new RangeError(
        `there is no message \`${String(message['type']).slice(0, 60)}\`; there are set, press, get`,
      );
  }
}

function tellSize(element: SlamWidget): void {
  const { width, height } = element.getBoundingClientRect();
  post({ type: 'size', width: Math.ceil(width), height: Math.ceil(height) });
  // What learning management systems listen for.
  const lti = { subject: 'lti.frameResize', height: Math.ceil(height) };
  if (window.parent !== window) window.parent.postMessage(JSON.stringify(lti), '*');
}

/** Nothing that goes out is secret, and a sandboxed frame does not know who is around it. */
function post(message: Message): void {
  if (window.parent !== window) window.parent.postMessage({ slam: VERSION, ...message }, '*');
}
