// What the page around an embedded widget may say to it, and what it hears in return. Whatever
// arrives, nothing is thrown: what does not fit is refused with an error message.

import { shorten, type Value } from './values';

/** The version of the protocol, which every message carries. */
export const VERSION = 1;

/** So many values of one message are refused by name; of the others, their number is told. */
const MOST_REFUSALS = 8;
/** What comes back with an answer is the sender's own, but not at any length. */
const LONGEST_ID = 200;

export type Message = Record<string, unknown>;

/** The widget that is spoken to. */
export interface Addressed {
  /** Sets one parameter; throws where the value does not fit. */
  set(id: string, value: Value): void;
  /** Presses a button; fails where there is none. */
  press(button: string): Promise<void>;
  /** What a `get` is answered with. */
  state(): Message;
}

/** Acts on what arrived, if it is for us; `post` sends an answer, `refuse` says what was wrong. */
export function receive(
  widget: Addressed,
  data: unknown,
  post: (message: Message) => void,
  refuse: (error: Error) => void,
): void {
  if (!isOurs(data)) return;
  try {
    answer(widget, data, post, refuse);
  } catch (error) {
    refuse(error as Error);
  }
}

function isOurs(data: unknown): data is Message {
  return typeof data === 'object' && data !== null && 'slam' in data;
}

function answer(
  widget: Addressed,
  message: Message,
  post: (message: Message) => void,
  refuse: (error: Error) => void,
): void {
  if (message['slam'] !== VERSION) {
    const spoken = shorten(String(message['slam']));
    throw new RangeError(`this widget speaks version ${VERSION}, not ${spoken}`);
  }
  switch (message['type']) {
    case 'set': {
      const values = message['values'];
      if (typeof values !== 'object' || values === null) {
        throw new TypeError('set takes `values`, an object of parameters');
      }
      setAll(widget, values as Record<string, Value>, refuse);
      break;
    }
    case 'press': {
      const { button } = message;
      if (typeof button !== 'string') throw new TypeError('press takes `button`, a name');
      widget.press(button).catch(refuse);
      break;
    }
    case 'get':
      post({ type: 'state', id: idOf(message), ...widget.state() });
      break;
    default:
      throw new RangeError(
        `there is no message \`${shorten(String(message['type']))}\`; there are set, press, get`,
      );
  }
}

/** The name that the sender gave its question. */
function idOf({ id }: Message): string | number | null {
  if (id === undefined || id === null) return null;
  if (typeof id === 'number' || (typeof id === 'string' && id.length <= LONGEST_ID)) return id;
  throw new RangeError(`get takes as \`id\` a number, or a text of at most ${LONGEST_ID} characters`);
}

/** What does not fit keeps nothing from what does. */
function setAll(
  widget: Addressed,
  values: Record<string, Value>,
  refuse: (error: Error) => void,
): void {
  let refused = 0;
  for (const [id, value] of Object.entries(values)) {
    try {
      widget.set(id, value);
    } catch (error) {
      refused += 1;
      if (refused <= MOST_REFUSALS) refuse(error as Error);
    }
  }
  const more = refused - MOST_REFUSALS;
  if (more > 0) refuse(new RangeError(`${more} more values do not fit, either`));
}
