// Numbers in the text that set a widget: <a class="slam-link" href="?w=16.1&heading=60">60°</a>.
// Without script the link opens the page with that state; with it the widget on the page takes it.

import { SlamWidget } from './element';
import { keepInView } from './follow';
import { readQuery } from './links';
import { defaultText } from './values';

/** Listens to clicks on every slam-link of the document. */
export function installLinks(): void {
  document.addEventListener('click', (event) => {
    if (event.defaultPrevented || event.button !== 0) return;
    if (event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const [origin] = event.composedPath();
    const link = origin instanceof Element ? origin.closest('a.slam-link') : null;
    if (link instanceof HTMLAnchorElement && follow(link)) event.preventDefault();
  });
  showAddressed();
}

/** Sets the widget that a link names; false where it is not on this page. */
function follow(link: HTMLAnchorElement): boolean {
  const linked = readQuery(link.search);
  if (linked === undefined || !('widget' in linked)) return false;
  const widget = widgetNamed(linked.widget.id);
  if (widget === undefined) return false;
  // A link names a whole state: what it leaves out goes back to its default.
  const asked = new Map(linked.values);
  for (const spec of linked.widget.params) widget.set(spec.id, asked.get(spec.id) ?? defaultText(spec));
  bringIntoView(widget);
  return true;
}

/** A page that was opened by a link with a state shows that widget. */
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

/** Scrolls where less than half of the widget, or of the screen, shows it. */
function bringIntoView(widget: SlamWidget): void {
  const { top, bottom } = widget.getBoundingClientRect();
  const visible = Math.min(bottom, innerHeight) - Math.max(top, 0);
  if (visible >= Math.min(bottom - top, innerHeight) / 2) return;
  keepInView(widget);
}
