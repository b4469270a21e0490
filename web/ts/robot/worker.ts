// Maps a log beside the page: the program and the file come first, then the reader's orders. It works in
// slices, and handles orders in between.

import init, { Robot } from '../../pkg-robot/slam_robot.js';
import { textDelivery, type Delivery, type Order, type Report } from './protocol';

/** Length of a slice. */
const SLICE_MS = 40;
/** Interval of the reports about changes. */
const TELL_MS = 150;
/** Delay of expensive work after a drag. */
const DRAG_MS = 250;

/** FileReaderSync reads a file at once, which workers may; TypeScript's library for pages lacks it. */
declare class FileReaderSync {
  readAsArrayBuffer(blob: Blob): ArrayBuffer;
}

let robot: Robot | undefined;
let isHeld = false;
let isScheduled = false;
let busyUntil = 0;
let toldAt = 0;
const waiting: Order[] = [];

// A message to itself waits only for the messages before it, while a timer waits for milliseconds.
const turn = new MessageChannel();
turn.port1.onmessage = (): void => {
  isScheduled = false;
  guard(work);
};

self.addEventListener('message', ({ data }: MessageEvent<Order>) => {
  if ('module' in data) void open(data.module, data.files, data.options);
  else if (robot === undefined) waiting.push(data);
  else guard(() => obey(data));
});

/** Names and sizes of files, and a function that reads a range of one for the program. */
function readable(files: File[]): [string[], Float64Array, (which: number, from: number, to: number) => Uint8Array] {
  const reader = new FileReaderSync();
  const read = (which: number, from: number, to: number): Uint8Array => {
    return new Uint8Array(reader.readAsArrayBuffer((files[which] as File).slice(from, to)));
  };
  return [files.map(({ name }) => name), Float64Array.from(files, ({ size }) => size), read];
}

async function open(module: WebAssembly.Module, files: File[], options: string): Promise<void> {
  try {
    await init({ module_or_path: module });
    robot = new Robot(...readable(files), options);
  } catch (error) {
    // Errors about a file are sentences; any other one is a crash.
    if (error instanceof Error && error.constructor === Error) say({ failed: error.message });
    else say({ crashed: String(error) });
    return;
  }
  for (const order of waiting.splice(0)) guard(() => obey(order));
  schedule();
}

/** A panic ends the program: the host creates another worker. */
function guard(act: () => void): void {
  try {
    act();
  } catch (error) {
    robot = undefined;
    say({ crashed: String(error) });
  }
}

function obey(order: Order): void {
  if (robot === undefined || 'module' in order) return;
  if ('save' in order) save(robot, order.save);
  else if ('reference' in order) grade(robot, order.reference, order.name);
  else if ('locate' in order) locate(robot, order.locate, order.options, order.start);
  else if (order.order === 'pause' || order.order === 'resume') hold(order.order === 'pause');
  else if (order.order === 'crash-for-test') throw new WebAssembly.RuntimeError('crashed on purpose');
  else {
    if (order.order === 'cancel') hold(false);
    robot.order(order.order);
    if (order.order.startsWith('pin')) busyUntil = performance.now() + DRAG_MS;
    tell(robot);
  }
  schedule();
}

function hold(isOn: boolean): void {
  isHeld = isOn;
  say({ deliveries: [textDelivery('paused', '', [isOn ? 1 : 0])] });
}

function save(from: Robot, name: string): void {
  try {
    const bytes = from.file(name);
    say({ saved: name, bytes }, [bytes.buffer]);
  } catch (error) {
    say({ unsaved: name, why: refusal(error) });
  }
}

function locate(on: Robot, log: File[], options: string, start: number[]): void {
  try {
    on.locate(...readable(log), options, Float64Array.from(start));
    if (isHeld) hold(false);
    // Clears the message about the wait.
    say({ deliveries: [textDelivery('answer', '')] });
    tell(on);
  } catch (error) {
    answer(error);
  }
}

function grade(by: Robot, bytes: Uint8Array, name: string): void {
  try {
    by.reference(bytes, name);
    tell(by);
  } catch (error) {
    answer(error);
  }
}

/** Reports an error of the program; a panic propagates. */
function answer(error: unknown): void {
  say({ deliveries: [textDelivery('answer', refusal(error))] });
}

function refusal(error: unknown): string {
  if (!(error instanceof Error) || error instanceof WebAssembly.RuntimeError) throw error;
  return error.message;
}

function schedule(): void {
  if (isScheduled || isHeld || robot === undefined) return;
  isScheduled = true;
  const rest = busyUntil - performance.now();
  if (rest > 0) setTimeout(() => turn.port2.postMessage(0), rest);
  else turn.port2.postMessage(0);
}

function work(): void {
  if (robot === undefined || isHeld) return;
  if (performance.now() < busyUntil) {
    schedule();
    return;
  }
  const end = performance.now() + SLICE_MS;
  let isMore = true;
  while (isMore && performance.now() < end) isMore = robot.step();
  if (!isMore || performance.now() - toldAt > TELL_MS) tell(robot);
  if (isMore) schedule();
}

function tell(what: Robot): void {
  toldAt = performance.now();
  const deliveries = what.updates() as Delivery[];
  const buffers = deliveries.flatMap(({ numbers, bytes }) => [numbers.buffer, bytes.buffer]);
  say({ deliveries }, buffers as ArrayBuffer[]);
}

function say(report: Report, buffers: ArrayBufferLike[] = []): void {
  self.postMessage(report, { transfer: buffers as ArrayBuffer[] });
}
