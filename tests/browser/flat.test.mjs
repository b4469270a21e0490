// A custom flat in w16.2: drawn by mouse, touch and keyboard, stored in links, history and files.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { native } from '../native.mjs';
import { gzipSync } from 'node:zlib';
import { GALLERY } from '../../web/page/gallery.mjs';
import * as h from './harness.mjs';
import { fingers } from './touch.mjs';

const visit = h.visitor();
const BODY = '<slam-widget name="w16.2" linked></slam-widget>';

const on = (test, { query = '?w=16.2&edit=wall', ...options } = {}) => visit(BODY, async (tab, server) => {
  await h.ready(tab);
  await test(tab, server);
}, { path: `/t.html${query}`, options });

const outcome = (tab) => tab.evaluate(() => document.querySelector('slam-widget').outcome);
const get = (tab, id) => tab.evaluate((name) => document.querySelector('slam-widget').get(name), id);
const press = (tab, id) => tab.evaluate((name) => document.querySelector('slam-widget').press(name), id);
const changed = (tab, flat) => tab.waitForFunction((old) => document.querySelector('slam-widget').get('flat') !== old, flat);
const walls = async (tab) => Number(/(\d+) walls?,/.exec(await tab.evaluate(() => document.querySelector('slam-widget').summary))[1]);

/** Draws on the map with the mouse, from one position in metres to another. */
async function drag(tab, from, to) {
  const [start, end] = [await h.pointOf(tab, 'map', ...from), await h.pointOf(tab, 'map', ...to)];
  await tab.mouse.move(...start);
  await tab.mouse.down();
  await h.moreFrames(tab, 1);
  await tab.mouse.move(...end, { steps: 3 });
  await h.moreFrames(tab, 1);
  await tab.mouse.up();
  await h.moreFrames(tab, 1);
}

/** The file that the widget saves. */
async function saved(tab) {
  const download = tab.waitForEvent('download');
  await press(tab, 'save-flat');
  return (await h.bytesOf(await download)).toString('utf8');
}

describe('a custom flat', () => {
  it('follows the mouse: the wall appears at once, and the lap after it', async () => {
    await on(async (tab) => {
      const before = await outcome(tab);
      await drag(tab, [5, 3.8], [5, 4.1]);
      await changed(tab, '');
      assert.equal(await get(tab, 'world'), 'own');
      assert.equal(await walls(tab), 19);
      const after = await outcome(tab);
      assert.match(after.sentence, /^Wall 19 of 19, from \(5, 3\.8\) to \(5, 4\.1\) m; /);
      assert.notDeepEqual(after.facts, before.facts);
      // Two walls from one corner are separate.
      await drag(tab, [1, 1], [2, 1]);
      await drag(tab, [1, 1], [1, 2]);
      assert.equal(await walls(tab), 21);
      await press(tab, 'take-back');
      assert.equal(await walls(tab), 20);
    });
  });

  for (const [width, height] of [[1440, 900], [1280, 680], [390, 844]]) {
    it(`is drawn on a large map with few tools, the rest under More, at ${width}×${height}`, async () => {
      await visit('', async (tab) => {
        const css = 'slam-widget[name="w16.2"]';
        await h.ready(tab, css);
        await h.quiet(tab);
        const { wide, high, shown } = await tab.evaluate((name) => {
          const element = document.querySelector(name);
          const { shadowRoot } = element;
          const controls = [...shadowRoot.querySelectorAll('.control:not([hidden]) [data-control]')];
          return {
            wide: element.sceneBox()[2] / shadowRoot.querySelector('canvas').clientWidth,
            high: element.sceneBox()[3] / shadowRoot.querySelector('canvas').clientHeight,
            shown: [...new Set(controls.map(({ dataset }) => dataset.control))].sort(),
          };
        }, css);
        assert.deepEqual(shown, ['edit', 'edit-flat', 'more', 'play', 't', 'take-back']);
        // As wide as the frame, or half as high beside the controls. It was a sixth of the height under 25 buttons.
        assert.ok(wide > 0.8 || high > 0.45, `the map has ${wide} of the width, ${high} of the height`);
      }, { path: '/index.html?w=16.2&edit=wall', options: { viewport: { width, height } } });
    });
  }

  it('follows a finger that draws horizontally, and the page does not scroll', async () => {
    await on(async (tab) => {
      const scrolled = () => tab.evaluate(() => scrollY);
      const before = await scrolled();
      const { touch } = await fingers(tab);
      const from = await h.pointOf(tab, 'map', 1, 1);
      const to = await h.pointOf(tab, 'map', 3, 1.3);
      const between = [0, 1].map((axis) => (from[axis] + to[axis]) / 2);
      await touch('touchStart', [from]);
      await touch('touchMove', [between]);
      await touch('touchMove', [to]);
      await changed(tab, '');
      await touch('touchEnd');
      await h.moreFrames(tab, 1);
      assert.equal(await walls(tab), 19);
      assert.equal(await scrolled(), before);
    }, { hasTouch: true });
  });

  it('is edited by keyboard alone, with announcements for a screen reader', async () => {
    await on(async (tab) => {
      // The buttons that step from piece to piece are under More.
      await tab.evaluate(() => document.querySelector('slam-widget').set('more', true));
      await tab.waitForFunction(() => document.querySelector('slam-widget').shadowRoot.querySelector('[data-control="piece-on"]').checkVisibility());
      await tab.evaluate(() => document.querySelector('slam-widget').shadowRoot.querySelector('[data-control="piece-on"]').focus());
      await tab.keyboard.press('PageDown');
      await tab.waitForFunction(() => document.querySelector('slam-widget').get('piece') === 'wall');
      await tab.keyboard.press('PageUp');
      assert.equal(await get(tab, 'piece-number'), 18);
      await tab.keyboard.press('ArrowLeft');
      await changed(tab, '');
      assert.match((await outcome(tab)).sentence, /^Wall 18 of 18, from \(9\.55, 7\.4\)/);
      const said = () => tab.waitForFunction(() => /^Wall 18 of 18, from \(9\.55/
        .test(document.querySelector('slam-widget').shadowRoot.querySelector('[aria-live]').textContent));
      await said();
      const flat = await get(tab, 'flat');
      await tab.keyboard.press('Delete');
      await changed(tab, flat);
      assert.equal(await walls(tab), 17);
      await tab.keyboard.press('Control+z');
      assert.equal(await walls(tab), 18);
      assert.equal(await get(tab, 'flat'), flat);
      await tab.keyboard.press('Control+y');
      assert.equal(await walls(tab), 17);
      const shortcuts = await tab.evaluate(() => document.querySelector('slam-widget').shadowRoot
        .querySelector('[data-control="remove"]').getAttribute('aria-keyshortcuts'));
      assert.equal(shortcuts, 'Delete');
    });
  });

  it('fits into a link of less than 2 kB, and Back restores it', async () => {
    await on(async (tab, server) => {
      await drag(tab, [1, 1], [2, 1]);
      await changed(tab, '');
      await tab.waitForFunction(() => location.search.includes('flat='));
      const link = await tab.evaluate(() => document.querySelector('slam-widget').link);
      assert.ok(link.length < 2000, `${link.length} characters`);
      const flat = await get(tab, 'flat');
      await tab.evaluate(() => {
        const a = Object.assign(document.createElement('a'), { className: 'slam-link', href: '?w=16.2&world=ring', textContent: 'ring' });
        document.body.prepend(a);
        a.click();
      });
      await tab.waitForFunction(() => document.querySelector('slam-widget').get('world') === 'ring');
      assert.equal(await get(tab, 'flat'), '');
      await tab.goBack();
      await changed(tab, '');
      assert.equal(await get(tab, 'flat'), flat);
      assert.equal(await get(tab, 'world'), 'own');
      const shown = await outcome(tab);
      await tab.goto(new URL(link, server.url).href);
      await h.ready(tab);
      assert.equal(await get(tab, 'flat'), flat);
      assert.deepEqual((await outcome(tab)).facts, shown.facts);
    });
  });

  it('that is damaged is reported in one sentence, and the widget keeps its world', async () => {
    const note = (tab, pattern) => tab.waitForFunction((source) => new RegExp(source)
      .test(document.querySelector('slam-widget').shadowRoot.querySelector('.note').textContent), pattern);
    await on(async (tab) => {
      await note(tab, 'flat is damaged or cut off');
      assert.equal(await get(tab, 'world'), 'apartment');
      assert.equal(await get(tab, 'flat'), '');
      for (const [flat, why] of [['AAAAA', /damaged or cut off/], ['%%%', /letters, digits, - and _/], ['A'.repeat(50_000), /at most 33000/]]) {
        const error = await tab.evaluate((text) => {
          try {
            document.querySelector('slam-widget').set('flat', text);
            return '';
          } catch (thrown) {
            return `${thrown.name}: ${thrown.message}`;
          }
        }, flat);
        assert.match(error, why);
        assert.match(error, /^RangeError: /);
        assert.ok(error.length < 300, error);
      }
      assert.equal(await get(tab, 'world'), 'apartment');
    }, { query: '?w=16.2&flat=BAAAAAAAAAAA' });
  });

  it('is saved as a file that gives the same lap on the command line, and opened again', async () => {
    await on(async (tab) => {
      await drag(tab, [5, 3.8], [5, 4.1]);
      await changed(tab, '');
      const { facts } = await outcome(tab);
      const flat = await get(tab, 'flat');
      const json = await saved(tab);
      assert.equal(JSON.parse(json).walls_m.length, 19);
      await press(tab, 'defaults');
      assert.equal(await get(tab, 'world'), 'apartment');
      const chosen = tab.waitForEvent('filechooser');
      await press(tab, 'open-flat');
      await (await chosen).setFiles({ name: 'flat.json', mimeType: 'application/json', buffer: Buffer.from(json) });
      await changed(tab, '');
      assert.equal(await get(tab, 'flat'), flat);
      await tab.evaluate(() => document.querySelector('slam-widget').openFile(new File(['{"walls_m": []'], 'broken.json')));
      await tab.waitForFunction(() => /^broken\.json cannot be driven: line 1/.test(document.querySelector('slam-widget').outcome.sentence));
      assert.equal(await get(tab, 'flat'), flat);
      const folder = mkdtempSync(join(tmpdir(), 'flat-'));
      try {
        writeFileSync(join(folder, 'flat.json'), json);
        const lap = JSON.parse(native('ch16', 'lap', '--world', join(folder, 'flat.json'), '--information', 'chapter', '--json'));
        assert.equal(lap.keyframes, facts.keyframes);
        assert.equal(lap.keyframe_rms_m, facts.keyframe_rms_m);
        assert.equal(lap.odometry_end_error_m, facts.odometry_error_m);
      } finally {
        rmSync(folder, { recursive: true });
      }
    });
  });
});

describe('the game', () => {
  for (const [width, height] of [[1440, 900], [1280, 680], [390, 844]]) {
    it(`shows the flat, tools and Drive on one screen, and no other control, at ${width}×${height}`, async () => {
      await visit('', async (tab) => {
        await h.ready(tab);
        await h.quiet(tab);
        const { share, bottom, others } = await tab.evaluate(() => {
          const { shadowRoot } = document.querySelector('slam-widget');
          const box = shadowRoot.querySelector('canvas').getBoundingClientRect();
          const controls = [...shadowRoot.querySelectorAll(':is(button, input, select, summary):not([aria-hidden])')];
          return { share: box.height / innerHeight, bottom: box.bottom, others: controls.filter((one) => one.checkVisibility()).length };
        });
        assert.equal(others, 0);
        assert.ok(bottom <= height, `the flat ends at ${bottom}`);
        assert.ok(share >= 0.65, `the flat has ${share} of the screen`);
        assert.equal(await tab.getByRole('button', { name: 'Pencil' }).getAttribute('aria-pressed'), 'true');
      }, { path: '/break.html', options: { viewport: { width, height } } });
    });
  }

  it('offers no tool over a picture that cannot be drawn on', async () => {
    const head = "<head><script>HTMLCanvasElement.prototype.getContext = () => null</script>";
    const page = readFileSync(join(h.DIST, 'break.html'), 'utf8').replace('<head>', head);
    await visit('', async (tab) => {
      await tab.locator('slam-widget .failure').waitFor();
      assert.equal(await tab.locator('.game-tools button:not([disabled])').count(), 0);
    }, { path: '/break.html', quiet: false, server: { pages: { '/break.html': page } } });
  });

  it('takes a tool in hand, and drives the robot when asked to', async () => {
    await visit('', async (tab) => {
      await h.ready(tab);
      const tool = (name) => tab.locator('.game-tools').getByRole('button', { name });
      await tool('Eraser').click();
      assert.equal(await get(tab, 'edit'), 'remove');
      assert.deepEqual([await tool('Pencil').getAttribute('aria-pressed'), await tool('Eraser').getAttribute('aria-pressed')], ['false', 'true']);
      await tool('Drive').click();
      assert.equal(await get(tab, 'edit'), 'off');
      await tab.waitForFunction(() => document.querySelector('slam-widget').get('t') > 0);
      await tool('More').click();
      await tab.locator('slam-widget').getByRole('slider').first().waitFor();
    }, { path: '/break.html' });
  });
});

describe('laps that break', () => {
  const LARGEST_BYTES = 6_000;

  it('stand on cards with small pictures, and a press sets the lap to one', async () => {
    for (const { id } of GALLERY) {
      const bytes = gzipSync(readFileSync(join(h.DIST, 'pictures', `break-${id}.svg`))).length;
      assert.ok(bytes <= LARGEST_BYTES, `${id}: ${bytes} bytes`);
    }
    await visit('', async (tab) => {
      const links = tab.locator('.gallery a');
      assert.equal(await links.count(), GALLERY.length);
      await tab.getByRole('link', { name: 'A library' }).click();
      await h.ready(tab, 'slam-widget[name="w16.2"]');
      const { facts } = await tab.evaluate(() => document.querySelector('slam-widget[name="w16.2"]').outcome);
      assert.ok(facts.graph_error_m > 8 && facts.false_loops >= 4, JSON.stringify(facts));
    }, { path: '/break.html' });
  });

  it('are sent with their picture and a link that opens them, and links to the site show one', async () => {
    const { state } = GALLERY.find(({ id }) => id === 'library');
    const sharing = `<script>Object.assign(Navigator.prototype, {
      canShare: ({ files }) => files.length === 1,
      share: async ({ files: [file], url }) => { window.sent = [file.name, [...new Uint8Array(await file.arrayBuffer()).subarray(1, 4)], url]; },
    })</script>`;
    const page = readFileSync(join(h.DIST, 'break.html'), 'utf8').replace('<head>', `<head>${sharing}`);
    await visit('', async (tab) => {
      await tab.locator('.own-card').getByRole('button', { name: 'Send' }).click();
      await tab.waitForFunction(() => window.sent !== undefined);
      const [name, start, url] = await tab.evaluate(() => window.sent);
      assert.equal(name, 'my-flat.png');
      assert.deepEqual(start, [...Buffer.from('PNG')]);
      assert.ok(url.includes('flat='), url);
      const card = await tab.locator('meta[property="og:image"]').getAttribute('content');
      const size = await tab.evaluate(async (source) => {
        const picture = Object.assign(new Image(), { src: source });
        await picture.decode();
        return [picture.naturalWidth, picture.naturalHeight];
      }, card);
      assert.deepEqual(size, [1200, 630]);
    }, { path: `/break.html?w=16.2&${state}`, server: { pages: { '/break.html': page } } });
  });

  it('give a flat of one’s own a card with a link and a picture, which another world takes away', async () => {
    const { state } = GALLERY.find(({ id }) => id === 'library');
    await visit('', async (tab) => {
      const card = tab.locator('.own-card');
      await card.getByText('The robot ends 8.5 m off').waitFor();
      await card.getByText(/^Score \d/).waitFor();
      const download = tab.waitForEvent('download');
      await card.getByRole('button', { name: 'Save picture' }).click();
      const png = await h.bytesOf(await download);
      assert.deepEqual([...png.subarray(1, 4)], [...Buffer.from('PNG')]);
      // By keyboard: the saved picture's sentence has just moved the page.
      await card.getByRole('button', { name: 'Copy link' }).press('Enter');
      await card.getByText(/The link is copied|flat=/).waitFor();
      await tab.evaluate(() => document.querySelector('slam-widget[name="w16.2"]').set('world', 'ring'));
      await card.waitFor({ state: 'hidden' });
    }, { path: `/break.html?w=16.2&${state}` });
  });
});
