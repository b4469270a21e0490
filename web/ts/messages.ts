// Messages from the page around an embedded widget, and the answers. No message throws: an invalid one is
// answered with an error message.

import { shorten, type Value } from './values';

/** The version of the protocol, contained in every message. */
export const VERSION = 1;

/** Number of rejected values per message that are named; of the others only the number is reported. */
const MOST_REFUSALS = 8;
/** Largest length of a sender's id in an answer. */
const LONGEST_ID = 200;

export type Message = Record<string, unknown>;

/** The addressed widget. */
export interface Addressed {
  /** Sets one parameter; throws if the value is invalid. */
  set(id: string, value: Value): void;
  /** Presses a button; fails if there is none. */
  press(button: string): Promise<void>;
  /** The answer to a `get`. */
  state(): Message;
}

/** Processes a message, if it is for us; `post` sends an answer, `refuse` reports an error. */
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

/** The sender's id of the question. */
function idOf({ id }: Message): string | number | null {
  if (id === undefined || id === null) return null;
  if (typeof id === 'number' || (typeof id === 'string' && id.length <= LONGEST_ID)) return id;
  throw new RangeError(`get takes as \`id\` a number, or a text of at most ${LONGEST_ID} characters`);
}

/** Sets all valid values, even if others are invalid. */
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
