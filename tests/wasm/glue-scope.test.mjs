// What eframe sees in place of the page's window.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { it } from 'node:test';
import * as esbuild from '../../web/node_modules/esbuild/lib/main.js';

class Page {
  name = 'page';

  toString() {
    return this.name;
  }
}
globalThis.window = new Page();

const source = readFileSync(new URL('../../web/ts/glue-scope.ts', import.meta.url), 'utf8');
const { code } = await esbuild.transform(source, { loader: 'ts' });
const { windowOf } = await import(`data:text/javascript;base64,${Buffer.from(code).toString('base64')}`);

it('takes from the page all but frames, timers and pixels', () => {
  const asked = [];
  const seen = windowOf({ request: (callback) => asked.push(callback), cancel: () => {}, pixelRatio: () => 2 });
  assert.equal(seen.constructor, Page);
  assert.equal(seen.toString(), 'page');
  assert.equal(seen.devicePixelRatio, 2);
  const draw = () => {};
  seen.requestAnimationFrame(draw);
  seen.setTimeout(draw);
  assert.deepEqual(asked, [draw, draw]);
});
