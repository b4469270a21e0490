// An element and the address of its page: `linked` elements read their state from it and store it there.
//
// An entry of the browser's history keeps the states of all linked widgets: Back finds each as it was.

import { assetUrl } from './assets';
import { readQuery, withState } from './links';
import type { WidgetSpec } from './schema';

/** The receiver of the state in an address. */
export interface Addressee {
  set(id: string, text: string): void;
  wrong(kind: 'name' | 'value', problem: string): void;
}

/** Reads the state of the widget from the page's address, if the address names this widget. */
export function readAddress(element: HTMLElement, spec: WidgetSpec, to: Addressee): void {
  const linked = readQuery(location.search);
  if (linked === undefined) return;
  if (!('widget' in linked)) {
    // One of them reports for all.
    if (document.querySelector('slam-widget[linked]') !== element) return;
    for (const problem of linked.problems) to.wrong('name', problem);
    return;
  }
  if (linked.widget !== spec) return;
  for (const [id, text] of linked.values) to.set(id, text);
  for (const problem of linked.problems) to.wrong('value', problem);
}

/**
 * The page, if it keeps the widget's state in its address; else a separate page with the widget; if there is
 * none, the query alone, which a notebook accepts as well.
 */
export function linkTo(element: HTMLElement, spec: WidgetSpec | undefined, query: string): string {
  const isLinked = element.hasAttribute('linked');
  const page = isLinked ? location.href : assetUrl('embed.html');
  if (page === undefined) return spec === undefined ? '' : withState('', query);
  const link = new URL(page);
  if (spec !== undefined) link.search = withState(link.search, query);
  return link.href;
}

/** Our part of a history entry, besides the parts of others. */
interface Kept {
  slam?: Record<string, string>;
}

/** A linked widget, as far as the history is concerned. */
export interface Linked extends HTMLElement {
  readonly name: string;
  readonly query: string;
  readonly link: string;
}

/** The linked widget in the address: the one that changed last. */
let addressed: Linked | undefined;

/** Records that a linked widget has changed: the next entry's address names it. */
export function tellOf(widget: Linked): void {
  if (widget.hasAttribute('linked')) addressed = widget;
}

/** Stores the current state in the present history entry; also in its address if `settled` is the widget it names. */
export function keepEntry(settled?: Linked): void {
  const address = settled !== undefined && settled === addressed ? settled.link : location.href;
  history.replaceState(withStates(), '', address);
}

/** Adds a history entry with the current state, whose address names that widget. */
export function pushEntry(widget: Linked): void {
  addressed = widget;
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
