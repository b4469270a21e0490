// Adds a copy button to every listing.

const DONE_MS = 2000;

export function addCopyButtons(listings: Iterable<HTMLElement>): void {
  for (const listing of listings) {
    const code = listing.querySelector('pre code');
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = 'Copy';
    const show = (text: string): void => {
      button.textContent = text;
      setTimeout(() => (button.textContent = 'Copy'), DONE_MS);
    };
    button.addEventListener('click', () => {
      navigator.clipboard.writeText(code?.textContent ?? '').then(() => show('Copied'), () => show('Copying failed'));
    });
    button.ariaLive = 'polite';
    listing.querySelector('figcaption')?.append(button);
  }
}
