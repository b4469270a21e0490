// The host of a widget that shows a reader's own log: it keeps the file and the worker that maps it, and
// passes on orders and reports. The widget's picture may come and go meanwhile; the latest reports are
// repeated to the next one.

import type { Widget } from '../../pkg/glue.js';
import { saveBlob } from '../export';
import { addressOf, openFile } from '../beside';
import { LoadError, ModuleFile, StaleError } from '../module';
import { LOGS } from './files';
import { told, type Delivery, type Order, type Report } from './protocol';

/** Set by the build: the program that maps logs, its worker, and the sample with its truth. */
declare const ROBOT_WASM_FILE: string;
declare const ROBOT_WORKER_FILE: string;
declare const SAMPLE_FILES: readonly string[];

/** Extensions of files that are a reference instead of a log. */
const REFERENCES = ['.relations', '.tum'];
/** The same for the log of a robot to be localized. */
const SCANS = '.yaml,.log,.clf,.mcap,.db3,.bag,.jsonl,.gz,.zst,.zstd';
/** Extension of a session. */
const SESSION = '.slam2d';
/** The stage in which the map is finished. */
const DONE = 5;
/** Largest size of a reference, bytes. */
const MOST_REFERENCE = 1 << 28;
/** Number of times that a file is restarted after a crash. */
const MOST_CRASHES = 1;

/** The purpose of a file: to become the map, to be localized on the current map, or to grade it. */
export type FileUse = 'map' | 'where' | 'grade';

const NO_WORKER =
  'A log is read by a worker beside the page, and this page may not start one: its frame or its security ' +
  'policy forbids it. Open the widget on a page of its own.';

const program = new ModuleFile(ROBOT_WASM_FILE);

/** A program that requested a file. */
interface Asked {
  take(file: File): void;
  refuse(problem: Error): void;
}

export interface DeskHost {
  /** Passes it to the widget, if one runs. */
  deliver(deliveries: readonly Delivery[]): void;
  /** Opens the system's dialog for a file. */
  choose(accept: string, chosen: (files: File[]) => void): void;
}

export class Desk {
  readonly #host: DeskHost;
  /** The latest of each kind, in the order in which they first came. */
  readonly #latest = new Map<string, Delivery>();
  #worker: Worker | undefined;
  /** One file, or those of a recording. */
  #files: File[] = [];
  #reference: File | undefined;
  /** A reference that came before its log. */
  #early: File | undefined;
  /** Orders before the worker was ready. */
  #waiting: Order[] = [];
  /** Whether a log was opened and not closed. */
  #isOpen = false;
  #crashes = 0;
  /** The reader's changes of the graph; repeated after a crash. */
  #edits: string[] = [];
  #owesEdits = false;
  /** The reader's options: topics, frames, the pose of the laser and others. */
  readonly #options = new Map<string, string>();
  /** The log of a robot to be localized on the map, and its start pose. */
  #visitor: { files: File[]; start: number[] } | undefined;
  #owesVisitor = false;
  /** A log that waits for the start pose from the widget. */
  #dropped: File[] | undefined;
  /** The purpose of a dropped log. */
  #dropUse: FileUse = 'map';
  /** Programs that wait for a file, by its name. */
  readonly #asked = new Map<string, Asked[]>();
  /** Whether the map is finished. */
  #stands = false;
  /** Counts the files: late reports about an older one are dropped. */
  #turn = 0;

  constructor(host: DeskHost) {
    this.#host = host;
  }

  /** Sends a new picture all that is known. */
  restore(widget: Widget): void {
    for (const delivery of this.#latest.values()) hand(widget, delivery);
  }

  /** Executes an order of the widget. */
  order(order: string): void {
    const [name = '', ...words] = order.split(' ');
    switch (name) {
      case 'open':
        // A reference that the reader picks here grades the current map all the same.
        this.#host.choose(LOGS, (files) => this.take(files, 'map'));
        break;
      case 'reference':
        this.#host.choose(REFERENCES.join(), (files) => this.take(files, 'grade'));
        break;
      case 'sample':
        void this.#openSample();
        break;
      case 'locate':
        this.#host.choose(SCANS, (files) => this.#visit(files, words));
        break;
      case 'locate-sample':
        void this.#visitSample(words);
        break;
      case 'locate-dropped':
        if (this.#dropped !== undefined) this.#visit(this.#dropped, words);
        this.#dropped = undefined;
        break;
      case 'drop':
        this.#dropUse = words[0] === 'where' ? 'where' : 'map';
        break;
      case 'option':
        this.choose(words.join(' '));
        break;
      case 'close':
        this.#renew();
        this.#isOpen = false;
        this.#early = undefined;
        this.#latest.clear();
        this.#host.deliver([told('closed', '')]);
        break;
      case 'save':
        this.#send({ save: words.join(' ') });
        break;
      default:
        if (['turn', 'accept', 'refuse', 'add', 'pin', 'unpin'].includes(name)) this.#keepEdit(order);
        this.#send({ order });
    }
  }

  /** Accepts files that were dropped or passed: a log, a reference, or both; a session and a log for it. */
  take(files: readonly File[], asked?: FileUse): void {
    const use = asked ?? this.#dropUse;
    const ends = (file: File, end: string): boolean => file.name.toLowerCase().endsWith(end);
    const isReference = (file: File): boolean => use === 'grade' || REFERENCES.some((end) => ends(file, end));
    const given = files.filter((file) => !isReference(file));
    const session = asked === 'where' ? undefined : given.find((file) => ends(file, SESSION));
    // Several files are the parts of one recording.
    const log = given.filter((file) => file !== session);
    const reference = files.find(isReference);
    if (session !== undefined) {
      this.open([session], reference);
      if (log.length > 0) this.#visit(log, []);
    } else if (log.length > 0 && use === 'where') {
      if (reference !== undefined) void this.#grade(reference);
      // The widget provides the start pose and then requests the localization.
      this.#dropped = log;
      this.#host.deliver([told('dropped', nameOf(log))]);
    } else if (log.length > 0) this.open(log, reference);
    else if (reference !== undefined) void this.#grade(reference);
  }

  /** Maps a log from its start; an earlier map is dropped. */
  open(files: File[], reference?: File): void {
    this.#renew();
    this.#setOut(files, reference);
  }

  /** The bytes of a file that can be saved; rejects with a sentence if there is no data for it. */
  file(name: string): Promise<File> {
    return new Promise((take, refuse) => {
      if (this.#worker === undefined) {
        refuse(new Error('Open a log first.'));
        return;
      }
      this.#asked.set(name, [...(this.#asked.get(name) ?? []), { take, refuse }]);
      this.#send({ save: name });
    });
  }

  /** The first program that waits for a file of that name. */
  #next(name: string): Asked | undefined {
    return this.#asked.get(name)?.shift();
  }

  /** Releases worker and memory. */
  close(): void {
    this.#turn += 1;
    for (const { refuse } of [...this.#asked.values()].flat()) refuse(new Error('The log was closed.'));
    this.#asked.clear();
    this.#worker?.terminate();
    this.#worker = undefined;
    this.#waiting = [];
  }

  /** Crashes the program on purpose, to test the recovery. */
  crashForTest(): void {
    this.#send({ order: 'crash-for-test' });
  }

  /** Prepares for another file, or none; later orders are for it. */
  #renew(): void {
    this.close();
    this.#isOpen = true;
    this.#options.clear();
    this.#beginAnew();
  }

  /** Forgets the changes of the earlier map. */
  #beginAnew(): void {
    this.#crashes = 0;
    this.#edits = [];
    this.#visitor = undefined;
  }

  /**
   * Sets another value of an option, such as `scan-topic /front`, or resets all; the same log is mapped from
   * its start.
   */
  choose(option: string | undefined): void {
    const files = this.#files;
    if (files.length === 0) {
      this.#tell([told('answer', 'Open a log first.')]);
      return;
    }
    this.close();
    this.#isOpen = true;
    if (option === undefined) this.#options.clear();
    else {
      const [name = '', ...value] = option.split(' ');
      this.#options.set(name, value.join(' '));
    }
    this.#beginAnew();
    void this.#begin(files);
  }

  /** The command-line options with which the log is mapped. */
  get chosen(): string[] {
    return [...this.#options].map(([name, value]) => `--${name} ${value}`.trimEnd());
  }

  get #optionLines(): string {
    return this.chosen.map((option) => option.slice(2)).join('\n');
  }

  /** Localizes the robot of a log on the map, once that is finished. */
  #visit(files: File[], start: readonly string[]): void {
    const name = nameOf(files);
    if (!this.#isOpen) {
      this.#tell([told('answer', `${name} needs a map: open a log or a session first.`)]);
      return;
    }
    this.#visitor = { files, start: start.map(Number) };
    if (this.#stands) this.#sendVisitor();
    else {
      this.#owesVisitor = true;
      this.#tell([told('answer', `${name} waits until the map stands.`)]);
    }
  }

  #sendVisitor(): void {
    if (this.#visitor === undefined) return;
    const { files, start } = this.#visitor;
    this.#send({ locate: files, options: this.#optionLines, start });
  }

  async #visitSample(start: readonly string[]): Promise<void> {
    const turn = this.#turn;
    try {
      const log = await fetchFile(SAMPLE_FILES[2] ?? '');
      if (turn === this.#turn) this.#visit([log], start);
    } catch {
      if (turn === this.#turn) this.#tell([told('answer', 'The sample could not be fetched; try again.')]);
    }
  }

  #setOut(files: File[], reference: File | undefined): void {
    this.#files = files;
    this.#reference = reference ?? this.#early;
    this.#early = undefined;
    void this.#begin(files);
  }

  async #begin(files: File[]): Promise<void> {
    const turn = this.#turn;
    this.#owesEdits = this.#edits.length > 0;
    this.#owesVisitor = this.#visitor !== undefined;
    this.#stands = false;
    this.#latest.clear();
    this.#tell([told('opening', nameOf(files))]);
    try {
      const module = await program.load(() => {});
      if (turn !== this.#turn) return;
      const worker = await startWorker();
      if (turn !== this.#turn) {
        worker.terminate();
        return;
      }
      worker.addEventListener('message', ({ data }: MessageEvent<Report>) => {
        if (turn === this.#turn) this.#hear(data);
      });
      worker.addEventListener('error', (event) => {
        event.preventDefault();
        if (turn === this.#turn) this.#fail(NO_WORKER);
      });
      this.#worker = worker;
      this.#send({ module, files, options: this.#optionLines });
      for (const order of this.#waiting.splice(0)) this.#send(order);
      if (this.#reference !== undefined) void this.#sendReference(this.#reference);
    } catch (error) {
      if (turn !== this.#turn) return;
      const remedy = error instanceof StaleError ? ' Reload the page.' : '';
      this.#fail(error instanceof LoadError ? `The log cannot be mapped: ${error.message}.${remedy}` : NO_WORKER);
    }
  }

  async #openSample(): Promise<void> {
    this.#renew();
    const turn = this.#turn;
    try {
      const [log, truth] = await Promise.all(SAMPLE_FILES.slice(0, 2).map(fetchFile));
      if (log !== undefined && turn === this.#turn) this.#setOut([log], truth);
    } catch {
      if (turn === this.#turn) this.#fail('The sample could not be fetched; open a log of your own, or try again.');
    }
  }

  #hear(report: Report): void {
    if ('deliveries' in report) {
      this.#tell(report.deliveries);
      this.#doAgain(report.deliveries);
    } else if ('saved' in report) {
      const bytes = report.bytes as Uint8Array<ArrayBuffer>;
      const asked = this.#next(report.saved);
      if (asked === undefined) saveBlob(new Blob([bytes]), report.saved);
      else asked.take(new File([bytes], report.saved));
    } else if ('unsaved' in report) {
      const asked = this.#next(report.unsaved);
      if (asked === undefined) this.#tell([told('answer', report.why)]);
      else asked.refuse(new Error(report.why));
    } else if ('failed' in report) {
      this.#fail(report.failed);
    } else {
      this.#crashed();
    }
  }

  #crashed(): void {
    this.#crashes += 1;
    if (this.#crashes <= MOST_CRASHES && this.#files.length > 0) {
      this.close();
      void this.#begin(this.#files);
      this.#tell([told('answer', 'The mapping stopped by an error in its program and was begun again.')]);
      return;
    }
    const megabytes = Math.ceil(this.#files.reduce((sum, { size }) => sum + size, 0) / 1e6);
    this.#fail(
      `The program that maps the log stopped again (the file has ${megabytes} MB); ` +
        'it may need more memory than the browser gives. Try slam2d run on the command line.',
    );
  }

  #fail(sentence: string): void {
    this.close();
    this.#isOpen = false;
    this.#tell([told('failed', sentence)]);
  }

  /** Once the map is finished, waiting work is done; after a crash that includes all changes by the reader. */
  #doAgain(deliveries: readonly Delivery[]): void {
    if (!deliveries.some(({ kind, numbers }) => kind === 'stage' && numbers[0] === DONE)) return;
    this.#stands = true;
    if (this.#owesEdits) for (const order of this.#edits) this.#send({ order });
    if (this.#owesVisitor) this.#sendVisitor();
    this.#owesEdits = false;
    this.#owesVisitor = false;
  }

  /** Only the last pose of a dragged keyframe is kept. */
  #keepEdit(order: string): void {
    const pinned = (text: string | undefined): string => /^pin \d+ /.exec(text ?? '')?.[0] ?? '';
    if (pinned(order) !== '' && pinned(order) === pinned(this.#edits.at(-1))) this.#edits.pop();
    this.#edits.push(order);
  }

  async #grade(file: File): Promise<void> {
    if (!this.#isOpen) {
      this.#early = file;
      this.#tell([told('answer', `${file.name} waits for a log to be opened.`)]);
      return;
    }
    this.#reference = file;
    // Before the worker is ready it waits: it is sent at the start.
    if (this.#worker !== undefined) await this.#sendReference(file);
  }

  async #sendReference(file: File): Promise<void> {
    const turn = this.#turn;
    if (file.size > MOST_REFERENCE) {
      this.#tell([told('answer', `${file.name} is larger than a reference of 256 MB.`)]);
      return;
    }
    try {
      const bytes = new Uint8Array(await file.arrayBuffer());
      if (turn === this.#turn) this.#send({ reference: bytes, name: file.name });
    } catch {
      this.#tell([told('answer', `${file.name} cannot be read any more; it may have moved or changed.`)]);
    }
  }

  #send(order: Order): void {
    if (!this.#isOpen) this.#tell([told('answer', 'Open a log first.')]);
    else if (this.#worker === undefined) this.#waiting.push(order);
    else this.#worker.postMessage(order);
  }

  #tell(deliveries: readonly Delivery[]): void {
    for (const delivery of deliveries) this.#latest.set(delivery.kind, delivery);
    this.#host.deliver(deliveries);
  }
}

/** The name of a log of several files until the worker has sorted them. */
function nameOf([first, ...rest]: readonly File[]): string {
  const more = rest.length === 0 ? '' : ` and ${rest.length} more`;
  return `${first?.name ?? ''}${more}`;
}

/** Passes a delivery to a widget's model. */
export function hand(widget: Widget, { kind, text, numbers, bytes }: Delivery): void {
  widget.deliver(kind, text, numbers, bytes);
}

/**
 * A page of another origin may not start our script as a worker, but may start its own one that imports
 * ours. A sandboxed frame has another origin regardless of its address, and its own script may only be a
 * module in a data address; so may a page from the disk, which imports nothing from there.
 */
async function startWorker(): Promise<Worker> {
  const address = addressOf(ROBOT_WORKER_FILE);
  if (address !== undefined && new URL(address).origin === self.origin) {
    return new Worker(address, { type: 'module' });
  }
  const text = address === undefined || location.protocol === 'file:' ? await (await ask(ROBOT_WORKER_FILE)).text() : `import ${JSON.stringify(address)};`;
  const script =
    self.origin === 'null'
      ? `data:text/javascript,${encodeURIComponent(text)}`
      : URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
  return new Worker(script, { type: 'module' });
}

function ask(name: string): Promise<Response> {
  return openFile(name, false, new AbortController().signal);
}

async function fetchFile(name: string): Promise<File> {
  const response = await ask(name);
  if (!response.ok) throw new LoadError(`${name} could not be fetched`);
  return new File([await response.blob()], name.replace(/^.*\//, ''));
}
