// An element and the address of its page: `linked` ones read their state there and keep it there.

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

/** The page, where it keeps the widget's state in its address; else the widget on a page of its own. */
export function linkTo(element: HTMLElement, spec: WidgetSpec | undefined, query: string): string {
  const isLinked = element.hasAttribute('linked');
  const link = new URL(isLinked ? location.href : new URL('embed.html', import.meta.url));
  if (spec !== undefined) link.search = withState(link.search, spec, query);
  return link.href;
}
