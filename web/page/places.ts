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
  const widget = new URLSearchParams(search).get('w');
  const page = anchor === '' ? widgets[`w${widget?.replace(/^w/, '')}`] : anchors[anchor];
  const isHere = anchor === '' ? document.querySelector(`slam-widget[name="w${widget?.replace(/^w/, '')}"]`) : document.getElementById(anchor);
  if (page !== undefined && isHere === null) location.replace(new URL(`${page}${search}${hash}`, location.href));
}
