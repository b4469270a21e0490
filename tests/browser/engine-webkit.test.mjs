// The tests of every engine, in WebKit.

import { openWebKit, webkitProblem } from './engines/webkit.mjs';
import { testIn } from './engines/tests.mjs';

testIn('WebKit', openWebKit, webkitProblem);
