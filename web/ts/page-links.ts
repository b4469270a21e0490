// Links in the text that set a widget: <a class="slam-link" href="?w=16.1&heading=60">60°</a>.
// Without scripts the link opens the page with that state. If the widget is `linked`, each click adds a history entry.

import { updateEntry, pushEntry, statesIn } from './address';
import { SlamWidget } from './element';
import { keepInView } from './keep-in-view';
import { readQuery, type LinkedState } from './links';
import { defaultText } from './values';
import { hideBackButton, showBackButton } from './back-button';
import { reveal } from './reveal';

/** Handles clicks on all slam-links of the document. */
export function installLinks(): void {
  document.addEventListener('click', (event) => {
    if (event.defaultPrevented || event.button !== 0) return;
    if (event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const [origin] = event.composedPath();
    const link = origin instanceof Element ? origin.closest('a.slam-link') : null;
    if (link instanceof HTMLAnchorElement && follow(link)) event.preventDefault();
  });
  window.addEventListener('popstate', ({ state }) => restore(state));
  scrollToAddressed();
}

/** Sets the widget that a link names; returns false if it is not on this page. */
function follow(link: HTMLAnchorElement): boolean {
  const linked = readQuery(link.search);
  if (linked === undefined || !('widget' in linked)) return false;
  const widget = widgetNamed(linked.widget.id);
  if (widget === undefined) return false;
  const isLinked = widget.hasAttribute('linked');
  if (isLinked) updateEntry();
  setState(widget, linked);
  if (isLinked) pushEntry(widget);
  // A link that names a position of the run shows that one.
  const timeline = linked.widget.params.find(({ kind }) => kind === 'timeline')?.id;
  if (!linked.values.some(([id]) => id === timeline)) void widget.playFromStart().catch(() => {});
  hideBackButton();
  reveal(widget);
  if (bringIntoView(widget)) showBackButton(link, widget);
  return true;
}

/** Restores the state of every linked widget from a history entry. */
function restore(entry: unknown): void {
  hideBackButton();
  for (const [name, query] of statesIn(entry)) {
    const widget = widgetNamed(name);
    const stored = readQuery(query);
    if (widget?.hasAttribute('linked') === true && stored !== undefined && 'widget' in stored) setState(widget, stored);
  }
}

/** Sets all parameters: those that the query lacks get their defaults, except that "More" stays open. */
function setState(widget: SlamWidget, { widget: spec, values }: LinkedState): void {
  const texts = new Map(values);
  for (const param of spec.params) {
    const text = texts.get(param.id) ?? (param.id === 'more' ? undefined : defaultText(param));
    if (text !== undefined) widget.set(param.id, text);
  }
}

/** Scrolls to the widget whose state is in the page's address. */
function scrollToAddressed(): void {
  const linked = readQuery(location.search);
  if (linked === undefined || !('widget' in linked) || location.hash !== '') return;
  const widget = widgetNamed(linked.widget.id);
  if (widget?.hasAttribute('linked') !== true) return;
  // A page may hide one until it is used.
  widget.hidden = false;
  reveal(widget);
  keepInView(widget);
}

function widgetNamed(name: string): SlamWidget | undefined {
  const found = document.querySelector(`slam-widget[name="${CSS.escape(name)}"]`);
  return found instanceof SlamWidget ? found : undefined;
}

/** Scrolls if less than half of the widget is visible and it fills less than half of the screen; returns whether it did. */
function bringIntoView(widget: SlamWidget): boolean {
  const { top, bottom } = widget.getBoundingClientRect();
  const visible = Math.min(bottom, innerHeight) - Math.max(top, 0);
  if (visible >= Math.min(bottom - top, innerHeight) / 2) return false;
  keepInView(widget);
  return true;
}
