// Starts the lap under the title, before anything else of the page: it needs neither the widgets nor the end of the text.

import { LapPlayer } from './lap/player';
import type { Story } from './lap/story';
import { startReplay } from './replay';

/** Set by the build: the canonical lap. */
declare const LAP_STORY_FILE: string;

void startReplay('#lap', LAP_STORY_FILE, (figure, story: Story) => new LapPlayer(figure, story));
