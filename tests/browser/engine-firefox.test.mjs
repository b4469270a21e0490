// The tests of every engine, in Firefox.

import { firefoxProblem, openFirefox } from './engines/firefox.mjs';
import { testIn } from './engines/tests.mjs';

testIn('Firefox', openFirefox, firefoxProblem);
