// Old addresses: what one page held is on several, and each anchor and each widget is led to its page.

/** The page of each anchor and of each widget, by its name. */
export interface Places {
  anchors: Record<string, string>;
  widgets: Record<string, string>;
}

/** Goes to the page with the anchor or the widget of this address if it is not here; states and anchors are kept. */
export function leadOn({ anchors, widgets }: Places): void {
  const { hash, search } = location;
  const anchor = decodeURIComponent(hash.slice(1));
  const widget = `w${new URLSearchParams(search).get('w')?.replace(/^w/, '')}`;
  const page = anchor === '' ? widgets[widget] : anchors[anchor];
  const here = anchor === '' ? document.querySelector(`slam-widget[name="${CSS.escape(widget)}"]`) : document.getElementById(anchor);
  if (page !== undefined && here === null) location.replace(new URL(`${page}${search}${hash}`, location.href));
}
