// Browsers without popovers (Chrome before 114, Firefox before 125, Safari before 17) would show every definition within its
// sentence: there a class shows the one whose word is pressed.

/** Lets the words of the notation open their lines without the browser's popovers. */
export function replaceMissingPopovers(): void {
  if ('popover' in HTMLElement.prototype) return;
  for (const line of document.querySelectorAll<HTMLElement>('[popover]')) {
    const button = document.querySelector(`[popovertarget="${line.id}"]`);
    line.removeAttribute('popover');
    line.hidden = true;
    button?.addEventListener('click', () => (line.hidden = !line.hidden));
  }
}
