// The element on a page: it paints, takes values from all sources, and reports changes.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import * as h from './harness.mjs';

const names = h.schema.map((widget) => widget.id);
const on = h.visitor();

for (const name of names) {
  describe(name, () => {
    const page = on.once(`<slam-widget name="${name}" theme="light"></slam-widget>`, { options: { sees: true } });

    it('paints something other than background, in light and dark', async () => {
      const { tab } = page;
      await h.ready(tab);
      const papers = [];
      for (const theme of ['light', 'dark']) {
        await tab.evaluate((wanted) => document.querySelector('slam-widget').setAttribute('theme', wanted), theme);
        const { share, colors, paper } = await h.painted(tab);
        // Without its data a picture is a frame with thin lines; four consist of a few lines and points without a frame.
        assert.ok(share > (['w16.5', 'w16.9', 'w16.11', 'w16.12'].includes(name) ? 0.01 : 0.03), `${theme}: ${share} of the pixels differ`);
        assert.ok(colors > 20, `${theme}: ${colors} colours`);
        papers.push(paper);
      }
      assert.ok(papers[0].every((light, channel) => light > 200 && papers[1][channel] < 100), `${papers}`);
    });

    it('fits into 390 pixels without scrolling sideways', async () => {
      const { tab } = page;
      await tab.setViewportSize({ width: 390, height: 800 });
      await h.quiet(tab);
      const [wide, inside, high] = await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        const { clientWidth } = widget.shadowRoot.querySelector('canvas');
        return [document.documentElement.scrollWidth, clientWidth, widget.offsetHeight];
      });
      assert.ok(wide <= 390 && inside > 350, `${wide} pixels wide, the canvas ${inside}`);
      assert.ok(high > 400, `${high} pixels high`);
    });
  });
}

describe('values', () => {
  it('can be set and read by attribute, property, value and link', async () => {
    await on('<slam-widget name="w16.1" heading="60"></slam-widget>', async (tab) => {
      const read = () => tab.evaluate(() => document.querySelector('slam-widget').value);
      assert.equal((await read()).heading, 60);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = -30.5));
      assert.equal((await read()).heading, -30.5);
      await tab.evaluate(() => document.querySelector('slam-widget').setAttribute('heading', '45'));
      assert.equal((await read()).heading, 45);
      await tab.evaluate(() => (document.querySelector('slam-widget').value = '{"heading": 12}'));
      assert.equal((await read()).heading, 12);
      assert.equal(
        await tab.evaluate(() => document.querySelector('slam-widget').query),
        '?w=16.1&heading=12',
      );
      await tab.evaluate(() => document.querySelector('slam-widget').removeAttribute('heading'));
      const spec = h.schema[0].params.find((param) => param.id === 'heading');
      assert.equal((await read()).heading, spec.default);
    });
  });

  it('reach the running widget, and its outcome reflects them', async () => {
    await on('<slam-widget name="w16.1" heading="60"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const before = await tab.evaluate(() => document.querySelector('slam-widget').outcome);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = 0));
      const after = await tab.evaluate(() => document.querySelector('slam-widget').outcome);
      assert.notDeepEqual(after.facts, before.facts);
      assert.ok(after.sentence.length > 10);
    });
  });

  it('that are invalid are reported as text, and the default is used', async () => {
    const evil = '&lt;img src=x onerror=&quot;document.title=1&quot;&gt;';
    await on(`<slam-widget name="w16.1" heading="${evil}"></slam-widget>`, async (tab) => {
      const note = await tab.evaluate(() => {
        const { shadowRoot, heading } = document.querySelector('slam-widget');
        const element = shadowRoot.querySelector('.note');
        return { text: element.textContent, images: element.querySelectorAll('img').length, heading };
      });
      assert.match(note.text, /^heading takes a number, not <img/m);
      assert.equal(note.images, 0);
      assert.equal(note.heading, h.schema[0].params.find((param) => param.id === 'heading').default);
      assert.equal(await tab.title(), 'Test');
    });
  });

  it('of a linked widget are read from the address and written to it', async () => {
    await on('<slam-widget name="w16.1" linked></slam-widget>', async (tab) => {
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').heading), 70);
      const note = await tab.evaluate(
        () => document.querySelector('slam-widget').shadowRoot.querySelector('.note').textContent,
      );
      assert.match(note, /has no parameter bogus;/);
      await h.ready(tab);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = 20));
      await tab.waitForURL(/heading=20/);
    }, { path: '/t.html?w=16.1&heading=70&bogus=1' });
  });

  it('of an address without a known widget are reported once', async () => {
    const two = '<slam-widget name="w16.1" linked></slam-widget><slam-widget name="w16.2" linked></slam-widget>';
    await on(two, async (tab) => {
      const notes = await tab.evaluate(() => [...document.querySelectorAll('slam-widget')].map(
        (widget) => widget.shadowRoot.querySelector('.note').textContent));
      assert.deepEqual(notes, ['There is no widget 99.', '']);
    }, { path: '/t.html?w=99' });
  });

  it('that were set before the element was defined or connected are used', async () => {
    const body = `<slam-widget name="w16.1" id="early"></slam-widget>
      <script>document.querySelector('#early').heading = 61;</script>`;
    await on(body, async (tab) => {
      assert.equal(await tab.evaluate(() => document.querySelector('#early').value.heading), 61);
      const [before, after] = await tab.evaluate(() => {
        const made = document.createElement('slam-widget');
        made.name = 'w16.1';
        made.heading = 62;
        const unconnected = made.heading;
        document.body.append(made);
        return [unconnected, made.heading];
      });
      assert.deepEqual([before, after], [62, 62]);
    });
  });

  it('are kept when the element moves within its page', async () => {
    await on('<div id="a"><slam-widget name="w16.1"></slam-widget></div><div id="b"></div>', async (tab) => {
      await h.ready(tab);
      await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        widget.heading = 63;
        document.querySelector('#b').append(widget);
      });
      await h.ready(tab);
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').heading), 63);
    });
  });

  it('that are invalid are reported once, and the note disappears when they are valid', async () => {
    await on('<slam-widget name="w16.1" more="on"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const field = tab.getByRole('spinbutton', { name: 'Heading' });
      const note = () => tab.locator('slam-widget .note').innerText();
      for (const typed of ['999', '-999']) {
        await field.focus();
        await tab.keyboard.press('ControlOrMeta+a');
        await tab.keyboard.type(typed);
        await tab.keyboard.press('Enter');
        assert.equal(await note(), `heading takes -180 to 180, not ${typed}. It stays at 25°.`);
        assert.equal(await field.getAttribute('aria-invalid'), 'true');
        assert.equal(await field.inputValue(), typed, 'what was typed is not lost');
      }
      await tab.keyboard.press('ControlOrMeta+a');
      await tab.keyboard.type('12');
      await tab.keyboard.press('Enter');
      assert.equal(await note(), '');
      assert.equal(await field.getAttribute('aria-invalid'), 'false');
    });
  });

  it('that change while the reader types do not overwrite the input before it is set or loses focus', async () => {
    await on('<slam-widget name="w16.1" more="on"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const field = tab.getByRole('spinbutton', { name: 'Heading' });
      const heading = () => tab.evaluate(() => document.querySelector('slam-widget').heading);
      const comesIn = (value) => tab.evaluate((now) => (document.querySelector('slam-widget').heading = now), value);
      await field.focus();
      await tab.keyboard.press('ControlOrMeta+a');
      await tab.keyboard.type('1');
      await comesIn(40);
      await tab.keyboard.type('2');
      assert.equal(await field.inputValue(), '12');
      await tab.keyboard.press('Enter');
      assert.equal(await heading(), 12);
      // The typed text is replaced once the reader has set the value.
      await comesIn(50);
      assert.equal(await field.inputValue(), '50');
      await tab.keyboard.type('3');
      await comesIn(60);
      await field.evaluate((typed) => {
        // Typing the old text again is not a change.
        typed.value = '50';
        typed.blur();
      });
      assert.equal(await field.inputValue(), '60');
    });
  });

  it('beyond the end of a run are clamped to its end', async () => {
    await on('<slam-widget name="w16.2"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const [set, last, shown] = await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        widget.t = widget.timeline.last;
        const range = widget.shadowRoot.querySelector('#control-t');
        return [widget.t, widget.timeline.last, [Number(range.value), Number(range.max)]];
      });
      assert.equal(set, last);
      assert.deepEqual(shown, [last, last]);
    });
  });

  it('of the page itself are kept in its address', async () => {
    await on('<slam-widget name="w16.1" linked></slam-widget>', async (tab) => {
      await h.ready(tab);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = 20));
      await tab.waitForURL(/heading=20/);
      assert.equal(new URL(tab.url()).searchParams.get('id'), '12');
    }, { path: '/t.html?id=12' });
  });

  it('of an unknown widget are answered with the list of widgets', async () => {
    await on('<slam-widget name="w99"></slam-widget>', async (tab) => {
      const note = await tab.evaluate(
        () => document.querySelector('slam-widget').shadowRoot.querySelector('.note').textContent,
      );
      assert.match(note, /There is no widget w99; there are w16.1/);
    });
  });
});

describe('a name that is not a string', () => {
  it('is unknown, and the widget keeps working', async () => {
    await on('<slam-widget name="w16.1"></slam-widget>', async (tab) => {
      await h.ready(tab);
      const said = await tab.evaluate(async () => {
        const widget = document.querySelector('slam-widget');
        const outcomes = [];
        for (const wrong of [5, {}, null, undefined, 'x'.repeat(1e6)]) {
          for (const act of [() => widget.press(wrong), () => widget.set(wrong, 1), () => widget.look(wrong)]) {
            try {
              await act();
              outcomes.push('taken');
            } catch ({ message }) {
              outcomes.push(message);
            }
          }
          outcomes.push(String([widget.get(wrong), widget.panelToScreen(wrong, 0, 0)]));
        }
        return outcomes;
      });
      for (let at = 0; at < said.length; at += 4) {
        assert.match(said[at], /^w16\.1 has no button `.*`; it has /);
        assert.match(said[at + 1], /^w16\.1 has no parameter `.*`; it has heading/);
        assert.match(said[at + 2], /^one looks in, out, .*, not `/);
        assert.equal(said[at + 3], ',');
      }
      assert.ok(said.every((sentence) => sentence.length < 400), 'a long name is cut short');
      await h.moreFrames(tab, 2);
    });
  });
});

describe('events', () => {
  it('report readiness, each change, and the result once it settles', async () => {
    const head = `<script>
      window.heard = [];
      for (const type of ['slam-ready', 'slam-change', 'slam-result', 'slam-error'])
        document.addEventListener(type, (event) => heard.push([type, event.detail]));
    </script>`;
    await on('<slam-widget name="w16.1"></slam-widget>', async (tab) => {
      await h.ready(tab);
      await tab.evaluate(() => (document.querySelector('slam-widget').heading = 33));
      await tab.waitForFunction(() => heard.some(([type]) => type === 'slam-result'));
      const heard = await tab.evaluate(() => heard);
      const [ready] = heard.find(([type]) => type === 'slam-ready');
      assert.equal(ready, 'slam-ready');
      const [, change] = heard.find(
        ([type, detail]) => type === 'slam-change' && detail.parameter === 'heading',
      );
      assert.equal(change.value, 33);
      assert.equal(change.name, 'w16.1');
      const [, result] = heard.find(([type]) => type === 'slam-result');
      assert.equal(result.value.heading, 33);
      assert.ok(result.outcome.sentence.length > 10);
    }, { head });
  });

  it('report the result of the initial values to the page, but not to a screen reader', async () => {
    const head = `<script>
      window.results = [];
      document.addEventListener('slam-result', ({ detail }) => results.push(detail.value.heading));
    </script>`;
    await on('<slam-widget name="w16.1" heading="70"></slam-widget>', async (tab) => {
      await tab.waitForFunction(() => results.includes(70));
      assert.equal(await tab.locator('slam-widget [aria-live="polite"]').textContent(), '');
    }, { head });
  });

  it('report the result of values set out of view once the widget runs again, and no older one', async () => {
    const head = `<script>
      window.results = [];
      document.addEventListener('slam-result', ({ detail }) => results.push(detail));
    </script>`;
    await on('<slam-widget name="w16.1"></slam-widget><div style="height: 30000px"></div>', async (tab) => {
      await h.ready(tab);
      const before = await tab.evaluate(() => document.querySelector('slam-widget').outcome);
      await tab.evaluate(() => scrollTo(0, document.body.scrollHeight));
      await tab.waitForFunction(() => document.querySelector('slam-widget').state === 'resting');
      const resting = await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        const kept = widget.outcome;
        widget.heading = 70;
        frameClock.pass(900);
        return { kept, outcome: widget.outcome ?? 'none yet', results };
      });
      assert.deepEqual(resting, { kept: before, outcome: 'none yet', results: [] });
      await tab.evaluate(() => scrollTo(0, 0));
      await tab.waitForFunction(() => results.length > 0);
      const [told, shown] = await tab.evaluate(() => [results, document.querySelector('slam-widget').outcome]);
      assert.deepEqual(told.map(({ value, outcome }) => [value.heading, outcome]), [[70, shown]]);
      assert.notDeepEqual(shown, before);
    }, { head });
  });
});

describe('exports', () => {
  it('save the view as PNG and every table as CSV', async () => {
    await on('<slam-widget name="w16.1"></slam-widget>', async (tab) => {
      await h.ready(tab);
      await tab.getByText('Share', { exact: true }).click();
      const [picture] = await Promise.all([
        tab.waitForEvent('download'),
        tab.getByRole('button', { name: 'Save picture' }).click(),
      ]);
      assert.equal(picture.suggestedFilename(), 'w16.1.png');
      const bytes = await h.bytesOf(picture);
      assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
      const canvas = await tab.evaluate(() => {
        const { width, height } = document.querySelector('slam-widget').shadowRoot.querySelector('canvas');
        return [width, height];
      });
      assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], canvas);
      const [data] = await Promise.all([
        tab.waitForEvent('download'),
        tab.getByRole('button', { name: 'Save data' }).click(),
      ]);
      assert.match(data.suggestedFilename(), /^w16\.1-.*\.csv$/);
    });
  });

  it('copy a link to the same state', async () => {
    await on('<slam-widget name="w16.1" heading="60"></slam-widget>', async (tab) => {
      await h.ready(tab);
      await tab.getByText('Share', { exact: true }).click();
      await tab.getByRole('button', { name: 'Copy link' }).click();
      await tab.getByText('The link is copied.').waitFor();
      const link = await tab.evaluate(() => navigator.clipboard.readText());
      assert.match(link, /\/embed\.html\?w=16\.1&heading=60$/);
      await tab.goto(link);
      await h.ready(tab);
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').heading), 60);
    }, { options: { permissions: ['clipboard-read', 'clipboard-write'] } });
  });

  it('print the picture of the present state instead of the canvas', async () => {
    await on('<slam-widget name="w16.1" heading="60"></slam-widget>', async (tab) => {
      await h.ready(tab);
      await tab.evaluate(() => window.dispatchEvent(new Event('beforeprint')));
      await tab.emulateMedia({ media: 'print' });
      const shown = await tab.evaluate(() => {
        const { shadowRoot } = document.querySelector('slam-widget');
        const display = (css) => getComputedStyle(shadowRoot.querySelector(css)).display;
        const picture = shadowRoot.querySelector('.picture');
        return { canvas: display('canvas'), picture: display('.picture'),
          source: picture.src.slice(0, 19), isDrawn: picture.complete && picture.naturalWidth > 300 };
      });
      assert.deepEqual(shown, { canvas: 'none', picture: 'block', source: 'data:image/svg+xml;', isDrawn: true });
    });
  });
});
