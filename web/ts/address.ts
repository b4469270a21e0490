// The address of the page: `linked` elements read their state from it and store it there.
//
// Each history entry contains the states of all linked widgets, and Back restores them.

import { assetUrl } from './assets';
import { readQuery, withState } from './links';
import type { WidgetSpec } from './schema';

/** Receives the state of an address. */
export interface AddressReader {
  set(id: string, text: string): void;
  invalid(kind: 'name' | 'value', problem: string): void;
}

/** Reads the state of the widget from the page's address, if that names this widget. */
export function readAddress(element: HTMLElement, spec: WidgetSpec, to: AddressReader): void {
  const linked = readQuery(location.search);
  if (linked === undefined) return;
  if (!('widget' in linked)) {
    // Only the first linked element reports it.
    if (document.querySelector('slam-widget[linked]') !== element) return;
    for (const problem of linked.problems) to.invalid('name', problem);
    return;
  }
  if (linked.widget !== spec) return;
  for (const [id, text] of linked.values) to.set(id, text);
  for (const problem of linked.problems) to.invalid('value', problem);
}

/**
 * Returns the page's address for a linked element, else that of `embed.html`. In the standalone module, which has no
 * `embed.html`, it is only the query, which `from_link` of the Python package accepts.
 */
export function linkTo(element: HTMLElement, spec: WidgetSpec | undefined, query: string): string {
  const isLinked = element.hasAttribute('linked');
  const page = isLinked ? location.href : assetUrl('embed.html');
  if (page === undefined) return spec === undefined ? '' : withState('', query);
  const link = new URL(page);
  if (spec !== undefined) link.search = withState(link.search, query);
  return link.href;
}

/** Our part of a history entry; other scripts may store more. */
interface HistoryState {
  slam?: Record<string, string>;
}

/** What the history needs of a widget. */
export interface Linked extends HTMLElement {
  readonly name: string;
  readonly query: string;
  readonly link: string;
}

/** The linked widget that changed last; the address names it. */
let addressed: Linked | undefined;

/** Makes a linked widget the one that the next address names. */
export function setAddressed(widget: Linked): void {
  if (widget.hasAttribute('linked')) addressed = widget;
}

/** Stores the states in the current history entry; also in its address if `settled` is the widget that it names. */
export function updateEntry(settled?: Linked): void {
  const address = settled !== undefined && settled === addressed ? settled.link : location.href;
  history.replaceState(withStates(), '', address);
}

/** Adds a history entry with the current states, whose address names `widget`. */
export function pushEntry(widget: Linked): void {
  addressed = widget;
  history.pushState(withStates(), '', widget.link);
}

/** Returns name and query of each linked widget in a history entry. */
export function statesIn(entry: unknown): [name: string, query: string][] {
  const states = (entry as HistoryState | null)?.slam;
  return typeof states === 'object' ? Object.entries(states) : [];
}

function withStates(): HistoryState {
  const linked = document.querySelectorAll<Linked>('slam-widget[linked]');
  const slam = Object.fromEntries([...linked].map(({ name, query }) => [name, query]));
  return { ...(history.state as HistoryState | null), slam };
}
