// Side effects of eframe on the surrounding page that the element prevents. Each test fails with eframe's defaults
// (measured with 0.37).

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { SMOOTH_MS } from './clock.mjs';
import * as h from './harness.mjs';
import { canvasBox, cloudSpot, draggingSpot, restingSpot, sliderRail } from './spots.mjs';
import { fingers } from './touch.mjs';

const TALL = '<p style="height: 3000px">Much text.</p>';
const ONE = '<slam-widget name="w16.1"></slam-widget>';
/** A widget that computes everything at once; w16.1 fills its map for a while. */
const CALM = '<slam-widget name="w16.2"></slam-widget>';

/** A smooth display: in slow frames a touch would become a long press. */
const TOUCH = { options: { hasTouch: true, stepMs: SMOOTH_MS } };

const on = h.visitor();
const scrolled = (tab) => tab.evaluate(() => window.scrollY);

describe('focus', () => {
  it('stays in place while a widget starts, without a blur event', async () => {
    const head = '<script>window.blurs = 0;</script>';
    const body = `<input id="typing" autofocus onblur="blurs++">${ONE}`;
    await on(body, async (tab) => {
      await tab.focus('#typing');
      await h.ready(tab);
      assert.equal(await tab.evaluate(() => document.activeElement.id), 'typing');
      assert.equal(await tab.evaluate(() => blurs), 0);
    }, { head });
  });

  it('passes through with Tab, in both directions', async () => {
    await on(`<button id="before">a</button>${ONE}<button id="after">b</button>`, async (tab) => {
      await h.ready(tab);
      await tab.focus('#before');
      const stops = await tabUntil(tab, 'Tab', 'after');
      assert.ok(stops > 4, `${stops} stops within the widget`);
      assert.equal(await tabUntil(tab, 'Shift+Tab', 'before'), stops);
    });
  });

  it('leaves the canvas with Tab after a click into it', async () => {
    await on(`${ONE}<button id="after">b</button>`, async (tab) => {
      await h.ready(tab);
      const box = await canvasBox(tab);
      await tab.mouse.click(box.x + box.width / 2, box.y + 5);
      await tabUntil(tab, 'Tab', 'after');
    });
  });

  it('leaves the arrow keys and the space bar to the page after a click', async () => {
    await on(ONE + TALL, async (tab) => {
      await h.ready(tab);
      const box = await canvasBox(tab);
      await tab.mouse.click(box.x + box.width / 2, box.y + 5);
      await tab.keyboard.press('Space');
      await tab.waitForFunction(() => window.scrollY > 50);
    });
  });
});

describe('scrolling', () => {
  it('by wheel over the canvas scrolls the page', async () => {
    await on(ONE + TALL, async (tab) => {
      await h.ready(tab);
      const box = await canvasBox(tab);
      await tab.mouse.move(box.x + box.width / 3, box.y + 200);
      await tab.mouse.wheel(0, 300);
      await tab.waitForFunction(() => window.scrollY > 200);
    });
  });

  it('with Ctrl zooms the map under it, and elsewhere the page', async () => {
    await on(ONE + TALL, async (tab) => {
      await h.ready(tab);
      const at = async (x, y) => {
        await tab.mouse.move(x, y);
        return tab.evaluate(([clientX, clientY]) => {
          const { shadowRoot } = document.querySelector('slam-widget');
          const event = new WheelEvent('wheel', { deltaY: -50, ctrlKey: true, cancelable: true, bubbles: true, clientX, clientY });
          shadowRoot.elementFromPoint(clientX, clientY).dispatchEvent(event);
          return event.defaultPrevented;
        }, [x, y]);
      };
      assert.equal(await at(...await h.pointOf(tab, 'sweeps', 0, 0)), true);
      const box = await canvasBox(tab);
      const { x, y, width, height } = await tab.locator('slam-widget button[data-control="play"]').boundingBox();
      assert.equal(await at(x + width / 2, y + height / 2), false, 'over Play');
      assert.equal(await at(box.x + box.width / 2, box.y + 5), false, 'over the title');
      assert.equal(await scrolled(tab), 0);
    });
  });

  it('by touch over the canvas scrolls the page', async () => {
    await on(ONE + TALL, async (tab) => {
      await h.ready(tab);
      const [x, y] = await restingSpot(tab);
      await swipe(tab, [x, y], [x, y - 250]);
      await tab.waitForFunction(() => window.scrollY > 100);
    }, TOUCH);
  });
});

describe('touch', () => {
  it('that starts on something draggable drags it, and the page does not scroll', async () => {
    await on(ONE + TALL, async (tab) => {
      await h.ready(tab);
      const [x, y] = await draggingSpot(tab);
      const before = await tab.evaluate(() => document.querySelector('slam-widget').query);
      await swipe(tab, [x, y], [x + 60, y - 60]);
      await tab.waitForFunction((old) => document.querySelector('slam-widget').query !== old, before);
      assert.equal(await scrolled(tab), 0);
    }, TOUCH);
  });

  it('up or down scrolls the page, even from a slider or the map', async () => {
    // Keeps the widget in view during the swipe: it draws only there.
    const toItsEnd = '<p style="height: 60vh">Little text.</p>';
    await on(ONE + toItsEnd, async (tab) => {
      await h.ready(tab);
      const before = await tab.evaluate(() => document.querySelector('slam-widget').query);
      const onRail = async () => {
        const { x, y, width } = await sliderRail(tab, 'iteration');
        return [x + width / 2, y];
      };
      for (const spot of [() => draggingSpot(tab), onRail]) {
        await tab.evaluate(() => scrollTo(0, 0));
        const [x, y] = await spot();
        const from = await scrolled(tab);
        await swipe(tab, [x, y], [x + 20, y - 250]);
        await tab.waitForFunction((old) => window.scrollY > old + 100, from);
        await h.moreFrames(tab, 2);
        assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').query), before);
      }
    }, TOUCH);
  });

  it('drags vertically after a long press', async () => {
    await on(ONE + TALL, async (tab) => {
      await h.ready(tab);
      const [x, y] = await draggingSpot(tab);
      const before = await tab.evaluate(() => document.querySelector('slam-widget').query);
      await swipe(tab, [x, y], [x, y - 60], () => tab.evaluate(() => frameClock.pass(300)));
      await tab.waitForFunction((old) => document.querySelector('slam-widget').query !== old, before);
      assert.equal(await scrolled(tab), 0);
    }, TOUCH);
  });

  it('that rests selects no text and opens no menu, on anything that is dragged', async () => {
    await on('', async (tab) => {
      await tab.locator('#lap.live').waitFor();
      const chosen = await tab.evaluate(() => {
        const dragged = ['.lap-picture canvas', '.match-picture svg', '.laps-grid canvas', '.sketch-picture'];
        const canvas = document.createElement('slam-widget').shadowRoot.querySelector('.stage').appendChild(document.createElement('canvas'));
        document.body.append(canvas.getRootNode().host);
        const all = [...dragged.flatMap((css) => [...document.querySelectorAll(css)]), canvas];
        return all.map((element) => [element.className || element.tagName, getComputedStyle(element).userSelect]);
      });
      assert.ok(chosen.length > 4, `${chosen.length} things`);
      assert.deepEqual(chosen.filter(([, select]) => select !== 'none'), []);
    }, { ...TOUCH, path: '/index.html' });
  });

  it('that is cancelled ends its drag', async () => {
    await on(ONE + TALL, async (tab) => {
      await h.ready(tab);
      const { touch } = await fingers(tab);
      const query = () => tab.evaluate(() => document.querySelector('slam-widget').query);
      const rail = await sliderRail(tab, 'iteration');
      const onRail = [rail.x + 0.3 * rail.width, rail.y];
      for (const [x, y] of [await cloudSpot(tab), onRail]) {
        const untouched = await query();
        await touch('touchStart', [[x, y]]);
        // The first move decides between page and widget, the next ones move.
        for (const on of [12, 24, 36]) {
          await touch('touchMove', [[x + on, y]]);
          await h.moreFrames(tab, 1);
        }
        await tab.waitForFunction((old) => document.querySelector('slam-widget').query !== old, untouched);
        const before = await query();
        await touch('touchCancel');
        await h.moreFrames(tab, 3);
        assert.equal(await query(), before);
        await tab.mouse.move(x + 90, y + 40, { steps: 4 });
        await h.moreFrames(tab, 3);
        assert.equal(await query(), before);
      }
    }, TOUCH);
  });
});

describe('contexts', () => {
  it('are released far away: all of twenty widgets on a page run when they are in view', async () => {
    const many = Array.from({ length: 20 }, (_, i) =>
      `<slam-widget name="${h.schema[i % h.schema.length].id}" id="w${i}"></slam-widget><div style="height:700px"></div>`).join('');
    await on(many, async (tab) => {
      for (let i = 0; i < 20; i += 1) {
        await tab.evaluate((n) => document.querySelector(`#w${n}`).scrollIntoView(), i);
        await h.ready(tab, `#w${i}`);
      }
      const running = await tab.evaluate(() =>
        [...document.querySelectorAll('slam-widget')].filter((widget) => widget.state === 'running').length);
      assert.ok(running <= 8, `${running} run at the end`);
      await tab.evaluate(() => document.querySelector('#w0').scrollIntoView());
      await h.ready(tab, '#w0');
    });
  });

  it('that are lost are created again with the same state', async () => {
    await on(ONE, async (tab) => {
      await h.ready(tab);
      await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        widget.heading = 77;
        window.oldCanvas = widget.shadowRoot.querySelector('canvas');
        oldCanvas.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext();
      });
      await tab.waitForFunction(() => {
        const now = document.querySelector('slam-widget').shadowRoot.querySelector('.stage.live canvas');
        return now !== null && now !== oldCanvas;
      });
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').heading), 77);
      assert.ok((await h.painted(tab)).share > 0.03);
      tab.troubles = tab.troubles.filter((text) => !text.includes('CONTEXT_LOST'));
    }, { options: { sees: true } });
  });
});

describe('a panic', () => {
  it('stays in its widget and is reported, and a restart keeps the parameters', async () => {
    const two = '<slam-widget name="w16.1" id="a"></slam-widget><slam-widget name="w16.1" id="b"></slam-widget>';
    await on(two, async (tab) => {
      await h.ready(tab, '#a');
      await tab.evaluate(() => document.querySelector('#b').scrollIntoView());
      await h.ready(tab, '#b');
      await tab.evaluate(() => {
        window.errors = [];
        document.addEventListener('slam-error', (event) => errors.push(event.detail));
        const widget = document.querySelector('#a');
        widget.heading = 61;
        widget.crashForTest();
      });
      const note = tab.locator('#a .failure');
      assert.match(await note.innerText(), /stopped because of an error in its program/);
      assert.match(await note.locator('pre').textContent(), /crashed on purpose/);
      assert.equal((await tab.evaluate(() => errors))[0].kind, 'crash');
      // The other one continues.
      const frames = await tab.evaluate(() => {
        const other = document.querySelector('#b');
        const { frames: before } = other;
        other.heading = 5;
        return before;
      });
      await tab.waitForFunction((old) => document.querySelector('#b').frames > old, frames);
      await tab.evaluate(() => document.querySelector('#a').scrollIntoView());
      await tab.getByRole('button', { name: 'Restart with these settings' }).click();
      await h.ready(tab, '#a');
      assert.equal(await tab.evaluate(() => document.querySelector('#a').heading), 61);
    }, { quiet: false });
  });
});

describe('the appearance', () => {
  it('follows the page from light to dark and back', async () => {
    await on(ONE, async (tab) => {
      await h.ready(tab);
      // Media queries change with the next frame of the page, so the picture is checked repeatedly.
      const turns = (isDark) => tab.waitForFunction(async (wanted) => {
        const picture = await document.querySelector('slam-widget').snapshot();
        const copy = new OffscreenCanvas(1, 1).getContext('2d');
        copy.drawImage(picture, 0, 0);
        const [paper] = copy.getImageData(0, 0, 1, 1).data;
        return wanted ? paper < 100 : paper > 200;
      }, isDark);
      await turns(false);
      for (const [change, isDark] of [
        ['document.documentElement.classList.add("dark")', true],
        ['document.documentElement.classList.remove("dark")', false],
        ['document.documentElement.dataset.theme = "dark"', true],
        ['document.documentElement.dataset.theme = "light"', false],
      ]) {
        await tab.evaluate(change);
        await turns(isDark);
      }
      await tab.evaluate(() => delete document.documentElement.dataset.theme);
      await tab.emulateMedia({ colorScheme: 'dark' });
      await turns(true);
    }, { options: { sees: true } });
  });

  it('is sharp at any pixel ratio', async () => {
    for (const deviceScaleFactor of [1, 1.5, 3]) {
      await on(ONE, async (tab) => {
        await h.ready(tab);
        const ratio = await tab.evaluate(() => {
          const canvas = document.querySelector('slam-widget').shadowRoot.querySelector('canvas');
          return canvas.width / canvas.clientWidth;
        });
        assert.ok(Math.abs(ratio - deviceScaleFactor) < 0.01, `${ratio} for ${deviceScaleFactor}`);
      }, { options: { deviceScaleFactor, viewport: { width: 700, height: 700 } } });
    }
  });

  it('follows a telephone that is turned while a run plays, and a minute in the background skips nothing', async () => {
    await on(CALM, async (tab) => {
      await h.ready(tab);
      const time = () => tab.evaluate(() => document.querySelector('slam-widget').t);
      await tab.evaluate(() => document.querySelector('slam-widget').press('play'));
      for (const [width, height] of [[844, 390], [390, 844]]) {
        const from = await time();
        await tab.setViewportSize({ width, height });
        await tab.waitForFunction(([old, room]) => {
          const widget = document.querySelector('slam-widget');
          const canvas = widget.shadowRoot.querySelector('canvas');
          return widget.t > old && canvas.clientWidth <= room && canvas.clientWidth > room - 30 && Math.abs(canvas.width / canvas.clientWidth - devicePixelRatio) < 0.01;
        }, [from, width]);
        assert.equal(await tab.evaluate(() => document.documentElement.scrollWidth), width);
      }
      // A page in the background gets no frames, and the next one a minute later.
      const from = await time();
      await tab.evaluate(() => frameClock.skip(60_000));
      await tab.waitForFunction((old) => document.querySelector('slam-widget').t > old, from);
      assert.ok((await time()) < from + 30, `${from} to ${await time()}`);
    }, { options: { viewport: { width: 390, height: 844 } } });
  });

  it('follows the width without a resize loop', async () => {
    await on(CALM, async (tab) => {
      await h.ready(tab);
      for (const width of [1400, 500, 390, 900]) {
        await tab.setViewportSize({ width, height: 800 });
        await h.quiet(tab);
        const [canvas, host] = await tab.evaluate(() => {
          const widget = document.querySelector('slam-widget');
          return [widget.shadowRoot.querySelector('canvas').clientWidth, widget.clientWidth];
        });
        assert.ok(host - canvas <= 2 && host - canvas >= 0, `${canvas} in ${host}`);
      }
    });
  });
});

/** Presses a key until the element with that id has the focus; gives up after 120 presses. */
async function tabUntil(tab, key, id) {
  for (let stops = 0; stops < 120; stops += 1) {
    await tab.keyboard.press(key);
    if ((await tab.evaluate(() => document.activeElement.id)) === id) return stops;
  }
  return assert.fail(`${key} never reaches #${id}`);
}

/** A finger that moves at once, or after a rest of `rest` ms. */
async function swipe(tab, from, to, rest) {
  const hold = (holds) => tab.evaluate((held) => frameClock.hold(held), holds);
  const { touch } = await fingers(tab);
  await hold(rest === undefined);
  await touch('touchStart', [from]);
  await rest?.();
  for (let step = 1; step <= 8; step += 1) {
    const share = step / 8;
    await touch('touchMove', [[0, 1].map((axis) => from[axis] + (to[axis] - from[axis]) * share)]);
  }
  await touch('touchEnd');
  await hold(false);
}
