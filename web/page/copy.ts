// A button on every listing that copies its code.

const DONE_MS = 2000;

export function addCopyButtons(listings: Iterable<HTMLElement>): void {
  for (const listing of listings) {
    const code = listing.querySelector('pre code');
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = 'Copy';
    const say = (words: string): void => {
      button.textContent = words;
      setTimeout(() => (button.textContent = 'Copy'), DONE_MS);
    };
    button.addEventListener('click', () => {
      navigator.clipboard.writeText(code?.textContent ?? '').then(() => say('Copied'), () => say('The browser refuses'));
    });
    button.ariaLive = 'polite';
    listing.querySelector('figcaption')?.append(button);
  }
}
