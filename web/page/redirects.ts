// Redirects of old addresses: the companion was one page, and anchors and widgets are now on several.

/** The page of each anchor and widget. */
export interface Places {
  anchors: Record<string, string>;
  widgets: Record<string, string>;
}

/** Redirects to the page with the anchor or widget of the address, if it is not on this one. Keeps query and anchor. */
export function redirectOldAddress({ anchors, widgets }: Places): void {
  const { hash, search } = location;
  const anchor = decodeURIComponent(hash.slice(1));
  const widget = `w${new URLSearchParams(search).get('w')?.replace(/^w/, '')}`;
  const page = anchor === '' ? widgets[widget] : anchors[anchor];
  const here = anchor === '' ? document.querySelector(`slam-widget[name="${CSS.escape(widget)}"]`) : document.getElementById(anchor);
  if (page !== undefined && here === null) location.replace(new URL(`${page}${search}${hash}`, location.href));
}
