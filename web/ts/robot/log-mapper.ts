// Maps a reader's log for w16.10, or a robot that drives: keeps the files or the connection, and the worker, and passes
// orders and deliveries between widget and worker. It survives the widget's instance; a new instance gets the latest deliveries again.

import type { Widget } from '../../pkg/glue.js';
import { saveBlob } from '../export';
import { assetUrl, fetchAsset } from '../assets';
import { LoadError, ModuleFile, StaleError } from '../module';
import { RECORDING, Recording } from './recording';
import { RobotSocket } from './robot-socket';
import { textDelivery, type Delivery, type LogFile, type Order, type Report } from './protocol';

/** Set by the build: the module that maps logs, its worker, and the samples. */
declare const ROBOT_WASM_FILE: string;
declare const ROBOT_WORKER_FILE: string;
declare const SAMPLE_FILES: readonly string[];

/** Extensions of references. */
const REFERENCES = ['.relations', '.tum'];
/** Extension of a session. */
const SESSION = '.slam2d';
/** Maximum size of a reference. */
const MAX_REFERENCE_BYTES = 1 << 28;
const NO_NUMBERS = new Float64Array();
const NO_BYTES = new Uint8Array();
/** Retries of a log after a crash. */
const MAX_RETRIES = 1;

/** The purpose of a file: to be mapped, to be localized on the present map, or to grade the map. */
export type FileUse = 'map' | 'where' | 'grade';

const NO_WORKER =
  'A worker maps the log, and this page may not start one: its frame or its security policy forbids it. ' +
  'Open the widget on a separate page.';

const program = new ModuleFile(ROBOT_WASM_FILE);

/** A pending request of a program for a saved file. */
interface FileRequest {
  take(file: File): void;
  reject(problem: Error): void;
}

export interface LogMapperHost {
  /** Passes deliveries to the widget, if it runs. */
  deliver(deliveries: readonly Delivery[]): void;
  /** Opens the file dialog. */
  choose(chosen: (files: File[]) => void): void;
}

export class LogMapper {
  readonly #host: LogMapperHost;
  /** The latest delivery of each kind, in the order of first arrival. */
  readonly #latest = new Map<string, Delivery>();
  #worker: Worker | undefined;
  /** The log: one file, or several of one recording. */
  #files: File[] = [];
  /** The address of the robot that drives; its recording takes its place when the drive ends. */
  #address: string | undefined;
  #socket: RobotSocket | undefined;
  #recording: Recording | undefined;
  #reference: File | undefined;
  /** A reference that waits for its log. */
  #earlyReference: File | undefined;
  /** Orders that wait for the worker. */
  #waiting: Order[] = [];
  /** Whether a log was opened and not closed. */
  #isOpen = false;
  #crashes = 0;
  /** The reader's changes of the graph as the worker reports them; repeated after a crash. */
  #edits = '[]';
  /** The reader's options: topics, frames, the pose of the laser and others. */
  readonly #options = new Map<string, string>();
  /** A log to localize on the map, and its start pose. */
  #localization: { files: File[]; start: number[] } | undefined;
  #mustLocalize = false;
  /** A log that waits for the start pose from the widget. */
  #droppedLog: File[] | undefined;
  /** The purpose of a dropped log. */
  #dropUse: FileUse = 'map';
  /** Pending requests by file name. */
  readonly #fileRequests = new Map<string, FileRequest[]>();
  #isMapFinished = false;
  /** Increases with every log: late reports about an older one are dropped. */
  #generation = 0;

  constructor(host: LogMapperHost) {
    this.#host = host;
  }

  /** Repeats the latest deliveries to a new instance. */
  restore(widget: Widget): void {
    for (const delivery of this.#latest.values()) deliverTo(widget, delivery);
  }

  /** Executes an order of the widget. */
  order(order: string): void {
    const [name = '', ...words] = order.split(' ');
    switch (name) {
      case 'open':
        // A reference that the reader picks here still grades the present map.
        this.#host.choose((files) => this.take(files, 'map'));
        break;
      case 'reference':
        this.#host.choose((files) => this.take(files, 'grade'));
        break;
      case 'sample':
        void this.#openSample();
        break;
      case 'locate':
        this.#host.choose((files) => this.#localize(files, words));
        break;
      case 'locate-sample':
        void this.#localizeSample(words);
        break;
      case 'locate-dropped':
        if (this.#droppedLog !== undefined) this.#localize(this.#droppedLog, words);
        this.#droppedLog = undefined;
        break;
      case 'drop':
        this.#dropUse = words[0] === 'where' ? 'where' : 'map';
        break;
      case 'option':
        this.choose(words.join(' '));
        break;
      case 'close':
        this.#reset();
        this.#isOpen = false;
        this.#earlyReference = undefined;
        this.#latest.clear();
        this.#host.deliver([textDelivery('closed', '')]);
        break;
      case 'save':
        if (words.join(' ') === RECORDING && this.#recording !== undefined) saveBlob(this.#recording.file(), RECORDING);
        else this.#send({ save: words.join(' ') });
        break;
      case 'pause':
      case 'resume':
        this.#send({ pause: name === 'pause' });
        break;
      case 'cancel':
        // What the robot sent until now is mapped to its end.
        if (this.#address !== undefined) this.#stopListening();
        else this.#send({ cancel: true });
        break;
      default:
        this.#send({ order });
    }
  }

  /** Opens files: a log, a reference, or both; or a session with a log to localize. */
  take(files: readonly File[], purpose?: FileUse): void {
    const use = purpose ?? this.#dropUse;
    const ends = (file: File, end: string): boolean => file.name.toLowerCase().endsWith(end);
    const isReference = (file: File): boolean => use === 'grade' || REFERENCES.some((end) => ends(file, end));
    const logs = files.filter((file) => !isReference(file));
    const session = purpose === 'where' ? undefined : logs.find((file) => ends(file, SESSION));
    // Several files are parts of one recording.
    const log = logs.filter((file) => file !== session);
    const reference = files.find(isReference);
    if (session !== undefined) {
      this.open([session], reference);
      if (log.length > 0) this.#localize(log, []);
    } else if (log.length > 0 && use === 'where') {
      if (reference !== undefined) void this.#grade(reference);
      // The widget answers with the order `locate-dropped` and a start pose.
      this.#droppedLog = log;
      this.#host.deliver([textDelivery('dropped', nameOf(log))]);
    } else if (log.length > 0) this.open(log, reference);
    else if (reference !== undefined) void this.#grade(reference);
  }

  /** Maps a log, and drops the present map. */
  open(files: File[], reference?: File): void {
    this.#reset();
    this.#openFiles(files, reference);
  }

  /** Maps a robot while it drives, and drops the present map. */
  listen(address: string): void {
    this.#reset();
    this.#startListening(address);
  }

  #startListening(address: string): void {
    this.#files = [];
    this.#reference = undefined;
    this.#address = address;
    this.#recording = new Recording();
    void this.#start([]);
  }

  #stopListening(): void {
    this.#socket?.close();
    this.#send({ network: 'asked', seconds: 0 });
    this.#endDrive();
  }

  /** The connection is closed for good: from now on, the recording is a log like any other. */
  #endDrive(): void {
    this.#address = undefined;
    this.#socket?.close();
    this.#socket = undefined;
  }

  /** Returns a saved file by its name; rejects with a sentence if there is no data for it. */
  file(name: string): Promise<File> {
    return new Promise((take, reject) => {
      if (this.#worker === undefined) {
        reject(new Error('Open a log first.'));
        return;
      }
      this.#fileRequests.set(name, [...(this.#fileRequests.get(name) ?? []), { take, reject }]);
      this.#send({ save: name });
    });
  }

  /** Takes the first pending request for a file. */
  #takeRequest(name: string): FileRequest | undefined {
    return this.#fileRequests.get(name)?.shift();
  }

  /** Releases worker and memory. */
  close(): void {
    this.#generation += 1;
    for (const { reject } of [...this.#fileRequests.values()].flat()) reject(new Error('The log was closed.'));
    this.#fileRequests.clear();
    this.#worker?.terminate();
    this.#worker = undefined;
    this.#waiting = [];
    this.#endDrive();
  }

  /** Crashes the program on purpose, to test the recovery. */
  crashForTest(): void {
    this.#send({ crash: true });
  }

  /** Drops the present log; later orders are for the next one. */
  #reset(): void {
    this.close();
    this.#isOpen = true;
    this.#options.clear();
    this.#recording = undefined;
    this.#forgetMap();
  }

  /** Forgets what belongs to the present map. */
  #forgetMap(): void {
    this.#crashes = 0;
    this.#edits = '[]';
    this.#localization = undefined;
  }

  /** Sets an option, such as `scan-topic /front`, or resets all, and maps the same log again. */
  choose(option: string | undefined): void {
    const address = this.#address;
    const files = this.#log;
    if (files.length === 0) {
      this.#publish([textDelivery('answer', 'Open a log first.')]);
      return;
    }
    this.close();
    this.#isOpen = true;
    if (option === undefined) this.#options.clear();
    else {
      const [name = '', ...value] = option.split(' ');
      this.#options.set(name, value.join(' '));
    }
    this.#forgetMap();
    if (address === undefined) void this.#start(files);
    else this.#startListening(address);
  }

  /** The files of the log: of a drive, its recording so far. */
  get #log(): File[] {
    return this.#recording === undefined ? this.#files : [this.#recording.file()];
  }

  /** The options of the present map, as on the command line. */
  get chosen(): string[] {
    return [...this.#options].map(([name, value]) => `--${name} ${value}`.trimEnd());
  }

  get #optionLines(): string {
    return this.chosen.map((option) => option.slice(2)).join('\n');
  }

  /** Localizes a log on the map, once that is finished. */
  #localize(files: File[], start: readonly string[]): void {
    const name = nameOf(files);
    if (!this.#isOpen) {
      this.#publish([textDelivery('answer', `${name} needs a map: open a log or a session first.`)]);
      return;
    }
    this.#localization = { files, start: start.map(Number) };
    if (this.#isMapFinished) this.#sendLocalization();
    else {
      this.#mustLocalize = true;
      this.#publish([textDelivery('answer', `${name} waits until the map is finished.`)]);
    }
  }

  #sendLocalization(): void {
    if (this.#localization === undefined) return;
    const { files, start } = this.#localization;
    const generation = this.#generation;
    void sendable(files).then((locate) => {
      if (generation === this.#generation) this.#send({ locate, options: this.#optionLines, start });
    }, () => this.#publish([textDelivery('answer', `${nameOf(files)} cannot be read any more; it may have moved or changed.`)]));
  }

  async #localizeSample(start: readonly string[]): Promise<void> {
    const generation = this.#generation;
    try {
      const log = await fetchFile(SAMPLE_FILES[2] ?? '');
      if (generation === this.#generation) this.#localize([log], start);
    } catch {
      if (generation === this.#generation) this.#publish([textDelivery('answer', 'The sample could not be fetched; try again.')]);
    }
  }

  #openFiles(files: File[], reference: File | undefined): void {
    this.#files = files;
    this.#reference = reference ?? this.#earlyReference;
    this.#earlyReference = undefined;
    void this.#start(files);
  }

  async #start(files: File[]): Promise<void> {
    const generation = this.#generation;
    this.#mustLocalize = this.#localization !== undefined;
    this.#isMapFinished = false;
    this.#latest.clear();
    const address = this.#address;
    this.#publish([textDelivery('opening', address ?? nameOf(files))]);
    try {
      const module = await program.load(() => {});
      if (generation !== this.#generation) return;
      const [worker, sent] = await Promise.all([startWorker(), sendable(files)]);
      if (generation !== this.#generation) {
        worker.terminate();
        return;
      }
      worker.addEventListener('message', ({ data }: MessageEvent<Report>) => {
        if (generation === this.#generation) this.#receive(data);
      });
      worker.addEventListener('error', (event) => {
        event.preventDefault();
        if (generation === this.#generation) this.#fail(NO_WORKER);
      });
      this.#worker = worker;
      const options = this.#optionLines;
      this.#send(address === undefined ? { module, files: sent, options, edits: this.#edits } : { module, listen: address, options });
      for (const order of this.#waiting.splice(0)) this.#send(order);
      if (this.#reference !== undefined) void this.#sendReference(this.#reference);
    } catch (error) {
      if (generation !== this.#generation) return;
      const remedy = error instanceof StaleError ? ' Reload the page.' : '';
      this.#fail(error instanceof LoadError ? `The log cannot be mapped: ${error.message}.${remedy}` : NO_WORKER);
    }
  }

  async #openSample(): Promise<void> {
    this.#reset();
    const generation = this.#generation;
    try {
      const [log, truth] = await Promise.all(SAMPLE_FILES.slice(0, 2).map(fetchFile));
      if (log !== undefined && generation === this.#generation) this.#openFiles([log], truth);
    } catch {
      if (generation === this.#generation) this.#fail('The sample could not be fetched; open your own log, or try again.');
    }
  }

  #receive(report: Report): void {
    if ('listening' in report) this.#connect(report.patienceMs);
    else if ('requests' in report) this.#request(report.requests);
    else if ('recorded' in report) this.#recording?.add(report.recorded as Uint8Array<ArrayBuffer>);
    else if ('deliveries' in report) {
      this.#publish(report.deliveries);
      const drive = report.deliveries.findLast(({ kind }) => kind === 'drive');
      if (drive !== undefined && !(JSON.parse(drive.text) as { is_driving: boolean }).is_driving) this.#endDrive();
      this.#edits = report.deliveries.findLast(({ kind }) => kind === 'edits')?.text ?? this.#edits;
      if (report.isMapped === true) this.#continueOnMap();
    } else if ('saved' in report) {
      const bytes = report.bytes as Uint8Array<ArrayBuffer>;
      const request = this.#takeRequest(report.saved);
      if (request === undefined) saveBlob(new Blob([bytes]), report.saved);
      else request.take(new File([bytes], report.saved));
    } else if ('unsaved' in report) {
      const request = this.#takeRequest(report.unsaved);
      if (request === undefined) this.#publish([textDelivery('answer', report.why)]);
      else request.reject(new Error(report.why));
    } else if ('failed' in report) {
      this.#fail(report.failed);
    } else {
      this.#crashed();
    }
  }

  #connect(patienceMs: number): void {
    if (this.#address === undefined) return;
    this.#socket = new RobotSocket(this.#address, patienceMs, {
      heard: (heard) => this.#worker?.postMessage({ heard } satisfies Order, typeof heard === 'string' ? [] : [heard]),
      network: (network, seconds) => this.#send({ network, seconds }),
    });
  }

  #request(texts: readonly string[]): void {
    for (const text of texts) this.#socket?.send(text);
  }

  #crashed(): void {
    this.#crashes += 1;
    const files = this.#log;
    if (this.#crashes <= MAX_RETRIES && files.length > 0) {
      // Of a drive, what came is mapped again.
      this.close();
      void this.#start(files);
      this.#publish([textDelivery('answer', 'The mapping stopped because of an error in its program, and was restarted.')]);
      return;
    }
    const megabytes = Math.ceil(files.reduce((sum, { size }) => sum + size, 0) / 1e6);
    this.#fail(
      `The program that maps the log stopped again (the file is ${megabytes} MB); ` +
        'it may need more memory than the browser allows. Try slam2d run on the command line.',
    );
  }

  #fail(sentence: string): void {
    this.close();
    this.#isOpen = false;
    this.#publish([textDelivery('failed', sentence)]);
  }

  /** Does the work that waits for the map. */
  #continueOnMap(): void {
    this.#isMapFinished = true;
    if (this.#mustLocalize) this.#sendLocalization();
    this.#mustLocalize = false;
  }

  async #grade(file: File): Promise<void> {
    if (!this.#isOpen) {
      this.#earlyReference = file;
      this.#publish([textDelivery('answer', `${file.name} waits for a log to be opened.`)]);
      return;
    }
    this.#reference = file;
    // A new worker gets it at its start.
    if (this.#worker !== undefined) await this.#sendReference(file);
  }

  async #sendReference(file: File): Promise<void> {
    const generation = this.#generation;
    if (file.size > MAX_REFERENCE_BYTES) {
      this.#publish([textDelivery('answer', `${file.name} exceeds the 256 MB limit for a reference.`)]);
      return;
    }
    try {
      const bytes = new Uint8Array(await file.arrayBuffer());
      if (generation === this.#generation) this.#send({ reference: bytes, name: file.name });
    } catch {
      this.#publish([textDelivery('answer', `${file.name} cannot be read any more; it may have moved or changed.`)]);
    }
  }

  #send(order: Order): void {
    if (!this.#isOpen) this.#publish([textDelivery('answer', 'Open a log first.')]);
    else if (this.#worker === undefined) this.#waiting.push(order);
    else this.#worker.postMessage(order);
  }

  #publish(deliveries: readonly Delivery[]): void {
    for (const delivery of deliveries) this.#latest.set(delivery.kind, delivery);
    this.#host.deliver(deliveries);
  }
}

/** The name of a log until the worker has read it. */
function nameOf([first, ...rest]: readonly File[]): string {
  const more = rest.length === 0 ? '' : ` and ${rest.length} more`;
  return `${first?.name ?? ''}${more}`;
}

export function deliverTo(widget: Widget, { kind, text, numbers = NO_NUMBERS, bytes = NO_BYTES }: Delivery): void {
  widget.deliver(kind, text, numbers, bytes);
}

/**
 * Workers must have the page's origin. A page of another origin starts a blob that imports our script. A sandboxed frame has
 * an opaque origin, and starts a data URL. Without a server, the script is part of the blob or data URL.
 */
async function startWorker(): Promise<Worker> {
  const address = assetUrl(ROBOT_WORKER_FILE);
  if (address !== undefined && new URL(address).origin === self.origin) {
    return new Worker(address, { type: 'module' });
  }
  const text = address === undefined || location.protocol === 'file:' ? await (await fetchWithoutTimeout(ROBOT_WORKER_FILE)).text() : `import ${JSON.stringify(address)};`;
  const script =
    self.origin === 'null'
      ? `data:text/javascript,${encodeURIComponent(text)}`
      : URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
  return new Worker(script, { type: 'module' });
}

/** What a worker can read: one of another origin, as in a sandbox or beside a page from the disk, cannot read the page's files. */
function sendable(files: readonly File[]): Promise<LogFile[]> {
  const withBytes = async (file: File): Promise<LogFile> => ({ name: file.name, size: file.size, bytes: await file.arrayBuffer() });
  return Promise.all(files.map((file) => (self.origin === 'null' ? withBytes(file) : file)));
}

function fetchWithoutTimeout(name: string): Promise<Response> {
  return fetchAsset(name, false, new AbortController().signal);
}

async function fetchFile(name: string): Promise<File> {
  const response = await fetchWithoutTimeout(name);
  if (!response.ok) throw new LoadError(`${name} could not be fetched`);
  return new File([await response.blob()], name.replace(/^.*\//, ''));
}
