// The pages of the companion as readers get them.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { OF_COLORS, violations } from './axe.mjs';
import * as h from './harness.mjs';
import { cloudSpot, restingSpot, sliderRail } from './spots.mjs';

/** The chapter's addition to the element's policy: its own fonts. */
const POLICY = `${h.STRICT_POLICY}; font-src 'self'`;
/** Each widget is on exactly one page of the chapter; break.html is a game with one of them. */
const CHAPTER = h.PAGES.filter((page) => page !== 'break.html');
assert.deepEqual(CHAPTER.flatMap(h.widgetsOf).sort(), h.schema.map(({ id }) => id).sort());

const PHONE = { width: 390, height: 844 };

const visit = h.visitor();
const reading = (test, options = {}, how = {}) =>
  visit('', test, { path: '/index.html', server: { policy: POLICY }, options, ...how });

const widget = (id) => `slam-widget[name="${id}"]`;
const onEach = async (test, options = {}, how = {}) => {
  for (const page of h.PAGES) await reading((tab, server) => test(tab, h.widgetsOf(page), server), options, { path: h.addressOf(page), ...how });
};
/** Runs in the page. */
const isSeen = (css) => {
  const { top, bottom } = document.querySelector(css).getBoundingClientRect();
  return bottom > 0 && top < innerHeight;
};
/** Opens an exercise as a reader does. */
const open = (tab, id) => tab.locator(`#${id} > details > summary`).click();
const background = (tab) => tab.evaluate(() => getComputedStyle(document.body).backgroundColor);

/** In the page: what its edge cuts off, and what a box that does not scroll does. */
function cutOff() {
  const found = [];
  const name = (element) => `${element.tagName.toLowerCase()}.${element.className} “${element.textContent.trim().slice(0, 40)}”`;
  const scrolls = (element) => {
    for (let up = element; up !== null && up !== undefined; up = up.parentElement ?? up.getRootNode().host) {
      if (/auto|scroll/.test(getComputedStyle(up).overflowX)) return true;
    }
    return false;
  };
  const isText = ({ childNodes }) => [...childNodes].some(({ nodeType, data }) => nodeType === 3 && data.trim() !== '');
  const walk = (root) => {
    for (const element of root.querySelectorAll('*')) {
      if (element.shadowRoot) walk(element.shadowRoot);
      // Editors number lines that they do not show.
      if (!element.checkVisibility({ visibilityProperty: true }) || !isText(element) || element.closest('svg, .katex-mathml, .hidden, .cm-editor')) continue;
      const { overflowX, overflowY, clipPath } = getComputedStyle(element);
      const { right, width, height } = element.getBoundingClientRect();
      if (clipPath !== 'none' || width <= 2 || height <= 2) continue;
      const isCut = (/hidden|clip/.test(overflowX) && element.scrollWidth > element.clientWidth + 1)
        || (/hidden|clip/.test(overflowY) && element.scrollHeight > element.clientHeight + 1);
      if (isCut) found.push(`cut: ${name(element)}`);
      else if (right + scrollX > document.documentElement.clientWidth + 1 && !scrolls(element)) found.push(`${Math.round(right)} px: ${name(element)}`);
    }
  };
  walk(document);
  const { scrollWidth, clientWidth } = document.documentElement;
  return scrollWidth > clientWidth ? [`${scrollWidth} px wide`, ...found] : found;
}

describe('the chapter', () => {
  it('loses nothing with letters of twice the size, on a phone and on a wide screen', async () => {
    const large = await h.launch(['--blink-settings=defaultFontSize=32']);
    const lost = {};
    try {
      await onEach(async (tab, inOrder) => {
        await tab.evaluate(() => {
          for (const fold of document.querySelectorAll('main details:not([data-write])')) fold.open = true;
        });
        for (const width of [390, 1280]) {
          await tab.setViewportSize({ width, height: 844 });
          await tab.evaluate(() => frameClock.pass(600));
          const found = await tab.evaluate(cutOff);
          if (found.length > 0) lost[`${width} px: ${inOrder}`] = found;
        }
      }, {}, { with: large });
    } finally {
      await large.close();
    }
    assert.deepEqual(lost, {});
  });

  it('starts and paints each of its widgets near the viewport', async () => {
    await onEach(async (tab, inOrder) => {
      const states = () => tab.evaluate(
        (ids) => ids.map((id) => document.querySelector(`slam-widget[name="${id}"]`).state), inOrder);
      for (const [place, id] of inOrder.entries()) {
        // Widgets further down have not started.
        const later = inOrder.length - place - 1;
        assert.deepEqual((await states()).slice(place + 1), Array(later).fill('resting'));
        await h.unfold(tab, widget(id));
        await tab.locator(widget(id)).scrollIntoViewIfNeeded();
        await h.ready(tab, widget(id));
        // Without a log the drop zone stands for the picture; without its data a picture is a frame with thin lines.
        if (id === 'w16.10') assert.ok(await tab.getByRole('button', { name: /Drop a log/ }).isVisible());
        else assert.ok((await h.painted(tab, widget(id))).share > (id === 'w16.9' ? 0.01 : 0.03), id);
      }
    }, { sees: true });
  });

  it('has widgets that can be dragged, scrolled over and passed by Tab', async () => {
    await reading(async (tab) => {
      const css = widget('w16.1');
      await tab.locator(css).scrollIntoViewIfNeeded();
      await h.ready(tab, css);
      await tab.evaluate((name) => document.querySelector(name).scrollIntoView(), css);
      const value = () => tab.evaluate((name) => document.querySelector(name).value, css);
      const before = await value();

      const { x, y, width } = await sliderRail(tab, 'heading', css);
      await tab.mouse.click(x + 0.2 * width, y);
      await tab.waitForFunction(([name, old]) => document.querySelector(name).heading !== old, [css, before.heading]);
      const turned = await value();
      assert.equal(turned.dx, before.dx);
      await tab.locator(`${css} #control-more`).click();

      const [left, top] = await cloudSpot(tab, css);
      await tab.mouse.move(left, top);
      await tab.mouse.down();
      await tab.mouse.move(left + 30, top - 15, { steps: 3 });
      await tab.mouse.up();
      await tab.waitForFunction(([name, old]) => document.querySelector(name).dx !== old, [css, turned.dx]);
      await tab.waitForURL(/dx=/);

      const scrolled = () => tab.evaluate(() => window.scrollY);
      const from = await scrolled();
      const [restX, restY] = await restingSpot(tab, css);
      await tab.mouse.move(restX, restY);
      await tab.mouse.wheel(0, 240);
      await tab.waitForFunction((old) => window.scrollY > old + 200, from);

      await tab.evaluate((name) => document.querySelector(name).shadowRoot.querySelector('.control:not([hidden]) button').focus(), css);
      const isInside = () => tab.evaluate((name) => document.activeElement.matches(name), css);
      let presses = 0;
      while ((await isInside()) && presses < 100) {
        await tab.keyboard.press('Tab');
        presses += 1;
      }
      assert.ok(presses > 3 && presses < 12, `${presses} presses through the widget`);
    }, { viewport: { width: 1000, height: 900 } });
  });

  it('gives a widget the width of the window', async () => {
    await reading(async (tab) => {
      const css = widget('w16.2');
      await tab.locator(css).scrollIntoViewIfNeeded();
      await h.ready(tab, css);
      for (const width of [700, 390, 1100]) {
        await tab.setViewportSize({ width, height: 800 });
        // The narrow text beside it is high enough.
        await tab.locator(css).scrollIntoViewIfNeeded();
        await h.ready(tab, css);
        await tab.waitForFunction((name) => {
          const host = document.querySelector(name);
          const inside = host.shadowRoot.querySelector('canvas').clientWidth;
          return host.clientWidth - inside >= 0 && host.clientWidth - inside <= 2;
        }, css);
      }
    });
  });

  it('has every formula as MathML and as HTML, and none as source', async () => {
    await reading(async (tab) => {
      const counts = await tab.evaluate(() => ({
        sources: document.querySelectorAll('tex').length,
        drawn: document.querySelectorAll('.katex-html').length,
        read: document.querySelectorAll('.katex-mathml math').length,
        failed: document.querySelectorAll('.katex-error').length,
      }));
      assert.deepEqual({ ...counts, drawn: 0, read: 0 }, { sources: 0, drawn: 0, read: 0, failed: 0 });
      assert.ok(counts.drawn > 30);
      assert.equal(counts.read, counts.drawn);
      await tab.evaluate(() => document.fonts.ready);
      assert.ok(await tab.evaluate(() => document.fonts.check('16px KaTeX_Main')));
    });
  });

  it('sets a widget by a link in the text, and scrolls to it', async () => {
    await reading(async (tab) => {
      await tab.locator('a.slam-link[href*="w=16.1"]', { hasText: '75°' }).first().click();
      await tab.waitForFunction((css) => document.querySelector(css).get('heading') === 75, widget('w16.1'));
      await h.ready(tab, widget('w16.1'));
      const verdict = await tab.evaluate((css) => document.querySelector(css).outcome.verdict, widget('w16.1'));
      assert.equal(verdict, 'quarter turn');
    });
  });

  it('shows the answer only after the prediction', async () => {
    await reading(async (tab) => {
      await open(tab, 'further-variants');
      const question = tab.locator('#further-variants slam-predict');
      const why = question.locator('[data-why]');
      await question.scrollIntoViewIfNeeded();
      await tab.waitForFunction(() => customElements.get('slam-predict') !== undefined);
      assert.equal(await why.isVisible(), false);
      await question.getByRole('radio', { name: /^larger/ }).check();
      await question.locator('button').first().click();
      await why.waitFor({ state: 'visible' });
      const said = await question.evaluate((element) => element.shadowRoot.querySelector('.answer').textContent);
      assert.match(said, /^It turns out differently, but a wrong guess is no mistake\. You said: larger: it is the wrong place\. It is 0\.015 m\./);
      assert.ok(await tab.evaluate(isSeen, '#further-variants slam-predict'), 'the page stays at the answer');
      await question.getByRole('button', { name: 'Show it in the widget' }).click();
      await tab.waitForFunction(isSeen, widget('w16.1'));
    });
  });

  it('turns light and dark by its buttons, whatever the system prefers, and its widgets follow', async () => {
    await reading(async (tab) => {
      for (const [choice, system, shade] of [
        ['light', 'dark', 'rgb(253, 252, 249)'],
        ['dark', 'light', 'rgb(15, 19, 23)'],
      ]) {
        await tab.emulateMedia({ colorScheme: system });
        assert.notEqual(await background(tab), shade);
        await tab.click(`[data-theme-choice="${choice}"]`);
        assert.equal(await background(tab), shade);
        await tab.locator(widget('w16.1')).scrollIntoViewIfNeeded();
        await h.ready(tab, widget('w16.1'));
        await tab.waitForFunction(
          ([css, isDark]) => document.querySelector(css).shadowRoot.querySelector('.frame').classList.contains('dark') === isDark,
          [widget('w16.1'), choice === 'dark'],
        );
        // Regression: code had the colours of the system's theme.
        await tab.evaluate(() => {
          for (const fold of document.querySelectorAll('details')) fold.open = true;
        });
        assert.deepEqual(await violations(tab, OF_COLORS), []);
        await tab.click('[data-theme-choice="auto"]');
        assert.notEqual(await background(tab), shade);
      }
    }, { colorScheme: 'dark' });
  });

  it('fits a phone: nothing is wider than the screen, and no widget higher than two', async () => {
    let found = 0;
    await onEach(async (tab, inOrder) => {
      for (const id of inOrder) {
        await h.unfold(tab, widget(id));
        await tab.locator(widget(id)).scrollIntoViewIfNeeded();
        await h.ready(tab, widget(id));
        const height = await tab.evaluate((css) => document.querySelector(css).offsetHeight, widget(id));
        assert.ok(height <= 2 * PHONE.height, `${id} is ${height} px high`);
      }
      const width = await tab.evaluate(() => document.documentElement.scrollWidth);
      assert.equal(width, 390);
      const tables = await tab.evaluate(() => {
        for (const folded of document.querySelectorAll('main details')) folded.open = true;
        return [...document.querySelectorAll('.scroll')].map((box) => box.scrollWidth - box.clientWidth);
      });
      assert.deepEqual(tables, tables.map(() => 0), 'no table has to be scrolled to be read');
      found += tables.length;
      const opened = await tab.evaluate(() => document.documentElement.scrollWidth);
      assert.equal(opened, 390, 'nor with all of it unfolded');
      // WCAG 2.2, 1.4.10: what a zoom to 400 % leaves of a wide screen.
      await tab.setViewportSize({ width: 320, height: PHONE.height });
      await tab.evaluate(() => frameClock.pass(600));
      assert.deepEqual(await tab.evaluate(cutOff), [], 'nor on 320 px');
    }, { viewport: PHONE, deviceScaleFactor: 1 });
    assert.equal(found, 8);
  });

  it('has the contents bar of a phone over text, and no bar over a widget', async () => {
    const css = widget('w16.2');
    await reading(async (tab) => {
      const bar = tab.locator('.contents summary');
      await tab.evaluate(() => [...document.querySelectorAll('main p')].find((text) => text.nextElementSibling?.matches('p')
        && text.closest('details') === null && text.getBoundingClientRect().top > 2 * innerHeight)
        .scrollIntoView({ block: 'end', behavior: 'instant' }));
      await bar.waitFor({ state: 'visible' });
      await tab.evaluate((name) => document.querySelector(name).scrollIntoView({ behavior: 'instant' }), css);
      await bar.waitFor({ state: 'hidden' });
      assert.ok(await tab.evaluate((name) => document.querySelector(name).getBoundingClientRect().bottom > innerHeight, css));
    }, { viewport: { width: 390, height: 600 } });
  });

  for (const id of ['w16.6', 'w16.12']) {
    it(`shows the whole verdict on a phone after Play, though it has grown at the bottom of the screen: ${id}`, async () => {
      const css = widget(id);
      await visit('', async (tab) => {
        await h.withoutLaps(tab);
        await h.ready(tab, css);
        await h.quiet(tab);
        // The page scrolls to the addressed widget until the first input.
        await tab.keyboard.press('Shift');
        const verdict = tab.locator(`${css} .verdict`);
        const before = await verdict.evaluate(({ offsetHeight }) => offsetHeight);
        await verdict.evaluate((line) => scrollBy({ top: line.getBoundingClientRect().bottom - innerHeight, behavior: 'instant' }));
        await tab.locator(`${css} [data-control="play"]`).tap();
        await tab.waitForFunction((name) => document.querySelector(name).shadowRoot.querySelector('[data-control="play"]').textContent !== 'Pause', css);
        await h.quiet(tab);
        const seen = await verdict.evaluate((line) => {
          const { bottom, left } = line.lastElementChild.getBoundingClientRect();
          return { height: line.offsetHeight, bottom, isOnTop: document.elementFromPoint(left + 5, bottom - 5) === line.getRootNode().host };
        });
        assert.ok(seen.height > before && seen.bottom <= 844 && seen.isOnTop, `from ${before} px, ${JSON.stringify(seen)}`);
      }, { path: `${h.pageOf(id)}?w=${id.slice(1)}`, options: { viewport: { width: 390, height: 844 }, hasTouch: true } });
    });
  }

  it('shows at most ten numbers per screen outside of the exercises', async () => {
    await reading(async (tab) => {
      const places = await tab.evaluate(() => {
        const isSeen = (element) => element.checkVisibility() && element.closest('.exercise') === null;
        const marked = [...document.querySelectorAll('main .figure, main a.slam-link')].filter(
          (element) => element.matches('.figure') || /\d/.test(element.textContent));
        // Single digits are names and counts; measured values have more digits.
        const written = [...document.querySelectorAll('main .katex-html .mord')].filter(
          (element) => element.childElementCount === 0 && /^[\d.]{2,}$/.test(element.textContent));
        return [...marked, ...written].filter(isSeen)
          .map((element) => element.getBoundingClientRect().top + scrollY)
          .sort((a, b) => a - b);
      });
      // The chapter prints few numbers, but none found would mean that the selector is wrong.
      assert.ok(places.length > 20, `${places.length} numbers`);
      const crowded = places.filter((top, k) => places[k + 10] < top + 900).map(Math.round);
      assert.deepEqual(crowded, [], 'a screen that begins there has eleven');
    }, { viewport: { width: 1440, height: 900 } });
  });

  it('satisfies axe-core in light and dark, and has few tab stops in its widgets', async () => {
    await onEach(async (tab) => {
      const stops = await tab.evaluate(() => [...document.querySelectorAll('slam-widget')].map(({ name, shadowRoot }) => {
        const can = [...shadowRoot.querySelectorAll('button, input, select, [tabindex="0"]')];
        return [name, can.filter((one) => one.tabIndex >= 0 && one.checkVisibility()).length];
      }));
      const total = stops.reduce((sum, [, count]) => sum + count, 0);
      assert.ok(total <= 120, `${total}: ${stops.join(' ')}`);
      assert.deepEqual(await violations(tab), []);
      await tab.emulateMedia({ colorScheme: 'dark' });
      assert.deepEqual(await violations(tab, OF_COLORS), []);
    }, { colorScheme: 'light' }, { quiet: false });
  });

  it('shows still pictures and the reason without scripts', async () => {
    await onEach(async (tab, inOrder, server) => {
      for (const id of inOrder) {
        await h.unfold(tab, widget(id));
        const picture = tab.locator(`${widget(id)} img`);
        await picture.scrollIntoViewIfNeeded();
        assert.ok(await picture.evaluate((image) => image.decode().then(() => image.naturalWidth > 100)), id);
        assert.ok((await picture.getAttribute('alt')).length > 80, id);
        const words = await tab.locator(widget(id)).innerText();
        assert.match(words, /still picture .* needs JavaScript and WebAssembly/, id);
      }
      const drawn = await (await tab.request.get(`${server.url}/pictures/w16.1-light.svg`)).text();
      assert.doesNotMatch(drawn, /% done/, 'the picture is of a finished map');
      assert.equal(await tab.locator('.theme').isVisible(), false);
    }, { javaScriptEnabled: false });
  });

  it('judges predictions in words, and by the number in question', async () => {
    await reading(async (tab) => {
      await open(tab, 'exercise-5');
      const question = tab.locator('#exercise-5 slam-predict[fact="map_disagreement_m"]');
      await question.scrollIntoViewIfNeeded();
      await tab.waitForFunction(() => customElements.get('slam-predict') !== undefined);
      await question.getByRole('radio', { name: /^less than half/ }).check();
      await question.locator('button').first().click();
      await question.locator('[data-why]').waitFor({ state: 'visible' });
      const answer = (at) => at.evaluate((element) => element.shadowRoot.querySelector('.answer p').textContent);
      assert.match(await answer(question), /^As you predicted\. You said: less than half of it\. It is 0\.090 m\.$/);

      await open(tab, 'exercise-2');
      const rank = tab.locator('#exercise-2 slam-predict');
      await rank.scrollIntoViewIfNeeded();
      await rank.locator('input').fill('3');
      await rank.locator('button').first().click();
      await rank.locator('[data-why]').waitFor({ state: 'visible' });
      assert.match(await answer(rank), /^It turns out differently, but a wrong guess is no mistake\. It is 2\.000\. You said 3 and are off by 1\.0\.$/);
    });
  });

  it('ignores a file dropped outside of a widget, and opens one dropped on it', async () => {
    await reading(async (tab) => {
      const isKept = (css) => tab.evaluate((target) => {
        const files = new DataTransfer();
        files.items.add(new File(['{}'], 'flat.json'));
        const drop = (type) => new DragEvent(type, { dataTransfer: files, bubbles: true, composed: true, cancelable: true });
        const place = document.querySelector(target).shadowRoot?.querySelector('.frame') ?? document.querySelector(target);
        return ['dragover', 'drop'].every((type) => !place.dispatchEvent(drop(type)));
      }, css);
      assert.ok(await isKept('h1'));
      assert.ok(await isKept(widget('w16.10')));
      // Text dragged over the page keeps its default action.
      assert.ok(await tab.evaluate(() => document.body.dispatchEvent(
        new DragEvent('dragover', { dataTransfer: new DataTransfer(), bubbles: true, cancelable: true }))));
    }, {}, { path: '/own-robot.html' });
  });

  it('lists code of the tested files, and copies it', async () => {
    await reading(async (tab) => {
      const listings = await tab.evaluate(() => [...document.querySelectorAll('figure.listing')].map((figure) => ({
        file: figure.querySelector('figcaption code').textContent,
        code: figure.querySelector('pre').textContent,
        words: figure.querySelectorAll('.code-word, .code-type').length,
      })));
      assert.ok(listings.length >= 4);
      for (const { file, code, words } of listings) {
        const source = readFileSync(join(h.DIST, '..', file), 'utf8');
        for (const item of code.split(/\n\n(?=(?:pub )?fn )/)) assert.ok(source.includes(item), `${file}: ${item}`);
        assert.ok(words > 5, file);
      }
      await tab.evaluate(() => {
        window.copied = [];
        navigator.clipboard.writeText = (text) => Promise.resolve(void window.copied.push(text));
      });
      // The code is folded.
      await tab.evaluate(() => { document.querySelector('figure.listing').closest('details').open = true; });
      await tab.locator('figure.listing').first().getByRole('button', { name: 'Copy' }).click();
      assert.deepEqual(await tab.evaluate(() => copied), [listings[0].code]);
    });
  });

  it('lets the reader judge ten loop candidates by keyboard, and draws the effect of a gate', async () => {
    await reading(async (tab) => {
      const place = tab.locator('#decide .decide-place');
      await tab.locator('#decide').scrollIntoViewIfNeeded();
      await place.getByRole('button', { name: 'Accept' }).waitFor();
      await place.getByRole('button', { name: 'Accept' }).focus();
      for (let count = 1; count <= 10; count += 1) {
        assert.equal(await place.locator('.decide-count').textContent(), `Candidate ${count} of 10`);
        assert.match(await place.locator('.sketch-says').textContent(), /^It fits to 0\.\d{3} m over \d+ pairs\./);
        await tab.keyboard.press('Enter');
      }
      assert.match(await place.locator('.sketch-says').textContent(), /^You took 5 of 5 right ones and 5 of 5 false ones\./);
      assert.equal(await place.locator('.decide-each li').count(), 10);
      assert.match(await place.locator('svg').innerHTML(), /false ones accepted/);
      await place.getByRole('button', { name: 'Judge again' }).click();
      assert.equal(await place.locator('.decide-count').textContent(), 'Candidate 1 of 10');
    });
  });

  it('links to the table of the thousand laps', async () => {
    await reading(async (tab, server) => {
      const href = await tab.locator('a[download]').getAttribute('href');
      const table = await (await tab.request.get(`${server.url}/${href}`)).text();
      assert.match(table, /^wheel noise,estimate,result,statistic,value,unit\n0\.25,/);
      assert.ok(table.split('\n').length > 150);
    });
  });

  it('fails to build without the picture of a widget', () => {
    const out = mkdtempSync(join(tmpdir(), 'chapter-'));
    const build = () => {
      const run = spawnSync(process.execPath, ['web/page/build.mjs', out], { cwd: join(h.DIST, '..') });
      assert.equal(run.status, 1);
      return String(run.stderr);
    };
    assert.match(build(), /schema\.json is missing: run node web\/build\.mjs first/);
    writeFileSync(join(out, 'schema.json'), '[]');
    assert.match(build(), /index\.html has a widget w16\.\d+, which does not exist/);
    rmSync(out, { recursive: true });
  });

  it('prints a text instead of a map without a log', async () => {
    await reading(async (tab) => {
      await tab.emulateMedia({ media: 'print' });
      assert.equal(await tab.locator(`${widget('w16.10')} .stage`).isVisible(), false);
      assert.match(await tab.locator(`${widget('w16.10')} .summary`).innerText(), /log/);
    }, {}, { path: h.addressOf('own-robot.html') });
  });

  it('shows the current section, links to the others, and the reading progress', async () => {
    await reading(async (tab) => {
      const list = tab.locator('.contents details');
      await tab.evaluate(() => document.querySelector('#ndt').scrollIntoView({ behavior: 'instant' }));
      await tab.waitForFunction(() => document.querySelector('.contents summary').textContent.startsWith('NDT'));
      await list.locator('summary').click();
      assert.equal(await list.locator('[aria-current]').getAttribute('href'), '#ndt');
      await list.getByRole('link', { name: 'The pose graph', exact: true }).click();
      await tab.waitForURL(/#pose-graph$/);
      assert.equal(await list.evaluate((sheet) => sheet.open), false);
      await tab.evaluate(() => scrollTo({ top: document.documentElement.scrollHeight, behavior: 'instant' }));
      await tab.waitForFunction(() => Number(document.querySelector('.reading').style.getPropertyValue('--read')) > 0.98);
      await tab.getByRole('link', { name: 'Next What robots run' }).click();
      await tab.waitForURL(/robots\.html$/);
    });
  });

  for (const width of [1280, 1440]) {
    it(`keeps the contents list open beside the text, ${width} px wide`, async () => {
      await reading(async (tab) => {
        const contents = tab.locator('.contents');
        const link = contents.getByRole('link', { name: 'The pose graph', exact: true });
        await link.click();
        await tab.waitForURL(/#pose-graph$/);
        await tab.waitForFunction(() => document.querySelector('.contents [aria-current]')?.hash === '#pose-graph');
        assert.ok(await link.isVisible(), 'it stays open once one has chosen');
        const { x, width: wide } = await contents.boundingBox();
        const clear = await tab.evaluate((edge) => [...document.querySelectorAll('main > section > *, main slam-widget, .masthead > *')]
          .every((box) => box.getBoundingClientRect().width === 0 || box.getBoundingClientRect().left >= edge), x + wide);
        assert.ok(clear, 'it covers nothing');
        assert.ok(await tab.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      }, { viewport: { width, height: 900 } });
    });
  }

  it('prints its text and pictures without the buttons', async () => {
    await reading(async (tab) => {
      await tab.emulateMedia({ media: 'print' });
      assert.equal(await tab.locator('.theme').isVisible(), false);
      assert.equal(await tab.locator('.contents').isVisible(), false);
      assert.ok(await tab.locator('h1').isVisible());
      await tab.evaluate(() => dispatchEvent(new Event('beforeprint')));
      await tab.locator(`${widget('w16.1')} .stage`).waitFor();
      // A handout asks: it holds the questions of exercises, and not their answers.
      for (const [css, isShown] of [['.exercise-body > p', true], ['.exercise-body details > p', false], ['slam-predict [data-why]', false]]) {
        for (const part of await tab.locator(css).all()) assert.equal(await part.isVisible(), isShown, css);
      }
      const pdf = await tab.pdf({ format: 'A4', margin: { top: '1cm', bottom: '1cm', left: '1cm', right: '1cm' } });
      assert.ok(pdf.length > 100_000);
      const pages = pdf.toString('latin1').match(/\/Type\s*\/Page\b/g).length;
      // 19 cm by 27.7 cm at 96 px an inch.
      await tab.setViewportSize({ width: 718, height: 1047 });
      const heightPx = await tab.evaluate(() => document.documentElement.scrollHeight);
      const full = heightPx / 1047;
      assert.ok(pages < 1.2 * full + 1, `${pages} pages for what fills ${full.toFixed(1)}`);
    });
  });
});
