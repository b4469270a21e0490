// Runs before the page is painted: what depends on a script, or on the chosen colours, does not change afterwards.

import { chosenTheme, showTheme } from './theme-choice';

document.documentElement.dataset['script'] = 'on';
showTheme(chosenTheme());
