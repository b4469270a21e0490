// What the widget's host and the worker that maps a log say to each other.

/** One part of what the worker knows, as the widget's model takes it. */
export interface Delivery {
  kind: string;
  text: string;
  numbers: Float64Array;
  bytes: Uint8Array;
}

/** To the worker. */
export type Order =
  /** Comes first: the program, the files of the log, and the options for it, a line each. */
  | { module: WebAssembly.Module; files: File[]; options: string }
  /** Another log, for the map: where its robot was, at first about `[x, y, θ]`, or anywhere. */
  | { locate: File[]; options: string; start: number[] }
  | { order: string }
  | { reference: Uint8Array; name: string }
  | { save: string };

/** From the worker. */
export type Report =
  | { deliveries: Delivery[] }
  | { saved: string; bytes: Uint8Array }
  /** Why a file cannot be saved. */
  | { unsaved: string; why: string }
  /** The file cannot be used, in one sentence. */
  | { failed: string }
  /** The program broke. */
  | { crashed: string };

const NONE = new Uint8Array();

/** A delivery of words alone, or of words and numbers. */
export function told(kind: string, text: string, numbers: number[] = []): Delivery {
  return { kind, text, numbers: Float64Array.from(numbers), bytes: NONE };
}
