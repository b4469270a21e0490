// The first figure: the reader aligns two sweeps, and ICP refines the pose.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const visit = h.visitor();
const reading = (test, options = {}, how = {}) => visit('', test, { path: '/index.html', options, ...how });
const SIZES = [[1440, 900], [1280, 680], [390, 844]].map(([width, height]) => ({ width, height }));
const live = async (tab) => {
  await tab.waitForSelector('#match.live');
  await tab.evaluate(() => document.querySelector('#match').scrollIntoView({ behavior: 'instant' }));
};
const off = async (tab) => {
  const [cm, degrees] = await Promise.all(['cm', 'degrees'].map((name) => tab.locator(`.match-${name}`).textContent()));
  return { cm: parseFloat(cm), degrees: parseFloat(degrees) };
};
const says = (tab) => tab.locator('#match-says').textContent();
/** Waits until ICP has reported its result. */
const ended = (tab) => tab.waitForFunction(() => /^ICP (found|stopped)/.test(document.querySelector('#match-says').textContent));
const press = (tab, name) => tab.getByRole('button', { name, exact: true }).click();
const middle = (tab, selector) => tab.locator(selector).evaluate((part) => {
  const { left, top, width, height } = part.getBoundingClientRect();
  return { x: left + width / 2, y: top + height / 2 };
});
/** Drags with the mouse from one point to another by a few steps. */
async function drag(tab, from, to) {
  await tab.mouse.move(from.x, from.y);
  await tab.mouse.down();
  await tab.mouse.move(to.x, to.y, { steps: 4 });
  await tab.mouse.up();
}
/** The presses from the initial offset of each room to the truth: right, down, and clockwise by 2° each. */
const PRESSES = { '': [12, 15, 24], corridor: [24, 6, 6], hall: [18, 16, 17], twins: [26, 4, 4] };
/** Moves the source from its start to the truth by keyboard. */
async function layOn(tab, room = '') {
  const [right, down, clockwise] = PRESSES[room];
  await tab.locator('#match svg').focus();
  for (let step = 0; step < clockwise; step += 1) await tab.keyboard.press('Shift+ArrowRight');
  for (let step = 0; step < right; step += 1) await tab.keyboard.press('ArrowRight');
  for (let step = 0; step < down; step += 1) await tab.keyboard.press('ArrowDown');
}

describe('the sweeps that the reader aligns', () => {
  for (const viewport of SIZES) {
    it(`are within two screens, and can be moved before the module has loaded, at ${viewport.width}×${viewport.height}`, async () => {
      let requests = 0;
      let ask, open;
      const asked = new Promise((resolve) => (ask = resolve));
      const opened = new Promise((resolve) => (open = resolve));
      await reading(async (tab) => {
        await tab.route(/\.wasm$/, async (route) => {
          requests += 1;
          ask();
          await opened;
          await route.continue();
        });
        try {
          await tab.reload();
          await tab.waitForSelector('#match.live');
          const bottom = await tab.locator('.match-buttons').evaluate((row) => row.getBoundingClientRect().bottom + scrollY);
          assert.ok(bottom <= 2 * viewport.height, `${bottom} px`);
          await h.quiet(tab);
          assert.equal(requests, 0, 'the first screen needs no module');
          await live(tab);
          const from = await middle(tab, '.match-robot');
          const before = await off(tab);
          await drag(tab, from, { x: from.x + 20, y: from.y + 30 });
          await asked;
          const after = await off(tab);
          assert.ok(after.cm < before.cm - 20, `${before.cm} cm, then ${after.cm}`);
          assert.equal(after.degrees, before.degrees);
          assert.match(await says(tab), new RegExp(`^By hand: ${after.cm} cm and ${after.degrees}° off`));
          assert.ok(await tab.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
        } finally {
          // A request that is held would hold the next tests, too.
          open();
          await tab.unrouteAll({ behavior: 'wait' });
        }
      }, { viewport });
    });
  }

  it('turn about the robot by the knob of the ring', async () => {
    await reading(async (tab) => {
      await live(tab);
      const before = await off(tab);
      const [robot, knob] = [await middle(tab, '.match-robot'), await middle(tab, '.match-knob')];
      // Turns it to heading zero, which overshoots the true heading of 20°.
      await drag(tab, knob, { x: robot.x + Math.hypot(knob.x - robot.x, knob.y - robot.y), y: robot.y });
      const after = await off(tab);
      assert.equal(after.cm, before.cm);
      assert.ok(Math.abs(after.degrees - 20) < 3, `${after.degrees}°`);
    });
  });

  it('can be aligned by keyboard, and ICP converges from there', async () => {
    await reading(async (tab) => {
      await live(tab);
      await layOn(tab);
      assert.deepEqual(await off(tab), { cm: 0, degrees: 0 });
      assert.match(await says(tab), /^By hand: .* That is the right place/);
      for (let step = 0; step < 5; step += 1) await tab.keyboard.press('Shift+ArrowUp');
      for (let step = 0; step < 6; step += 1) await tab.keyboard.press('ArrowLeft');
      assert.deepEqual(await off(tab), { cm: 30, degrees: 10 });
      await press(tab, 'Let ICP take over');
      await ended(tab);
      assert.match(await says(tab), /^ICP found the right place in \d+ steps/);
      const end = await off(tab);
      assert.ok(end.cm < 12 && end.degrees < 3, JSON.stringify(end));
      assert.equal(await tab.locator('.match-left').getAttribute('visibility'), 'visible');
    });
  });

  it('end in a false minimum from their initial pose, and from a quarter turn with a fit that looks right', async () => {
    await reading(async (tab) => {
      await live(tab);
      assert.match(await says(tab), /ICP alone ends in the wrong place/);
      await press(tab, 'Let ICP take over');
      await ended(tab);
      assert.match(await says(tab), /^ICP stopped after \d+ steps in the wrong place/);
      await press(tab, 'From a quarter turn');
      await ended(tab);
      assert.match(await says(tab), /^ICP stopped a quarter turn out, .* Its pairs are 13 cm apart/);
      await press(tab, 'Again');
      assert.deepEqual(await off(tab), { cm: 96, degrees: 48 });
    }, { reducedMotion: 'reduce' });
  });

  it('show the ring of the focus to the keyboard, and not after a drag by mouse', async () => {
    await reading(async (tab) => {
      await live(tab);
      const ring = () => tab.locator('#match svg').evaluate((svg) => [svg === document.activeElement, getComputedStyle(svg).outlineStyle]);
      const from = await middle(tab, '.match-robot');
      await drag(tab, from, { x: from.x + 20, y: from.y + 30 });
      assert.deepEqual(await ring(), [true, 'none']);
      await tab.keyboard.press('ArrowLeft');
      assert.deepEqual(await ring(), [true, 'solid']);
      await drag(tab, from, { x: from.x + 20, y: from.y + 30 });
      assert.deepEqual(await ring(), [true, 'none']);
      await tab.keyboard.press('Tab');
      await tab.keyboard.press('Shift+Tab');
      assert.deepEqual(await ring(), [true, 'solid']);
    });
  });

  it('obey the reader who drags them while ICP runs', async () => {
    await reading(async (tab) => {
      await live(tab);
      await press(tab, 'Let ICP take over');
      await tab.waitForFunction(() => /^step [2-9]$/.test(document.querySelector('.match-step').textContent));
      await tab.locator('#match svg').press('ArrowLeft');
      const taken = await off(tab);
      await h.quiet(tab);
      assert.deepEqual(await off(tab), taken);
      assert.match(await says(tab), /^By hand/);
    }, { stepMs: 60 });
  });

  it('follow one finger, and the page stays where it is', async () => {
    await reading(async (tab) => {
      await live(tab);
      const before = await off(tab);
      const { x, y } = await middle(tab, '.match-robot');
      const place = () => tab.evaluate(() => [scrollY, document.querySelector('.match-picture').getBoundingClientRect().top]);
      const scroll = await place();
      const client = await tab.context().newCDPSession(tab);
      const touch = (type, ...touchPoints) => client.send('Input.dispatchTouchEvent', { type, touchPoints });
      await touch('touchStart', { x, y });
      for (let step = 1; step <= 5; step += 1) await touch('touchMove', { x: x + 8 * step, y: y + 8 * step });
      await touch('touchEnd');
      assert.deepEqual(await place(), scroll);
      assert.ok((await off(tab)).cm < before.cm - 20);
    }, { hasTouch: true, isMobile: true, viewport: SIZES[2] });
  });

  it('follow two fingers', async () => {
    await reading(async (tab) => {
      await live(tab);
      const before = await off(tab);
      const { x, y } = await middle(tab, '.match-robot');
      const client = await tab.context().newCDPSession(tab);
      const touch = (type, ...points) => client.send('Input.dispatchTouchEvent', {
        type, touchPoints: points.map(([dx, dy], id) => ({ x: x + dx, y: y + dy, id })),
      });
      await touch('touchStart', [-20, 0]);
      await touch('touchStart', [-20, 0], [20, 0]);
      await touch('touchMove', [-20, 0], [20, 20]);
      await touch('touchEnd');
      const after = await off(tab);
      // A clockwise turn by atan(1/2) about the resting finger.
      assert.ok(Math.abs(before.degrees - after.degrees - 26.6) < 2, `${before.degrees}°, then ${after.degrees}°`);
    }, { hasTouch: true, viewport: SIZES[2] });
  });

  for (const [what, viewport, options] of [['by keyboard', SIZES[0], {}], ['on a phone', SIZES[2], { hasTouch: true, isMobile: true }]]) {
    it(`lead through four rooms ${what}: each is won, shows its pairs and the record, and opens the next`, async () => {
      await reading(async (tab) => {
        await live(tab);
        const scroll = await tab.evaluate(() => [scrollY, document.documentElement.scrollHeight]);
        for (const room of ['', 'corridor', 'hall', 'twins']) {
          assert.equal(await tab.locator('#match').getAttribute('data-room') ?? '', room);
          assert.equal(await tab.locator('.match-pairs').getAttribute('d'), '');
          await layOn(tab, room);
          await tab.getByRole('button', { name: 'Let ICP take over', exact: true }).press('Enter');
          await ended(tab);
          assert.match(await says(tab), /^ICP found the right place in \d+ steps?: \d cm and .* off, after \d+ s\. Your record: \d cm, \d+ s\.$/, room);
          const lines = (await tab.locator('.match-pairs').getAttribute('d')).split('M').length - 1;
          assert.ok(lines > 60, `${lines} lines in ${room}`);
          // The button that took the place of the other one has its focus.
          const next = tab.getByRole('button', { name: 'Next room', exact: true });
          assert.ok(await next.evaluate((button) => button === document.activeElement));
          assert.deepEqual(await tab.evaluate(() => [scrollY, document.documentElement.scrollHeight]), scroll, room);
          await next.press('Enter');
          await tab.waitForFunction((before) => (document.querySelector('#match').dataset.room ?? '') !== before, room);
        }
        assert.equal(await tab.locator('#match').getAttribute('data-room'), 'room');
      }, { viewport, reducedMotion: 'reduce', ...options });
    });
  }

  it('keep the best win of a room in this browser, and no worse one', async () => {
    await reading(async (tab) => {
      await live(tab);
      const win = async () => {
        await layOn(tab);
        await press(tab, 'Let ICP take over');
        await ended(tab);
        return /after (\d+) s\. Your record: (\d+) cm, (\d+) s/.exec(await says(tab)).slice(1).map(Number);
      };
      const [seconds, cm, best] = await win();
      assert.equal(best, seconds);
      const stored = JSON.parse(await tab.evaluate(() => localStorage.getItem('slam-match-records')));
      assert.deepEqual(stored, { room: { seconds, cm } });
      await tab.evaluate(() => localStorage.setItem('slam-match-records', '{"room":{"seconds":0,"cm":7}}'));
      await press(tab, 'Again');
      assert.deepEqual((await win()).slice(1), [7, 0]);
    }, { reducedMotion: 'reduce' });
  });

  it('send a picture with a link that opens the same room', async () => {
    await visit('', async (tab) => {
      await live(tab);
      await tab.waitForSelector('#match[data-room="corridor"]');
      assert.match(await says(tab), /^The corridor/);
      await layOn(tab, 'corridor');
      await press(tab, 'Let ICP take over');
      await ended(tab);
      await tab.evaluate(() => {
        navigator.canShare = () => true;
        navigator.share = (parcel) => { globalThis.parcel = parcel; return Promise.resolve(); };
      });
      await press(tab, 'Send');
      await tab.waitForFunction(() => globalThis.parcel !== undefined);
      const { link, colors } = await tab.evaluate(async () => {
        const picture = await createImageBitmap(globalThis.parcel.files[0]);
        const canvas = new OffscreenCanvas(picture.width, picture.height);
        canvas.getContext('2d').drawImage(picture, 0, 0);
        const { data } = canvas.getContext('2d').getImageData(0, 0, picture.width, picture.height);
        return { link: globalThis.parcel.url, colors: new Set(new Uint32Array(data.buffer)).size };
      });
      // Points, areas and lines on paper, with the shades of their edges.
      assert.ok(colors > 20, `${colors} colours`);
      await tab.goto(link);
      await tab.waitForSelector('#match[data-room="corridor"]');
    }, { path: '/index.html?room=corridor', options: { reducedMotion: 'reduce' } });
  });

  it('are a still picture without scripts', async () => {
    await reading(async (tab) => {
      assert.ok(await tab.locator('.match-target').isVisible());
      assert.equal(await tab.locator('.match-buttons').isVisible(), false);
    }, { javaScriptEnabled: false });
  });
});
