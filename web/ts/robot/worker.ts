// The worker that maps a log. The first message has the program and the files, or the address of a robot; later ones have
// what it says and the reader's orders. It works in time slices, and handles orders in between.

import init, { LogMapper, patienceMs } from '../../pkg-robot/slam_robot.js';
import { textDelivery, type Delivery, type LogFile, type Order, type Report } from './protocol';

/** Length of a time slice. */
const SLICE_MS = 40;
/** Interval of progress reports. */
const REPORT_MS = 150;
/** Debounces expensive work during a drag. */
const DRAG_MS = 250;

/** Exists only in workers, and so is not in TypeScript's library for pages. */
declare class FileReaderSync {
  readAsArrayBuffer(blob: Blob): ArrayBuffer;
}

/** The first message. */
type Start = Extract<Order, { module: WebAssembly.Module }>;

let robot: LogMapper | undefined;
let isPaused = false;
let isScheduled = false;
let isReportDue = false;
let busyUntil = 0;
let reportedAt = 0;
const waiting: Order[] = [];

// A message to itself is handled after the messages before it, without the minimum delay of a timer.
const nextSlice = new MessageChannel();
nextSlice.port1.onmessage = (): void => {
  isScheduled = false;
  guard(work);
};

self.addEventListener('message', ({ data }: MessageEvent<Order>) => {
  if ('module' in data) void open(data);
  else if (robot === undefined) waiting.push(data);
  else guard(() => execute(data));
});

/** Names and sizes of files, and a function that reads a range of one. */
function readable(files: LogFile[]): [string[], Float64Array, (which: number, from: number, to: number) => Uint8Array] {
  const reader = new FileReaderSync();
  const read = (which: number, from: number, to: number): Uint8Array => {
    const file = files[which] as LogFile;
    return new Uint8Array(file instanceof Blob ? reader.readAsArrayBuffer(file.slice(from, to)) : file.bytes.slice(from, to));
  };
  return [files.map(({ name }) => name), Float64Array.from(files, ({ size }) => size), read];
}

async function open(start: Start): Promise<void> {
  try {
    await init({ module_or_path: start.module });
    if ('listen' in start) {
      robot = LogMapper.listen(start.listen, start.options);
      post({ listening: true, patienceMs: patienceMs() });
    } else {
      robot = new LogMapper(...readable(start.files), start.options);
      robot.repeat(start.edits);
    }
  } catch (error) {
    // A plain Error is about the file, any subclass is a crash.
    if (error instanceof Error && error.constructor === Error) post({ failed: error.message });
    else post({ crashed: String(error) });
    return;
  }
  for (const order of waiting.splice(0)) guard(() => execute(order));
  schedule();
}

/** Reports a panic; the page then starts another worker. */
function guard(act: () => void): void {
  try {
    act();
  } catch (error) {
    robot = undefined;
    post({ crashed: String(error) });
  }
}

function execute(order: Order): void {
  if (robot === undefined || 'module' in order) return;
  if ('heard' in order) hear(robot, order.heard);
  else if ('network' in order) {
    robot.network(order.network, order.seconds);
    reportChanges(robot);
  } else if ('save' in order) save(robot, order.save);
  else if ('reference' in order) grade(robot, order.reference, order.name);
  else if ('locate' in order) locate(robot, order.locate, order.options, order.start);
  else if ('pause' in order) setPaused(order.pause);
  else if ('crash' in order) throw new WebAssembly.RuntimeError('crashed on purpose');
  else if ('cancel' in order) {
    setPaused(false);
    robot.cancel();
    reportChanges(robot);
  } else {
    if (robot.order(order.order)) busyUntil = performance.now() + DRAG_MS;
    reportChanges(robot);
  }
  schedule();
}

function hear(by: LogMapper, message: string | ArrayBuffer): void {
  if (typeof message === 'string') by.hearText(message);
  else by.hearBytes(new Uint8Array(message));
  const requests = by.requests();
  if (requests.length > 0) post({ requests });
}

function setPaused(isOn: boolean): void {
  isPaused = isOn;
  post({ deliveries: [textDelivery('paused', '', [isOn ? 1 : 0])] });
}

function save(from: LogMapper, name: string): void {
  try {
    const bytes = from.file(name);
    post({ saved: name, bytes }, [bytes.buffer]);
  } catch (error) {
    post({ unsaved: name, why: sentenceOf(error) });
  }
}

function locate(on: LogMapper, log: LogFile[], options: string, start: number[]): void {
  try {
    on.locate(...readable(log), options, Float64Array.from(start));
    if (isPaused) setPaused(false);
    // Clears the message that the log waits for the map.
    post({ deliveries: [textDelivery('answer', '')] });
    reportChanges(on);
  } catch (error) {
    reportError(error);
  }
}

function grade(by: LogMapper, bytes: Uint8Array, name: string): void {
  try {
    by.reference(bytes, name);
    reportChanges(by);
  } catch (error) {
    reportError(error);
  }
}

/** Reports an error of the program; rethrows a panic. */
function reportError(error: unknown): void {
  post({ deliveries: [textDelivery('answer', sentenceOf(error))] });
}

function sentenceOf(error: unknown): string {
  if (!(error instanceof Error) || error instanceof WebAssembly.RuntimeError) throw error;
  return error.message;
}

function schedule(): void {
  if (isScheduled || isPaused || robot === undefined) return;
  isScheduled = true;
  const rest = busyUntil - performance.now();
  if (rest > 0) setTimeout(() => nextSlice.port2.postMessage(0), rest);
  else nextSlice.port2.postMessage(0);
}

function work(): void {
  if (robot === undefined || isPaused) return;
  if (performance.now() < busyUntil) {
    schedule();
    return;
  }
  const end = performance.now() + SLICE_MS;
  let isMore = true;
  while (isMore && performance.now() < end) isMore = robot.step();
  const sinceMs = performance.now() - reportedAt;
  // A robot that drives has little to do at a time, but often.
  if (sinceMs > REPORT_MS || (!isMore && !robot.isDriving())) reportChanges(robot);
  else if (!isMore) reportLater(REPORT_MS - sinceMs);
  if (isMore) schedule();
}

function reportLater(ms: number): void {
  if (isReportDue) return;
  isReportDue = true;
  setTimeout(() => {
    isReportDue = false;
    guard(() => {
      if (robot !== undefined) reportChanges(robot);
    });
  }, ms);
}

function reportChanges(what: LogMapper): void {
  reportedAt = performance.now();
  const recorded = what.recorded();
  if (recorded.length > 0) post({ recorded }, [recorded.buffer]);
  const deliveries = what.updates() as Delivery[];
  const buffers = deliveries.flatMap(({ bytes }) => (bytes === undefined ? [] : [bytes.buffer]));
  post({ deliveries, isMapped: what.isMapped() }, buffers);
}

function post(report: Report, buffers: ArrayBufferLike[] = []): void {
  self.postMessage(report, { transfer: buffers as ArrayBuffer[] });
}
