// The theme of the surrounding page, light or dark.

export type Theme = 'light' | 'dark';

/** Classes of dark themes in common site generators: Tailwind, Quarto, mdBook, Sphinx. */
const DARK_CLASSES = ['dark', 'dark-mode', 'quarto-dark', 'theme-dark', 'coal', 'navy', 'ayu'];
const LIGHT_CLASSES = ['light', 'light-mode', 'quarto-light', 'theme-light', 'rust'];
const ATTRIBUTES = ['data-theme', 'data-bs-theme', 'data-color-mode', 'data-md-color-scheme'];
/** JupyterLab's attribute on the body: `true` for light themes. */
const JUPYTER_IS_LIGHT = 'data-jp-theme-light';

const systemDark = globalThis.matchMedia?.('(prefers-color-scheme: dark)');
const listeners = new Set<() => void>();

/** The theme of an element: its own, else that of the nearest ancestor, else the system's. */
export function themeOf(element: Element): Theme {
  for (let at: Element | null = element; at !== null; at = parentOf(at)) {
    const theme = at === element ? named(at.getAttribute('theme')) : declaredBy(at);
    if (theme !== undefined) return theme;
  }
  return systemDark?.matches === true ? 'dark' : 'light';
}

/** Calls back whenever the theme of an element may have changed; returns a function that removes the listeners. */
export function watchTheme(element: Element, callback: () => void): () => void {
  const attributeFilter = ['class', ...ATTRIBUTES, JUPYTER_IS_LIGHT];
  for (let at = parentOf(element); at !== null; at = parentOf(at)) {
    observer.observe(at, { attributes: true, attributeFilter });
  }
  if (listeners.size === 0) systemDark?.addEventListener('change', notify);
  listeners.add(callback);
  return () => {
    listeners.delete(callback);
    if (listeners.size > 0) return;
    observer.disconnect();
    systemDark?.removeEventListener('change', notify);
  };
}

function notify(): void {
  for (const listener of listeners) listener();
}

const observer: MutationObserver =
  typeof MutationObserver === 'function' ? new MutationObserver(notify) : (undefined as never);

function parentOf(element: Element): Element | null {
  if (element.parentElement !== null) return element.parentElement;
  const root = element.getRootNode();
  return root instanceof ShadowRoot ? root.host : null;
}

function declaredBy(element: Element): Theme | undefined {
  for (const attribute of ATTRIBUTES) {
    const theme = named(element.getAttribute(attribute));
    if (theme !== undefined) return theme;
  }
  const jupyterIsLight = element.getAttribute(JUPYTER_IS_LIGHT);
  if (jupyterIsLight !== null) return jupyterIsLight === 'false' ? 'dark' : 'light';
  if (DARK_CLASSES.some((name) => element.classList.contains(name))) return 'dark';
  if (LIGHT_CLASSES.some((name) => element.classList.contains(name))) return 'light';
  return undefined;
}

function named(word: string | null): Theme | undefined {
  if (word === 'dark' || word === 'slate') return 'dark';
  return word === 'light' || word === 'default' ? 'light' : undefined;
}
