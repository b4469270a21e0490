// The colours that the reader chose, kept in the browser for the next page. Nothing is kept of a reader who chooses none.

export type ThemeChoice = 'auto' | 'light' | 'dark';

const STORAGE_KEY = 'slam-colours';

/** The kept choice. */
export function chosenTheme(): ThemeChoice {
  try {
    const kept = localStorage.getItem(STORAGE_KEY);
    return kept === 'light' || kept === 'dark' ? kept : 'auto';
  } catch {
    // A browser that stores nothing, as for a page opened from a file.
    return 'auto';
  }
}

/** Keeps a choice; `auto` removes it. */
export function keepTheme(choice: ThemeChoice): void {
  try {
    if (choice === 'auto') localStorage.removeItem(STORAGE_KEY);
    else localStorage.setItem(STORAGE_KEY, choice);
  } catch {
    // It lasts until the page is left.
  }
}

/** Style and widgets follow `data-theme`, or the system without it. */
export function showTheme(choice: ThemeChoice): void {
  if (choice === 'auto') delete document.documentElement.dataset['theme'];
  else document.documentElement.dataset['theme'] = choice;
}
