// Messages from the page around an embedded widget, and the answers. An invalid message is answered with an error; none
// throws.

import { shorten, type Value } from './values';

/** Protocol version, part of every message. */
export const VERSION = 1;

/** Invalid values of a message with an error each; the others are only counted. */
const MAX_ERRORS = 8;
/** Maximum length of an id that is repeated in an answer. */
const MAX_ID_LENGTH = 200;

export type Message = Record<string, unknown>;

/** What messages need of a widget. */
export interface MessageTarget {
  /** Sets one parameter; throws if the value is invalid. */
  set(id: string, value: Value): void;
  /** Presses a button; fails if there is none. */
  press(button: string): Promise<void>;
  /** The answer to a `get`. */
  state(): Message;
}

/** Handles a message of our protocol; `post` sends an answer, `reject` an error. */
export function receive(
  widget: MessageTarget,
  data: unknown,
  post: (message: Message) => void,
  reject: (error: Error) => void,
): void {
  if (!isOurs(data)) return;
  try {
    answer(widget, data, post, reject);
  } catch (error) {
    reject(error as Error);
  }
}

function isOurs(data: unknown): data is Message {
  return typeof data === 'object' && data !== null && 'slam' in data;
}

function answer(
  widget: MessageTarget,
  message: Message,
  post: (message: Message) => void,
  reject: (error: Error) => void,
): void {
  if (message['slam'] !== VERSION) {
    const version = shorten(String(message['slam']));
    throw new RangeError(`this widget speaks version ${VERSION}, not ${version}`);
  }
  switch (message['type']) {
    case 'set': {
      const values = message['values'];
      if (typeof values !== 'object' || values === null) {
        throw new TypeError('set takes `values`, an object of parameters');
      }
      setAll(widget, values as Record<string, Value>, reject);
      break;
    }
    case 'press': {
      const { button } = message;
      if (typeof button !== 'string') throw new TypeError('press takes `button`, a name');
      widget.press(button).catch(reject);
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

/** The id with which the sender recognizes the answer. */
function idOf({ id }: Message): string | number | null {
  if (id === undefined || id === null) return null;
  if (typeof id === 'number' || (typeof id === 'string' && id.length <= MAX_ID_LENGTH)) return id;
  throw new RangeError(`get takes a number as \`id\`, or a text of at most ${MAX_ID_LENGTH} characters`);
}

/** Sets the valid values, and reports the invalid ones. */
function setAll(
  widget: MessageTarget,
  values: Record<string, Value>,
  reject: (error: Error) => void,
): void {
  let rejected = 0;
  for (const [id, value] of Object.entries(values)) {
    try {
      widget.set(id, value);
    } catch (error) {
      rejected += 1;
      if (rejected <= MAX_ERRORS) reject(error as Error);
    }
  }
  const more = rejected - MAX_ERRORS;
  if (more > 0) reject(new RangeError(`${more} more values are invalid`));
}
