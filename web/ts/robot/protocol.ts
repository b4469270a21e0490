// Messages between the page and the worker that maps a log.

import type { NetworkEvent } from './robot-socket';

/**
 * One part of the worker's state, which replaces an earlier one of its kind: for the widget's model the bytes of a report
 * (crates/robots/log_messages), for the page a text (crates/robots/worker/src/update.rs).
 */
export interface Delivery {
  kind: string;
  text: string;
  numbers?: Float64Array;
  bytes?: Uint8Array;
}

/** A file of a log: the browser's, or its bytes for a worker that may not read the page's. */
export type LogFile = File | { name: string; size: number; bytes: ArrayBuffer };

/** To the worker. */
export type Order =
  /** The first message: the program, the files of the log, its options, one per line, and changes to repeat. */
  | { module: WebAssembly.Module; files: LogFile[]; options: string; edits: string }
  /** The first message of a robot that drives: its address in place of the files. */
  | { module: WebAssembly.Module; listen: string; options: string }
  /** What its server says. */
  | { heard: string | ArrayBuffer }
  /** What its network does. */
  | { network: NetworkEvent; seconds: number }
  /** A log to localize on the map, starting near `[x, y, θ]`, or anywhere if `start` is empty. */
  | { locate: LogFile[]; options: string; start: number[] }
  /** A request of the widget that is for the worker, unread. */
  | { order: string }
  | { pause: boolean }
  | { cancel: true }
  | { crash: true }
  | { reference: Uint8Array; name: string }
  | { save: string };

/** From the worker. */
export type Report =
  | { deliveries: Delivery[]; isMapped?: boolean }
  | { saved: string; bytes: Uint8Array }
  /** The worker listens; a scan, or a lost connection, is waited for as long as this. */
  | { listening: true; patienceMs: number }
  /** Texts for the robot's server. */
  | { requests: string[] }
  /** Bytes of the recording. */
  | { recorded: Uint8Array }
  /** Why a file cannot be saved. */
  | { unsaved: string; why: string }
  /** Why the log cannot be used, in one sentence. */
  | { failed: string }
  /** The program crashed. */
  | { crashed: string };

/** A delivery of text, or of text and numbers. */
export function textDelivery(kind: string, text: string, numbers: number[] = []): Delivery {
  return { kind, text, numbers: Float64Array.from(numbers) };
}
