// The loops to look into, under the picture: of each the surroundings of both ends, laid on each other as the loop
// lays them, and the reader's decision. The worker selects them; this only lays them out.

import { create, stopKeyPropagation } from '../dom';
import type { Delivery } from './protocol';

export interface LoopsHost {
  /** Shows that loop of the list on the map. */
  show(loop: number): void;
  /** Sends the decision to the worker. */
  decide(order: string): void;
}

/** A loop of the delivery. */
interface Loop {
  /** Its number in the list. */
  loop: number;
  ends: string;
  chi2: string;
  /** The points around the older keyframe and around the newer one, x and y in turn, m. */
  scans: Float64Array[];
}

/** The share of the points that may lie outside of a picture at each of its edges. */
const HIDDEN_SHARE = 0.02;
const SVG = 'http://www.w3.org/2000/svg';

export class LoopsToLookInto {
  readonly element = create('section', { class: 'loops', hidden: '', 'aria-label': 'Loops to look into' });
  readonly #host: LoopsHost;
  readonly #heading = create('p', { class: 'question', tabindex: '-1' });
  readonly #legend = create('p');
  readonly #list = create('ul');
  readonly #more = create('p');

  constructor(host: LoopsHost) {
    this.#host = host;
    this.#legend.textContent = 'Blue is the older visit and green the newer one, laid on each other as the loop lays them.';
    this.element.append(this.#heading, this.#legend, this.#list, this.#more);
    stopKeyPropagation(this.element);
  }

  /** Handles a delivery of the worker; returns whether the size may have changed. */
  receive({ kind, numbers }: Delivery): boolean {
    if (kind === 'evidence') this.#show(numbers);
    else if (kind === 'opening' || kind === 'closed' || kind === 'failed') this.element.hidden = true;
    else return false;
    return true;
  }

  #show(numbers: Float64Array): void {
    const [count = 0] = numbers;
    // After the reader's last decision the list stays, and is empty.
    if (count === 0 && this.element.hidden) return;
    const loops = read(numbers);
    const focused = (this.element.getRootNode() as ShadowRoot).activeElement;
    const held = [...this.#list.querySelectorAll('button')].indexOf(focused as HTMLButtonElement);
    this.#heading.textContent =
      count === 0 ? 'No loop is left to look into.' : 'Do these scans belong together? The rest of the graph contradicts it.';
    this.#legend.hidden = count === 0;
    this.#list.replaceChildren(...loops.map((loop) => this.#item(loop)));
    this.#more.textContent = count > loops.length ? `and ${count - loops.length} more` : '';
    this.element.hidden = false;
    // The button with the focus is gone; the one in its place gets it.
    if (held >= 0) ([...this.#list.querySelectorAll('button')].at(Math.min(held, 3 * loops.length - 1)) ?? this.#heading).focus();
  }

  #item(loop: Loop): HTMLElement {
    const item = create('li');
    const show = this.#button(`Show the loop ${loop.ends} on the map`, () => this.#host.show(loop.loop));
    show.append(picture(loop));
    const decide = (name: string, order: string): HTMLElement => {
      const button = this.#button(`${name} the loop ${loop.ends}`, () => {
        // Until the graph is solved without it, or checked again.
        item.setAttribute('aria-busy', 'true');
        this.#host.decide(`${order} ${loop.loop}`);
      });
      button.append(name);
      return button;
    };
    const words = create('span');
    words.textContent = `${loop.ends}: ${loop.chi2}`;
    item.append(show, words, decide('Accept', 'accept'), decide('Refuse', 'refuse'));
    return item;
  }

  #button(label: string, act: () => void): HTMLElement {
    const button = create('button', { type: 'button', 'aria-label': label });
    button.addEventListener('click', act);
    return button;
  }
}

/** The loops of a delivery; `web/robot/src/update.rs` defines it. */
function read(numbers: Float64Array): Loop[] {
  const loops: Loop[] = [];
  let at = 1;
  while (at < numbers.length) {
    const [loop = 0, newer, older, chi2 = 0, gate = 0, ...sizes] = numbers.subarray(at, at + 7);
    at += 7;
    const scans = sizes.map((size) => numbers.subarray(at, (at += 2 * size)));
    loops.push({ loop, ends: `${newer} to ${older}`, chi2: `χ² ${chi2.toFixed(0)} of ${gate.toFixed(0)}`, scans });
  }
  return loops;
}

interface Range {
  middle: number;
  size: number;
}

/** The range of most points along an axis: a few distant ones would make the rest small. */
function shownRange(scans: readonly Float64Array[], axis: number): Range {
  const values = scans.flatMap((scan) => [...scan].filter((_, i) => i % 2 === axis)).sort((a, b) => a - b);
  const at = (share: number): number => values[Math.round(share * (values.length - 1))] ?? 0;
  const [low, high] = [at(HIDDEN_SHARE), at(1 - HIDDEN_SHARE)];
  return { middle: 0.5 * (low + high), size: high - low };
}

/** Both surroundings in their colours. */
function picture({ scans }: Loop): SVGElement {
  const [x, y] = [0, 1].map((axis) => shownRange(scans, axis)) as [Range, Range];
  const half = 0.5 * Math.max(x.size, y.size, 1);
  const svg = document.createElementNS(SVG, 'svg');
  svg.setAttribute('viewBox', [x.middle - half, -y.middle - half, 2 * half, 2 * half].join(' '));
  svg.setAttribute('aria-hidden', 'true');
  for (const [k, scan] of scans.entries()) {
    const dots = document.createElementNS(SVG, 'path');
    let path = '';
    // A line without length is a dot.
    for (let i = 0; i < scan.length; i += 2) path += `M${scan[i]?.toFixed(2)} ${(-(scan[i + 1] ?? 0)).toFixed(2)}h0`;
    dots.setAttribute('d', path);
    dots.setAttribute('class', k === 0 ? 'older' : 'newer');
    svg.append(dots);
  }
  return svg;
}
