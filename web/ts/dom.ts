// DOM helpers.

export function create<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

/** Adds a listener; returns a function that removes it. */
export function listen(target: EventTarget, type: string, callback: () => void): () => void {
  target.addEventListener(type, callback);
  return () => target.removeEventListener(type, callback);
}

/** Yields to the event loop, which handles input first. Nested timers would add a delay of 4 ms. */
export function nextTask(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(undefined);
  });
}

/** Hides key presses from the page: on arrow keys slides and books turn a page, whatever has the focus. */
export function stopKeyPropagation(element: HTMLElement): void {
  element.addEventListener('keydown', (event) => {
    if (event.key !== 'Tab' && event.key !== 'Escape') event.stopPropagation();
  });
}

/** Sets properties again that were set before the element was defined, and hide those of its class. */
export function upgradeProperties(element: HTMLElement): void {
  const early = element as unknown as Record<string, unknown>;
  for (const [key, value] of Object.entries(early)) {
    if (!(key in Object.getPrototypeOf(element))) continue;
    delete early[key];
    early[key] = value;
  }
}

/** Converts a sentence with `names` in backticks to text and code elements, never HTML. */
export function withCode(sentence: string): (string | HTMLElement)[] {
  return sentence.split('`').map((part, at) => {
    if (at % 2 === 0) return part;
    const name = create('code');
    name.textContent = part;
    return name;
  });
}
