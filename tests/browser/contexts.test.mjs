// WebGL contexts are limited, and the browser may take each away at any time.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const on = h.visitor();
const ONE = '<slam-widget name="w16.2"></slam-widget>';

/** Init script: the first contexts are lost as soon as they are created. */
const losing = (count) => `<script>
  const { getContext } = HTMLCanvasElement.prototype;
  window.toLose = ${count};
  HTMLCanvasElement.prototype.getContext = function (type, given) {
    const isNew = type === 'webgl2' && !this.seen;
    this.seen = true;
    const context = getContext.call(this, type, given);
    if (isNew && (window.toLose -= 1) >= 0) context.getExtension('WEBGL_lose_context').loseContext();
    return context;
  };
</script>`;
const canvases = (tab) => tab.evaluate(() =>
  document.querySelector('slam-widget').shadowRoot.querySelectorAll('canvas').length);

describe('a context that is lost while a widget starts', () => {
  it('is requested again, and the reader sees the widget', async () => {
    await on(ONE, async (tab) => {
      await h.ready(tab);
      assert.equal(await tab.locator('slam-widget .failure').count(), 0);
      assert.equal(await canvases(tab), 1);
      assert.ok((await h.painted(tab)).share > 0.03);
    }, { head: losing(2), quiet: false, options: { sees: true } });
  });

  it('is given up after repeated losses, with one sentence and "Try again"', async () => {
    await on(ONE, async (tab) => {
      const failure = tab.locator('slam-widget .failure');
      await failure.waitFor();
      assert.match(await failure.innerText(), /keeps discarding its WebGL context/);
      assert.equal(await canvases(tab), 0);
      await tab.evaluate(() => (window.toLose = 0));
      await tab.getByRole('button', { name: 'Try again' }).click();
      await h.ready(tab);
      assert.equal(await canvases(tab), 1);
    }, { head: losing(1e9), quiet: false });
  });
});

describe('eighteen widgets in view at once', () => {
  const cells = Array.from({ length: 18 }, (_, i) =>
    `<div style="height: 280px; overflow: hidden"><slam-widget name="w16.2" id="w${i}"></slam-widget></div>`).join('');
  const body = `<div style="display: grid; grid-template-columns: repeat(6, 1fr)">${cells}</div>`;
  const running = (tab) => tab.evaluate(() =>
    [...document.querySelectorAll('slam-widget')].filter(({ state }) => state === 'running').map(({ id }) => id));

  for (const [where, most, options] of [['', 8, {}], [' on a phone', 4, { viewport: { width: 390, height: 844 } }]]) {
    it(`share ${most} contexts${where}; the others are pictures, and draw once the reader turns to them`, () => on(body, async (tab) => {
      await tab.waitForFunction((count) => [...document.querySelectorAll('slam-widget')]
        .filter(({ shadowRoot }) => shadowRoot.querySelector('.stage.live') !== null).length === count, most);
      const first = await running(tab);
      assert.equal(first.length, most);
      const resting = Array.from({ length: 18 }, (_, i) => `w${i}`).find((id) => !first.includes(id));
      const shown = await tab.evaluate(async (id) => {
        const image = document.querySelector(`#${id}`).shadowRoot.querySelector('.picture');
        await image.decode();
        return image.getBoundingClientRect().height;
      }, resting);
      assert.ok(shown > 100, `a picture ${shown} px high`);
      await tab.locator(`#${resting}`).hover({ position: { x: 50, y: 100 } });
      await h.ready(tab, `#${resting}`);
      assert.equal((await running(tab)).length, most);
      assert.equal(await tab.locator('slam-widget .failure').count(), 0);
    }, { options }));
  }
});

it('a widget longer than the largest canvas is drawn completely, at a lower resolution', async () => {
  await on('<slam-widget name="w16.3" more="on"></slam-widget>', async (tab) => {
    await h.ready(tab);
    const canvas = await tab.evaluate(() => {
      const { width, height, clientWidth, clientHeight } =
        document.querySelector('slam-widget').shadowRoot.querySelector('canvas');
      return { width, height, clientWidth, clientHeight };
    });
    assert.ok(canvas.clientHeight * 4 > 8192, `${canvas.clientHeight} px are not too high at a ratio of 4`);
    assert.ok(canvas.height > 7000 && canvas.height <= 8192, `${canvas.height} pixels`);
    const [across, down] = [canvas.width / canvas.clientWidth, canvas.height / canvas.clientHeight];
    assert.ok(Math.abs(across - down) < 0.01, `${across} and ${down} pixels for a CSS pixel`);
    // The browser provides the whole buffer, and the widget fills it.
    const last = await tab.evaluate(async () => {
      const picture = await document.querySelector('slam-widget').snapshot();
      const copy = new OffscreenCanvas(picture.width, 400).getContext('2d');
      copy.drawImage(picture, 0, 400 - picture.height);
      return { height: picture.height, colors: new Set(new Uint32Array(copy.getImageData(0, 0, picture.width, 400).data.buffer)).size };
    });
    assert.equal(last.height, canvas.height);
    assert.ok(last.colors > 3, `${last.colors} colours at the end`);
  }, { options: { sees: true, deviceScaleFactor: 4, viewport: { width: 390, height: 800 } } });
});
