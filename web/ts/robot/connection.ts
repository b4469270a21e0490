// The panel above the picture that connects to a robot: a person types its address, and the map grows while it drives.

import { create, stopKeyPropagation } from '../dom';
import type { Delivery } from './protocol';
import { RECORDING } from './recording';

export interface ConnectionHost {
  connect(address: string): void;
  /** Ends the drive. */
  stop(): void;
  /** Reads another laser: the drive starts again with it. */
  choose(laser: string): void;
  save(what: typeof RECORDING | 'session.slam2d'): void;
}

/** `DriveReport` of crates/robots/worker/src/update.rs. */
interface DriveReport {
  reads: string[];
  lasers: string[];
  scans: [came: number, mapped: number, tooFast: number];
  said: string;
  is_driving: boolean;
}

const LOOPBACK = /^(localhost|127(\.\d+){3}|\[::1\])$/;
const INSECURE =
  'A browser lets a page loaded over https reach only wss:// addresses. Three ways out: serve the robot over wss://, unpack the ' +
  'offline zip and open its page, or open this page from http://localhost.';

export class ConnectionPanel {
  readonly element = create('section', { class: 'connection', 'aria-label': 'A robot that drives' });
  readonly #host: ConnectionHost;
  readonly #fold = create('details');
  readonly #address = create('input', {
    type: 'text', inputmode: 'url', required: '', pattern: '\\s*wss?://\\S+\\s*', title: 'An address such as ws://robot:8765',
    placeholder: 'ws://robot:8765', autocomplete: 'off', autocapitalize: 'none', spellcheck: 'false', size: '24',
  });
  readonly #lasers = create('select');
  readonly #laserLabel = create('label', { hidden: '' });
  readonly #connect = create('button', { type: 'submit' });
  readonly #stop: HTMLButtonElement;
  readonly #recording: HTMLButtonElement;
  readonly #session: HTMLButtonElement;
  /** Changes several times a second, and so is not announced. */
  readonly #count = create('p');
  readonly #said = create('p', { role: 'status' });
  #isDriving = false;

  constructor(host: ConnectionHost) {
    this.#host = host;
    this.#stop = this.#button('Stop', () => host.stop());
    this.#recording = this.#button('Save the recording', () => host.save(RECORDING));
    this.#session = this.#button('Save the session', () => host.save('session.slam2d'));
    this.#connect.textContent = 'Connect';
    const form = create('form', { novalidate: '' });
    const label = create('label');
    label.append('Address ', this.#address);
    const heading = create('summary');
    heading.textContent = 'Connect to a robot';
    this.#laserLabel.append('Scans from ', this.#lasers);
    this.#lasers.addEventListener('change', () => host.choose(this.#lasers.value));
    form.append(label, this.#connect, this.#stop, this.#laserLabel, this.#recording, this.#session);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.#submit();
    });
    this.#fold.append(heading, form);
    this.element.append(this.#fold, this.#count, this.#said);
    stopKeyPropagation(this.element);
  }

  /** Handles a delivery of the worker; returns whether the layout may have changed. */
  receive({ kind, text }: Delivery): boolean {
    if (kind === 'drive') this.#show(JSON.parse(text) as DriveReport);
    else if (kind === 'failed' && this.#isDriving) {
      this.#setDriving(false);
      this.#say(text);
    } else if (kind === 'opening' && text !== this.#address.value.trim()) this.#rest();
    else if (kind === 'closed') this.#rest();
    else return false;
    return true;
  }

  /** Another log is open, or none. */
  #rest(): void {
    this.#setDriving(false);
    for (const button of [this.#recording, this.#session]) button.hidden = true;
    this.#laserLabel.hidden = true;
    this.#count.textContent = '';
    this.#say('');
  }

  #submit(): void {
    const address = this.#address.value.trim();
    if (!this.#address.checkValidity()) {
      this.#say(`${address === '' ? 'This' : address} is not the address of a robot; type one such as ws://robot:8765.`);
      this.#address.focus();
      return;
    }
    if (location.protocol === 'https:' && address.startsWith('ws:') && !isLoopback(address)) {
      this.#say(INSECURE);
      return;
    }
    this.#rest();
    this.#setDriving(true);
    this.#say(`Connecting to ${address} …`);
    this.#host.connect(address);
    this.#stop.focus();
  }

  #show({ reads, lasers, scans: [came, mapped, tooFast], said, is_driving: isDriving }: DriveReport): void {
    const hasEnded = this.#isDriving && !isDriving;
    this.#setDriving(isDriving);
    this.#recording.hidden = came === 0;
    this.#session.hidden = mapped === 0;
    this.#offer(lasers, reads);
    this.#count.textContent = came === 0 ? '' : wordsOn(came, mapped, tooFast, isDriving);
    if (said !== '') this.#say(sentence(said));
    else if (hasEnded) this.#say('The drive is over.');
    else if (isDriving && reads.length > 0) this.#say(`Reads ${reads.join(', ')}.`);
  }

  /** Offers the lasers if there are several. */
  #offer(lasers: readonly string[], reads: readonly string[]): void {
    this.#laserLabel.hidden = lasers.length < 2;
    const known = [...this.#lasers.options].map(({ value }) => value);
    if (known.join('\n') === lasers.join('\n')) return;
    this.#lasers.replaceChildren(...lasers.map((laser) => new Option(laser)));
    const read = lasers.find((laser) => reads.includes(laser));
    if (read !== undefined) this.#lasers.value = read;
  }

  #setDriving(isDriving: boolean): void {
    const held = (this.element.getRootNode() as ShadowRoot).activeElement;
    this.#isDriving = isDriving;
    this.#connect.hidden = isDriving;
    this.#stop.hidden = !isDriving;
    this.#address.readOnly = isDriving;
    // The focused button disappears.
    if (held === this.#stop && !isDriving) this.#connect.focus();
  }

  /** Says a sentence, once. */
  #say(text: string): void {
    if (this.#said.textContent !== text) this.#said.textContent = text;
  }

  #button(label: string, act: () => void): HTMLButtonElement {
    const button = create('button', { type: 'button', hidden: '' });
    button.textContent = label;
    button.addEventListener('click', act);
    return button;
  }
}

function isLoopback(address: string): boolean {
  try {
    return LOOPBACK.test(new URL(address).hostname);
  } catch {
    return false;
  }
}

function sentence(text: string): string {
  return text.endsWith('.') ? text : `${text}.`;
}

function wordsOn(came: number, mapped: number, tooFast: number, isDriving: boolean): string {
  const left = tooFast === 0 ? '' : ` ${tooFast} arrived faster than this computer maps them and were left out; the recording has them.`;
  if (mapped === 0 && isDriving) return `${came} scans arrived. The map starts once odometry and mounting are checked against them. Drive on, and turn.${left}`;
  return `${came} scans arrived, ${mapped} are mapped.${left}`;
}
