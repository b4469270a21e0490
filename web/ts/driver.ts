// A function of the reader in place of a part of the estimator: the widget orders, the driver runs, the widget shows.

import type { Widget } from '../pkg/glue.js';
import { fetchAsset } from './assets';
import { deliverTo } from './robot/log-mapper';
import { textDelivery, type Delivery } from './robot/protocol';

/** Set by the build: the module without egui. */
declare const ROBOT_WASM_FILE: string;

/** Longest time to fetch it, ms. */
const FETCH_TIMEOUT_MS = 60_000;

/** The bytes of the core: a sandboxed frame cannot be given a compiled module. */
export async function coreBytes(): Promise<ArrayBuffer> {
  const response = await fetchAsset(ROBOT_WASM_FILE, false, AbortSignal.timeout?.(FETCH_TIMEOUT_MS));
  if (!response.ok) throw new Error(`status ${response.status}`);
  return response.arrayBuffer();
}

/** Runs a reader's function on what a widget orders. */
export interface Driver {
  /** The name of the function: `svd_align`. */
  readonly name: string;
  /** The answers of the function to an order; undefined if it was ended. */
  run(order: string): Promise<Float64Array | undefined>;
}

/** Whether an order of a widget is for its driver. */
export function isForDriver(order: string): boolean {
  return order.startsWith('your-code ');
}

/** Lets a reader's function drive the widget, or ours. */
export function seat(widget: Widget, driver: Driver | undefined): void {
  deliverTo(widget, textDelivery('your-code', driver?.name ?? ''));
}

/** Runs an order, and returns what to deliver. */
export async function answersTo(order: string, driver: Driver | undefined): Promise<Delivery[]> {
  const numbers = await driver?.run(order);
  return numbers === undefined ? [] : [{ ...textDelivery('your-answers', order), numbers }];
}
