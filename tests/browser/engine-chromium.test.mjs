// The tests of every engine, in Chromium.

import { openChromium } from './engines/chromium.mjs';
import { testIn } from './engines/tests.mjs';

testIn('Chromium', openChromium, () => undefined);
