// Small helpers on the document.

export function create<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

/** Listens until the returned function is called. */
export function listen(target: EventTarget, type: string, callback: () => void): () => void {
  target.addEventListener(type, callback);
  return () => target.removeEventListener(type, callback);
}

/** The next task: what the reader does comes between. Timers would wait for milliseconds. */
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

/** Keeps keys from the page: slides and chapters turn on arrows, whatever has the focus. */
export function keepKeys(element: HTMLElement): void {
  element.addEventListener('keydown', (event) => {
    if (event.key !== 'Tab' && event.key !== 'Escape') event.stopPropagation();
  });
}

/** Scrolls until a box (left, top, width, height) inside an element is visible above a bar. */
export function reveal(
  inside: HTMLElement,
  [left, top, width, height]: readonly [number, number, number, number],
  barHeight: number,
): void {
  const at = inside.getBoundingClientRect().top + top;
  if (at >= 0 && at + height <= window.innerHeight - barHeight) return;
  const marker = create('span');
  marker.style.position = 'absolute';
  for (const [side, value] of Object.entries({ left, top, width, height })) {
    marker.style.setProperty(side, `${value}px`);
  }
  inside.append(marker);
  marker.scrollIntoView({ block: 'center', inline: 'nearest' });
  marker.remove();
}

/** Properties that were set before an element was defined hide those of its class: sets them again. */
export function upgradeProperties(element: HTMLElement): void {
  const early = element as unknown as Record<string, unknown>;
  for (const [key, value] of Object.entries(early)) {
    if (!(key in Object.getPrototypeOf(element))) continue;
    delete early[key];
    early[key] = value;
  }
}

/** A sentence with `names` marked, as text and never as HTML. */
export function marked(sentence: string): (string | HTMLElement)[] {
  return sentence.split('`').map((part, at) => {
    if (at % 2 === 0) return part;
    const name = create('code');
    name.textContent = part;
    return name;
  });
}
