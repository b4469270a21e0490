// own-robot.html: it opens with a mapped building, which the reader's log replaces.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const opened = (test, options = {}, more = {}) => visit('', test, { path: '/own-robot.html', options, ...more });
const still = { reducedMotion: 'reduce' };
const { worst_cm: worst } = JSON.parse(readFileSync(new URL('../../web/page/building/building.json', import.meta.url), 'utf8'));
const live = (tab) => tab.waitForSelector('#building.live');
const says = (tab) => tab.locator('.building-says').textContent();

describe('the building of the own-robot page', () => {
  for (const [width, height] of [[1440, 900], [1280, 680], [390, 844]]) {
    it(`fits on the first screen, ${width}×${height}`, async () => {
      await opened(async (tab) => {
        await live(tab);
        const picture = await tab.locator('.building-picture').boundingBox();
        const slider = await tab.locator('#building input').boundingBox();
        assert.ok(picture.height >= 250 && slider.y + slider.height <= height, `${picture.height}, ${slider.y}`);
        const inked = await tab.locator('.building-picture canvas').evaluate((canvas) => {
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
          return data.filter((value, at) => at % 4 === 3 && value > 0).length;
        });
        assert.ok(inked > 3000, `${inked} pixels are drawn`);
        assert.ok(await tab.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      }, { ...still, viewport: { width, height } });
    });
  }

  it('shows the finished map under reduced motion, and the error of each estimate by keyboard', async () => {
    await opened(async (tab) => {
      await live(tab);
      const slider = tab.getByRole('slider', { name: 'From the wheels to the map' });
      assert.equal(await slider.inputValue(), '2');
      assert.ok((await says(tab)).includes(`${worst[2]} cm`));
      await slider.press('Home');
      assert.ok((await says(tab)).includes(`${Math.round(worst[0] / 100)} m`), await says(tab));
      assert.equal(await slider.getAttribute('aria-valuetext'), await says(tab));
    }, still);
  });

  it('plays from odometry to loop closure, and stops if the reader moves the slider', async () => {
    await opened(async (tab) => {
      await live(tab);
      // At rest it shows the end; a busy machine may miss the very start.
      await tab.waitForFunction(() => Number(document.querySelector('#building input').value) < 1.5);
      await tab.waitForFunction(() => Number(document.querySelector('#building input').value) > 0.5);
      await tab.locator('#building input').press('End');
      assert.equal(await tab.locator('[data-building="play"]').textContent(), 'Play');
      assert.equal(await tab.locator('#building input').inputValue(), '2');
    }, { reducedMotion: 'no-preference' });
  });

  it('is replaced by a log that the reader picks', async () => {
    await opened(async (tab) => {
      await live(tab);
      const chooser = tab.waitForEvent('filechooser');
      await tab.getByRole('button', { name: /Drop your log here/ }).click();
      await (await chooser).setFiles({ name: 'ring.log', mimeType: 'text/plain', buffer: readFileSync(`${h.DIST}/samples/ring.log`) });
      await tab.waitForFunction(() => !document.querySelector('#building').checkVisibility()
        && document.querySelector('slam-widget[name="w16.10"]').getBoundingClientRect().top < 200);
    }, still);
  });

  it('is the one instrument of the page, until the sample takes its place', async () => {
    await opened(async (tab) => {
      await live(tab);
      const widget = tab.locator('slam-widget');
      assert.equal(await widget.isVisible(), false);
      await tab.getByRole('button', { name: 'Map the sample' }).click();
      await tab.waitForFunction(() => document.querySelector('slam-widget').checkVisibility() && !document.querySelector('#building').checkVisibility());
      await tab.waitForFunction(() => document.querySelector('slam-widget').outcome?.sentence.includes('became'));
    }, still);
  });

  it('gives way to a link to the widget, which waits as a drop zone', async () => {
    await visit('', async (tab) => {
      await h.ready(tab);
      assert.equal(await tab.locator('#building').isVisible(), false);
      const zone = tab.getByRole('button', { name: /Drop a log of your robot here/ });
      const [wide, picture] = [await zone.boundingBox(), await tab.locator('slam-widget canvas').boundingBox()];
      // The zone covers the picture but for its margin.
      assert.ok(wide.width > 0.9 * picture.width && wide.height > 0.8 * picture.height, JSON.stringify([wide, picture]));
      const chooser = tab.waitForEvent('filechooser');
      await zone.click();
      await chooser;
    }, { path: '/own-robot.html?w=16.10', options: still });
  });

  for (const [width, height] of [[1440, 900], [1280, 680], [390, 844]]) {
    it(`is what the widget opens on, large and with two choices, at ${width}×${height}`, async () => {
      await visit('', async (tab) => {
        await h.ready(tab);
        await h.quiet(tab);
        const { share, controls } = await tab.evaluate(() => {
          const widget = document.querySelector('slam-widget');
          const picture = widget.shadowRoot.querySelector('canvas');
          const buttons = [...widget.shadowRoot.querySelectorAll('.control')].filter((one) => one.checkVisibility());
          return {
            share: picture.getBoundingClientRect().height / widget.offsetHeight,
            controls: buttons.map((one) => one.querySelector('[data-control]').dataset.control),
          };
        });
        assert.ok(share >= 0.7, `${share} of the height`);
        assert.ok((await h.painted(tab)).share > 0.03, 'a picture');
        assert.deepEqual(controls, ['open', 'sample', 'more']);
        // Start over shows it again.
        await tab.evaluate(() => document.querySelector('slam-widget').press('sample'));
        const waits = (isWaiting) => tab.waitForFunction((is) => {
          const { shadowRoot } = document.querySelector('slam-widget');
          return shadowRoot.querySelector('.drop').checkVisibility() === is;
        }, isWaiting);
        await waits(false);
        const offers = (tab, id) => tab.waitForFunction((name) =>
          document.querySelector('slam-widget').shadowRoot.querySelector(`[data-control="${name}"]`).checkVisibility(), id);
        await offers(tab, 'play');
        await offers(tab, 'colour');
        await tab.evaluate(() => document.querySelector('slam-widget').press('defaults'));
        await waits(true);
      }, { path: '/own-robot.html?w=16.10', options: { ...still, sees: true, viewport: { width, height } } });
    });
  }

  it('gives way to a log that is dropped on it', async () => {
    await opened(async (tab) => {
      await live(tab);
      const log = readFileSync(`${h.DIST}/samples/ring.log`, 'utf8');
      const wasTaken = await tab.locator('#building canvas').evaluate((canvas, text) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([text], 'dropped.log'));
        const send = (type) => canvas.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
        // The browser drops where a page takes the dragover, and would else open the file in its place.
        return ['dragover', 'drop'].map((type) => !send(type));
      }, log);
      assert.deepEqual(wasTaken, [true, true]);
      await tab.waitForFunction(() => !document.querySelector('#building').checkVisibility()
        && document.querySelector('slam-widget[name="w16.10"]').outcome?.sentence.startsWith('dropped.log'));
    }, still);
  });

  it('is a still picture without scripts', async () => {
    await opened(async (tab) => {
      const picture = tab.locator('.building-picture img');
      assert.ok(await picture.evaluate((img) => img.decode().then(() => img.naturalWidth > 100)));
      assert.equal(await tab.locator('#building input').isVisible(), false);
    }, { javaScriptEnabled: false });
  });
});
