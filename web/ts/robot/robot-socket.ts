// The connection to a robot's foxglove_bridge. What it hears goes to the worker, which speaks the protocol; this only
// connects, connects again, and notices silence.

/** Names of the protocol, the present one first: `SUBPROTOCOLS` of crates/robots/robot_io/src/live/protocol.rs. */
const SUBPROTOCOLS = ['foxglove.sdk.v1', 'foxglove.websocket.v1'];
/** A robot that does not answer within this is not there. */
const ANSWER_MS = 5000;
/** A robot whose topics are silent for this long is lost. */
const SILENCE_MS = 10_000;
/** Time between two attempts to connect again. */
const RETRY_MS = 500;

/** What a network does; the worker has the sentences. */
export type NetworkEvent =
  /** Before the first connection. */
  | 'address' | 'refused' | 'unanswered' | 'subprotocol'
  /** While the robot drives. */
  | 'lost' | 'silent' | 'back'
  /** At the end. */
  | 'asked' | 'no-scans' | 'not-back' | 'never-heard';

export interface SocketHost {
  heard(message: string | ArrayBuffer): void;
  /** `seconds` is the time without a connection, for `back`. */
  network(event: NetworkEvent, seconds: number): void;
}

export class RobotSocket {
  readonly #url: string;
  /** How long to wait for the first scan, and for a lost connection. */
  readonly #patienceMs: number;
  readonly #host: SocketHost;
  #socket: WebSocket | undefined;
  #isClosed = false;
  /** When the connection was lost. */
  #lostAt: number | undefined;
  #wasOpen = false;
  readonly #timers = new Map<string, ReturnType<typeof setTimeout>>();

  constructor(url: string, patienceMs: number, host: SocketHost) {
    this.#url = url;
    this.#patienceMs = patienceMs;
    this.#host = host;
    this.#open();
  }

  send(text: string): void {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(text);
  }

  /** Closes the connection for good, without an event. */
  close(): void {
    this.#isClosed = true;
    for (const timer of this.#timers.values()) clearTimeout(timer);
    this.#timers.clear();
    this.#drop();
  }

  #open(): void {
    let socket: WebSocket;
    try {
      socket = new WebSocket(this.#url, SUBPROTOCOLS);
    } catch {
      this.#end('address');
      return;
    }
    socket.binaryType = 'arraybuffer';
    this.#socket = socket;
    const isCurrent = (): boolean => this.#socket === socket && !this.#isClosed;
    socket.addEventListener('open', () => {
      if (isCurrent()) this.#opened();
    });
    socket.addEventListener('message', ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (!isCurrent()) return;
      // A server without messages of topics has nothing to say.
      if (typeof data !== 'string') this.#after('silence', SILENCE_MS, () => this.#lose('silent'));
      this.#host.heard(data);
    });
    // An error is followed by a close.
    socket.addEventListener('close', () => {
      if (isCurrent()) this.#closed();
    });
    this.#after('answer', ANSWER_MS, () => {
      if (this.#wasOpen) this.#again();
      else this.#end('unanswered');
    });
  }

  #opened(): void {
    this.#cancel('answer');
    this.#cancel('patience');
    if (this.#lostAt !== undefined) this.#host.network('back', (performance.now() - this.#lostAt) / 1000);
    else this.#after('scans', this.#patienceMs, () => this.#host.network('no-scans', 0));
    this.#lostAt = undefined;
    this.#wasOpen = true;
  }

  #closed(): void {
    if (!this.#wasOpen) this.#askWhoIsThere();
    else if (this.#lostAt === undefined) this.#lose('lost');
    else this.#again();
  }

  #lose(how: 'lost' | 'silent'): void {
    this.#lostAt = performance.now();
    this.#cancel('silence');
    this.#drop();
    this.#after('patience', this.#patienceMs, () => this.#end(how === 'silent' ? 'never-heard' : 'not-back'));
    this.#host.network(how, 0);
    this.#again();
  }

  #again(): void {
    this.#cancel('answer');
    this.#drop();
    this.#after('retry', RETRY_MS, () => this.#open());
  }

  /** Browsers do not say why a connection failed. A server that opens one without a subprotocol speaks another. */
  #askWhoIsThere(): void {
    this.#drop();
    const other = new WebSocket(this.#url);
    this.#socket = other;
    const answer = (event: NetworkEvent): void => {
      if (this.#socket === other && !this.#isClosed) this.#end(event);
    };
    other.addEventListener('open', () => answer('subprotocol'));
    other.addEventListener('close', () => answer('refused'));
  }

  #end(event: NetworkEvent): void {
    this.close();
    this.#host.network(event, 0);
  }

  #drop(): void {
    const socket = this.#socket;
    this.#socket = undefined;
    socket?.close();
  }

  #after(name: string, ms: number, act: () => void): void {
    this.#cancel(name);
    this.#timers.set(name, setTimeout(act, ms));
  }

  #cancel(name: string): void {
    clearTimeout(this.#timers.get(name));
    this.#timers.delete(name);
  }
}
