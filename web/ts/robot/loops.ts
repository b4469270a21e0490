// The loops in doubt, under the picture: of each the surroundings of both ends, laid on each other as the loop
// lays them, and the reader's decision. The worker selects them; this only lays them out.

import { create, stopKeyPropagation } from '../dom';
import type { Delivery } from './protocol';

export interface LoopsHost {
  /** Shows that loop of the list on the map. */
  show(loop: number): void;
  /** Passes a request with the decision to the worker. */
  decide(request: string): void;
}

/** `Evidence` of crates/robots/worker/src/update.rs. */
interface Evidence {
  count: number;
  loops: Loop[];
}

interface Loop {
  index: number;
  ends: [newer: number, older: number];
  chi2: number;
  gate_chi2: number;
  /** The points around the older keyframe and around the newer one, m. */
  scans: [x: number, y: number][][];
  /** Requests with the decision. */
  accept: string;
  reject: string;
}

/** The share of the points that may lie outside of a picture at each of its edges. */
const HIDDEN_SHARE = 0.02;
const SVG = 'http://www.w3.org/2000/svg';

export class LoopsToLookInto {
  readonly element = create('section', { class: 'loops', hidden: '', 'aria-label': 'Loops in doubt' });
  readonly #host: LoopsHost;
  readonly #heading = create('p', { class: 'question', tabindex: '-1' });
  readonly #legend = create('p');
  readonly #list = create('ul');
  readonly #more = create('p');

  constructor(host: LoopsHost) {
    this.#host = host;
    this.#legend.textContent = 'Blue is the older visit and green the newer one, overlaid as the loop claims.';
    this.element.append(this.#heading, this.#legend, this.#list, this.#more);
    stopKeyPropagation(this.element);
  }

  /** Handles a delivery of the worker; returns whether the size may have changed. */
  receive({ kind, text }: Delivery): boolean {
    if (kind === 'evidence') this.#show(JSON.parse(text) as Evidence);
    else if (kind === 'opening' || kind === 'closed' || kind === 'failed') this.element.hidden = true;
    else return false;
    return true;
  }

  #show({ count, loops }: Evidence): void {
    // After the reader's last decision the list stays, and is empty.
    if (count === 0 && this.element.hidden) return;
    const focused = (this.element.getRootNode() as ShadowRoot).activeElement;
    const held = [...this.#list.querySelectorAll('button')].indexOf(focused as HTMLButtonElement);
    this.#heading.textContent =
      count === 0 ? 'No loop is in doubt.' : 'Do these scans belong together? The rest of the graph says no.';
    this.#legend.hidden = count === 0;
    this.#list.replaceChildren(...loops.map((loop) => this.#item(loop)));
    this.#more.textContent = count > loops.length ? `and ${count - loops.length} more` : '';
    this.element.hidden = false;
    // The button with the focus is gone; the one in its place gets it.
    if (held >= 0) ([...this.#list.querySelectorAll('button')].at(Math.min(held, 3 * loops.length - 1)) ?? this.#heading).focus();
  }

  #item(loop: Loop): HTMLElement {
    const item = create('li');
    const ends = loop.ends.join(' to ');
    const show = this.#button(`Show the loop ${ends} on the map`, () => this.#host.show(loop.index));
    show.append(picture(loop));
    const decide = (name: string, request: string): HTMLElement => {
      const button = this.#button(`${name} the loop ${ends}`, () => {
        // Until the graph is solved without it, or checked again.
        item.setAttribute('aria-busy', 'true');
        this.#host.decide(request);
      });
      button.append(name);
      return button;
    };
    const words = create('span');
    words.textContent = `${ends}: χ² ${loop.chi2.toFixed(0)} against ${loop.gate_chi2.toFixed(0)}`;
    item.append(show, words, decide('Accept', loop.accept), decide('Reject', loop.reject));
    return item;
  }

  #button(label: string, act: () => void): HTMLElement {
    const button = create('button', { type: 'button', 'aria-label': label });
    button.addEventListener('click', act);
    return button;
  }
}

interface Range {
  middle: number;
  size: number;
}

/** The range of most points along an axis: a few distant ones would make the rest small. */
function shownRange(scans: Loop['scans'], axis: 0 | 1): Range {
  const values = scans.flat().map((point) => point[axis]).sort((a, b) => a - b);
  const at = (share: number): number => values[Math.round(share * (values.length - 1))] ?? 0;
  const [low, high] = [at(HIDDEN_SHARE), at(1 - HIDDEN_SHARE)];
  return { middle: 0.5 * (low + high), size: high - low };
}

/** Both surroundings in their colours. */
function picture({ scans }: Loop): SVGElement {
  const [x, y] = [shownRange(scans, 0), shownRange(scans, 1)];
  const half = 0.5 * Math.max(x.size, y.size, 1);
  const svg = document.createElementNS(SVG, 'svg');
  svg.setAttribute('viewBox', [x.middle - half, -y.middle - half, 2 * half, 2 * half].join(' '));
  svg.setAttribute('aria-hidden', 'true');
  for (const [k, scan] of scans.entries()) {
    const dots = document.createElementNS(SVG, 'path');
    // A line without length is a dot.
    const path = scan.map(([x, y]) => `M${x.toFixed(2)} ${(-y).toFixed(2)}h0`).join('');
    dots.setAttribute('d', path);
    dots.setAttribute('class', k === 0 ? 'older' : 'newer');
    svg.append(dots);
  }
  return svg;
}
