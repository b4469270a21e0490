// Starts the lap under the title, before anything else of the page: it needs neither the widgets nor the end of the text.
// A classic script with its data, which runs where it stands: a browser paints the title while it arrives, and parses
// the text afterwards. A request of its own for the data would be answered only after the whole text was laid out.

import { requestEarly } from '../ts/early-request';
import { LapPlayer } from './lap/player';
import type { Story } from './lap/story';

/** Set by the build: the canonical lap as JSON, and the module of the widgets. */
declare const LAP_STORY: string;
declare const WIDGETS_FILE: string;

const figure = document.querySelector<HTMLElement>('#lap');
if (figure !== null) new LapPlayer(figure, JSON.parse(LAP_STORY) as Story);
// Who scrolls comes to a widget. Its module, the largest file, is on its way before the scripts that use it have run.
addEventListener('scroll', requestWidgets, { once: true, passive: true });

function requestWidgets(): void {
  // A page from the disk contains it.
  if (location.protocol === 'file:') return;
  // Not a preload: WebKit does not use it, and fetches the file twice.
  requestEarly(new URL(WIDGETS_FILE, document.baseURI).href);
}
