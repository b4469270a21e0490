// Accessibility: every widget by keyboard alone and for screen readers.

import assert from 'node:assert/strict';
import { before, beforeEach, describe, it } from 'node:test';
import { OF_COLORS, violations } from './axe.mjs';
import * as h from './harness.mjs';
import { canvasBox } from './spots.mjs';

const visit = h.visitor();

// Controls and names do not depend on the width, and a small picture takes a third less time.
const body = (name) => `<main style="width:24em"><h1 tabindex="-1">A page</h1><slam-widget name="${name}" more="on"></slam-widget></main>`;

/** Replaces the text of the focused field. */
async function type(tab, text) {
  await tab.keyboard.press('ControlOrMeta+a');
  await tab.keyboard.type(text);
  await tab.keyboard.press('Enter');
}

const value = (tab, id) => tab.evaluate((name) => document.querySelector('slam-widget').get(name), id);
const focused = (tab) =>
  tab.evaluate(() => {
    const active = document.activeElement?.shadowRoot?.activeElement;
    if (!(active instanceof HTMLElement)) return null;
    const box = active.getBoundingClientRect();
    return {
      control: active.dataset.control ?? null,
      tag: active.tagName.toLowerCase(),
      type: active.getAttribute('type'),
      seen: box.width > 8 && box.height > 8 && box.bottom <= innerHeight + 1 && box.top >= -1,
      ring: getComputedStyle(active).outlineStyle,
    };
  });

/** The controls of a widget that are not shown. */
function hiddenControls(tab, widget) {
  const ids = [...widget.presets, ...widget.params, ...widget.buttons].map(({ id }) => id);
  return tab.evaluate((all) => {
    const { shadowRoot } = document.querySelector('slam-widget');
    return all.filter((id) => !shadowRoot.querySelector(`[data-control="${id}"]`).checkVisibility());
  }, ids);
}

for (const widget of h.schema) {
  describe(widget.id, () => {
    const page = visit.once(body(widget.id));
    before(() => h.ready(page.tab));
    beforeEach(() => page.tab.evaluate(async () => {
      await document.querySelector('slam-widget').press('defaults');
      document.querySelector('slam-widget').more = true;
      document.querySelector('h1').focus();
    }));

    it('announces results once they settle, and summarizes the picture', async () => {
      const { tab } = page;
      const live = tab.locator('slam-widget [aria-live="polite"]');
      // Nothing is announced without a change, however late.
      await h.quiet(tab);
      assert.equal(await live.textContent(), '');
      const slider = widget.params.find((param) => param.kind === 'slider');
      await tab.evaluate(([id, to]) => document.querySelector('slam-widget').set(id, to), [slider.id, slider.max]);
      await tab.waitForFunction(() => {
        const widget = document.querySelector('slam-widget');
        const said = widget.shadowRoot.querySelector('[aria-live="polite"]').textContent;
        return said.length > 15 && said === widget.outcome.sentence;
      });
      // A widget with work in progress announces more later.
      await tab.waitForFunction(() => {
        const widget = document.querySelector('slam-widget');
        const written = widget.shadowRoot.querySelector('.summary').textContent;
        return written.length > 40 && written === widget.summary;
      });
    });

    it('makes every control focusable, in reading order and in view', async () => {
      const { tab } = page;
      const hidden = await hiddenControls(tab, widget);
      if (widget.params.some(({ id }) => id === 'edit')) {
        await tab.evaluate(() => document.querySelector('slam-widget').press('edit-flat'));
        assert.deepEqual(await hiddenControls(tab, widget), [], 'in its mode each control is shown');
        await tab.evaluate(() => document.querySelector('slam-widget').press('defaults'));
        await tab.evaluate(() => document.querySelector('h1').focus());
      } else {
        assert.deepEqual(hidden, []);
      }
      const stops = [];
      for (let presses = 0; presses < 150; presses += 1) {
        await tab.keyboard.press('Tab');
        const stop = await focused(tab);
        if (stop === null) break;
        assert.ok(stop.seen, `${JSON.stringify(stop)} is out of sight`);
        assert.notEqual(stop.ring, 'none', `${stop.control} has no ring`);
        stops.push(stop.control);
      }
      const order = [...new Set(stops.filter((control) => control !== null))];
      // As they stand: the buttons and the slider of the run, the opening control, More, and what it opens.
      const isTimeline = (id) => widget.params.some((param) => param.id === id && param.kind === 'timeline');
      const isButton = (id) => widget.buttons.some((button) => button.id === id);
      const isPreset = (id) => widget.presets.some((preset) => preset.id === id);
      const rank = (id) => {
        if (id === 'more') return 4;
        // Under More the timeline ends its place, and Play begins it.
        if (!widget.opening.includes(id)) return isPreset(id) ? 5 : isTimeline(id) ? 7 : id === 'play' ? 8 : isButton(id) ? 9 : 6;
        return id === 'play' ? 0 : isButton(id) ? 1 : isTimeline(id) ? 2 : 3;
      };
      const all = [...widget.presets, ...widget.params, ...widget.buttons].map(({ id }) => id).filter((id) => !hidden.includes(id));
      assert.deepEqual(order, all.sort((a, b) => rank(a) - rank(b)));
    });

    it('has Play, its first controls and More as tab stops while More is closed, and keeps its height', async () => {
      const { tab } = page;
      await tab.evaluate(() => (document.querySelector('slam-widget').more = false));
      await h.quiet(tab);
      const height = () => tab.evaluate(() => document.querySelector('slam-widget').offsetHeight);
      const resting = await height();
      await tab.evaluate(() => document.querySelector('h1').focus());
      const stops = [];
      for (let presses = 0; presses < 20; presses += 1) {
        await tab.keyboard.press('Tab');
        const stop = await focused(tab);
        if (stop === null) break;
        assert.equal(await height(), resting, `${stop.control} makes the widget higher`);
        stops.push(stop.control ?? 'tool');
      }
      const order = [...new Set(stops)];
      assert.equal(order[0], widget.opening.includes('play') ? 'play' : order[0]);
      assert.deepEqual(order.slice(-2), ['more', 'tool']);
      assert.deepEqual([...order].slice(0, -1).sort(), [...widget.opening].sort());
      await tab.evaluate(() => (document.querySelector('slam-widget').more = true));
    });

    it('describes its picture', async () => {
      const { tab } = page;
      await h.quiet(tab);
      const session = await tab.context().newCDPSession(tab);
      const { nodes } = await session.send('Accessibility.getFullAXTree');
      const image = nodes.find(({ role, name }) => role?.value === 'image' && name?.value === widget.title);
      const summary = await tab.evaluate(() => document.querySelector('slam-widget').shadowRoot.querySelector('.summary').textContent);
      assert.equal(image.description?.value, summary.replace(/\s+/g, ' ').trim());
      assert.equal(nodes.filter(({ role, name }) => role?.value === 'StaticText' && name?.value === summary).length, 0);
    });

    it('changes every parameter by keyboard alone, with fine steps under Shift', async () => {
      const { tab } = page;
      for (const param of widget.params) {
        // Extreme values of other parameters may make a run empty.
        await tab.evaluate(() => document.querySelector('slam-widget').press('defaults'));
        const control = tab.locator(`slam-widget #control-${param.id}`);
        // Controls of a mode need it.
        if (await control.evaluate((input) => input.closest('[hidden]') !== null)) {
          await tab.evaluate(() => document.querySelector('slam-widget').press('edit-flat'));
        }
        await control.focus();
        const before = await value(tab, param.id);
        if (param.kind === 'switch') {
          await tab.keyboard.press('Space');
          assert.equal(await value(tab, param.id), !before, param.id);
        } else if (param.kind === 'choice') {
          const now = param.options.findIndex((option) => option.id === before);
          const isLast = now === param.options.length - 1;
          await tab.keyboard.press(isLast ? 'ArrowUp' : 'ArrowDown');
          assert.equal(await value(tab, param.id), param.options[isLast ? now - 1 : now + 1].id);
        } else if (param.kind === 'seed') {
          await type(tab, '11');
          assert.equal(await value(tab, param.id), 11);
        } else if (param.kind === 'text') {
          // A text that the widget encodes: a custom flat.
          const text = await tab.evaluate(async (id) => {
            const other = document.createElement('slam-widget');
            other.name = document.querySelector('slam-widget').name;
            await other.press('add-wall');
            return other.get(id);
          }, param.id);
          await type(tab, text);
          assert.equal(await value(tab, param.id), text);
        } else {
          await tab.keyboard.press('Home');
          assert.equal(await value(tab, param.id), param.min, `${param.id} at its start`);
          // Before a log is open, w16.10 has no keyframe to go to.
          if (await control.evaluate((input) => Number(input.max) === Number(input.min))) continue;
          await tab.keyboard.press('ArrowRight');
          const stepped = await value(tab, param.id);
          assert.ok(Math.abs(stepped - param.min - param.step) < 1e-9, `${param.id}: ${stepped}`);
          if (param.kind === 'slider') {
            await tab.keyboard.press('Shift+ArrowRight');
            const fine = (await value(tab, param.id)) - stepped;
            assert.ok(Math.abs(fine - param.step / 10) < 1e-9, `${param.id}: fine step ${fine}`);
          }
          // The number field is the next stop.
          await tab.keyboard.press('Tab');
          const typed = param.min + 2 * param.step;
          await type(tab, String(Number(typed.toPrecision(10))));
          assert.ok(Math.abs((await value(tab, param.id)) - typed) < 1e-9, `${param.id} typed`);
        }
      }
    });

    it('presses every button and preset by keyboard', async () => {
      const { tab } = page;
      await tab.evaluate(() => {
        const widget = document.querySelector('slam-widget');
        const told = ({ query, timeline }) => ({ query, playing: timeline?.playing ?? false });
        // The expected effect comes from a widget that is not drawn, and so does not play.
        const other = document.createElement('slam-widget');
        other.name = widget.name;
        other.more = widget.more;
        window.expected = async (id, mode) => {
          await other.press('defaults');
          if (mode !== null) await other.press(mode);
          await other.press(id);
          return told(other);
        };
        // Requested before the next frame can advance the playback.
        const { press } = widget;
        widget.press = async (id) => {
          await press.call(widget, id);
          window.after = told(widget);
        };
      });
      for (const button of [...widget.presets, ...widget.buttons]) {
        const control = tab.locator(`slam-widget button[data-control="${button.id}"]`);
        await tab.evaluate(() => document.querySelector('slam-widget').press('defaults'));
        // Controls of a mode need it.
        const mode = (await control.evaluate((element) => element.closest('[hidden]') !== null)) ? 'edit-flat' : null;
        const expected = await tab.evaluate(([id, its]) => window.expected(id, its), [button.id, mode]);
        await tab.evaluate(async (its) => {
          if (its !== null) await document.querySelector('slam-widget').press(its);
          window.after = undefined;
        }, mode);
        await control.focus();
        await tab.keyboard.press('Enter');
        await tab.waitForFunction(() => window.after !== undefined);
        assert.deepEqual(await tab.evaluate(() => after), expected, button.id);
      }
      await tab.evaluate(() => delete document.querySelector('slam-widget').press);
      await tab.locator('slam-widget button[data-control="defaults"]').press('Enter');
      const state = await tab.evaluate(() => document.querySelector('slam-widget').query);
      assert.equal(state, `?w=${widget.id.slice(1)}&more=on`);
    });

    it('hides the keys that it uses from the page, and no others', async () => {
      const { tab } = page;
      await tab.evaluate(() => {
        window.heard = [];
        document.addEventListener('keydown', (event) => heard.push(event.key));
      });
      const slider = widget.params.find((param) => param.kind === 'slider');
      await tab.locator(`slam-widget #control-${slider.id}`).focus();
      await tab.keyboard.press('ArrowRight');
      await tab.keyboard.press('Escape');
      const box = await canvasBox(tab);
      await tab.mouse.click(box.x + box.width / 2, box.y + 5);
      await tab.keyboard.press('ArrowLeft');
      assert.deepEqual(await tab.evaluate(() => heard), ['Escape', 'ArrowLeft']);
    });

    it('has every control in the accessibility tree with role, name, value and unit', async () => {
      const { tab } = page;
      const session = await tab.context().newCDPSession(tab);
      const { nodes } = await session.send('Accessibility.getFullAXTree');
      const named = nodes
        .filter((node) => !node.ignored)
        .map((node) => ({
          role: node.role?.value,
          name: node.name?.value ?? '',
          description: node.description?.value ?? '',
        }));
      const find = (role, name) => named.find((node) => node.role === role && node.name === name);
      const shown = await tab.evaluate(() => [...document.querySelector('slam-widget').shadowRoot
        .querySelectorAll('.control:not([hidden]) [data-control]')].map(({ dataset }) => dataset.control));
      assert.ok(find('button', 'Less'));
      for (const param of widget.params.filter(({ id }) => id !== 'more' && shown.includes(id))) {
        const role = { slider: 'slider', timeline: 'slider', seed: 'spinbutton', choice: 'combobox', switch: 'switch', text: 'textbox' }[param.kind];
        const node = find(role, param.label);
        assert.ok(node, `no ${role} named ${param.label}`);
        assert.equal(node.description, param.help);
        if (param.kind !== 'slider') continue;
        const said = await tab.locator(`slam-widget #control-${param.id}`).getAttribute('aria-valuetext');
        assert.ok(said.endsWith(param.unit) && /\d/.test(said), `${param.label}: ${said}`);
      }
      for (const button of widget.buttons.filter(({ id }) => shown.includes(id))) assert.ok(find('button', button.label), button.label);
      assert.ok(find('image', widget.title), 'the canvas has no name');
    });

    it('satisfies axe-core in light and dark', async () => {
      const { tab } = page;
      for (const [colorScheme, rules] of [['light'], ['dark', OF_COLORS]]) {
        await tab.emulateMedia({ colorScheme });
        await tab.locator('h1').focus();
        assert.deepEqual(await violations(tab, rules), []);
        await tab.locator(`slam-widget #control-${widget.opening.find((id) => widget.params.some((param) => param.id === id))}`).focus();
        assert.deepEqual(await violations(tab, rules), []);
      }
      await tab.emulateMedia({ colorScheme: null });
    });
  });
}
