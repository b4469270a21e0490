// Starts the lap under the title, before anything else of the page: it needs neither the widgets nor the end of the text.
// A classic script, which runs where it stands; a module could wait until those of the whole page have run.

import { LapPlayer } from './lap/player';
import type { Story } from './lap/story';
import { startReplay } from './replay';

/** Set by the build: the canonical lap, and the module of the widgets. */
declare const LAP_STORY_FILE: string;
declare const WIDGETS_FILE: string;

void startReplay('#lap', LAP_STORY_FILE, (figure, story: Story) => new LapPlayer(figure, story));
// Who scrolls comes to a widget. Its module, the largest file, is on its way before the scripts that use it have run.
addEventListener('scroll', requestWidgets, { once: true, passive: true });

function requestWidgets(): void {
  // A page from the disk contains it.
  if (location.protocol === 'file:') return;
  const link = document.createElement('link');
  Object.assign(link, { rel: 'preload', as: 'fetch', href: WIDGETS_FILE, crossOrigin: 'anonymous' });
  document.head.append(link);
}
