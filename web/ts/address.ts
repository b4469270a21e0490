// An element and the address of its page: `linked` ones read their state there and keep it there.
//
// An entry of the browser's history keeps the states of all linked widgets: Back finds each as it was.

import { addressOf } from './beside';
import { readQuery, withState } from './links';
import type { WidgetSpec } from './schema';

/** Takes what the address says. */
export interface Addressee {
  set(id: string, text: string): void;
  wrong(kind: 'name' | 'value', problem: string): void;
}

/** Reads the state of the widget from the page's address, where it is the one that is meant. */
export function readAddress(element: HTMLElement, spec: WidgetSpec, to: Addressee): void {
  const linked = readQuery(location.search);
  if (linked === undefined) return;
  if (!('widget' in linked)) {
    // One of them speaks for all.
    if (document.querySelector('slam-widget[linked]') !== element) return;
    for (const problem of linked.problems) to.wrong('name', problem);
    return;
  }
  if (linked.widget !== spec) return;
  for (const [id, text] of linked.values) to.set(id, text);
  for (const problem of linked.problems) to.wrong('value', problem);
}

/**
 * The page, where it keeps the widget's state in its address; else the widget on a page of its own; where it has
 * none, the query alone, which a notebook takes as well.
 */
export function linkTo(element: HTMLElement, spec: WidgetSpec | undefined, query: string): string {
  const isLinked = element.hasAttribute('linked');
  const page = isLinked ? location.href : addressOf('embed.html');
  if (page === undefined) return spec === undefined ? '' : withState('', query);
  const link = new URL(page);
  if (spec !== undefined) link.search = withState(link.search, query);
  return link.href;
}

/** What an entry of the history keeps of us, beside what others keep there. */
interface Kept {
  slam?: Record<string, string>;
}

/** A widget that may be linked, as far as the history is concerned. */
export interface Linked extends HTMLElement {
  readonly name: string;
  readonly query: string;
  readonly link: string;
}

/** The linked widget that the address tells of: the one that changed last. */
let told: Linked | undefined;

/** A widget that is linked has changed: the address tells of it from its next entry on. */
export function tellOf(widget: Linked): void {
  if (widget.hasAttribute('linked')) told = widget;
}

/** Writes the state of now into the present entry of the history; the address, where `settled` is what it tells of. */
export function keepEntry(settled?: Linked): void {
  const address = settled !== undefined && settled === told ? settled.link : location.href;
  history.replaceState(withStates(), '', address);
}

/** Begins a new entry with the state of now, whose address tells of that widget. */
export function pushEntry(widget: Linked): void {
  told = widget;
  history.pushState(withStates(), '', widget.link);
}

/** The query of each linked widget in an entry, by its name. */
export function statesIn(entry: unknown): [name: string, query: string][] {
  const states = (entry as Kept | null)?.slam;
  return typeof states === 'object' ? Object.entries(states) : [];
}

function withStates(): Kept {
  const linked = document.querySelectorAll<Linked>('slam-widget[linked]');
  const slam = Object.fromEntries([...linked].map(({ name, query }) => [name, query]));
  return { ...(history.state as Kept | null), slam };
}
