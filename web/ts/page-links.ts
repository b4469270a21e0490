// Numbers in the text that set a widget: <a class="slam-link" href="?w=16.1&heading=60">60°</a>.
// Without script the link opens the page with that state; with script the widget on the page is set to it. If
// the page keeps states in its address, each link is an entry of the browser's history.

import { updateEntry, pushEntry, statesIn } from './address';
import { SlamWidget } from './element';
import { keepInView } from './keep-in-view';
import { readQuery, type LinkedState } from './links';
import { defaultText } from './values';
import { hideBackButton, showBackButton } from './back-button';

/** Listens to clicks on every slam-link of the document. */
export function installLinks(): void {
  document.addEventListener('click', (event) => {
    if (event.defaultPrevented || event.button !== 0) return;
    if (event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const [origin] = event.composedPath();
    const link = origin instanceof Element ? origin.closest('a.slam-link') : null;
    if (link instanceof HTMLAnchorElement && follow(link)) event.preventDefault();
  });
  window.addEventListener('popstate', ({ state }) => returnTo(state));
  showAddressed();
}

/** Sets the widget that a link names; returns false if it is not on this page. */
function follow(link: HTMLAnchorElement): boolean {
  const linked = readQuery(link.search);
  if (linked === undefined || !('widget' in linked)) return false;
  const widget = widgetNamed(linked.widget.id);
  if (widget === undefined) return false;
  const isKept = widget.hasAttribute('linked');
  if (isKept) updateEntry();
  setWhole(widget, linked);
  if (isKept) pushEntry(widget);
  hideBackButton();
  if (bringIntoView(widget)) showBackButton(link, widget);
  return true;
}

/** Restores the state of every linked widget from a history entry. */
function returnTo(entry: unknown): void {
  hideBackButton();
  for (const [name, query] of statesIn(entry)) {
    const widget = widgetNamed(name);
    const kept = readQuery(query);
    if (widget?.hasAttribute('linked') === true && kept !== undefined && 'widget' in kept) setWhole(widget, kept);
  }
}

/** A query contains a whole state: missing parameters get their defaults. Opened parts stay open. */
function setWhole(widget: SlamWidget, { widget: spec, values }: LinkedState): void {
  const asked = new Map(values);
  for (const param of spec.params) {
    const text = asked.get(param.id) ?? (param.id === 'more' ? undefined : defaultText(param));
    if (text !== undefined) widget.set(param.id, text);
  }
}

/** A page that was opened by a link with a state scrolls to that widget. */
function showAddressed(): void {
  const linked = readQuery(location.search);
  if (linked === undefined || !('widget' in linked) || location.hash !== '') return;
  const widget = widgetNamed(linked.widget.id);
  if (widget?.hasAttribute('linked') === true) keepInView(widget);
}

function widgetNamed(name: string): SlamWidget | undefined {
  const found = document.querySelector(`slam-widget[name="${CSS.escape(name)}"]`);
  return found instanceof SlamWidget ? found : undefined;
}

/** Scrolls if less than half of the widget, or of the screen, shows it; returns whether it did. */
function bringIntoView(widget: SlamWidget): boolean {
  const { top, bottom } = widget.getBoundingClientRect();
  const visible = Math.min(bottom, innerHeight) - Math.max(top, 0);
  if (visible >= Math.min(bottom - top, innerHeight) / 2) return false;
  keepInView(widget);
  return true;
}
