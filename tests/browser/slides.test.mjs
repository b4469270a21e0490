// slides.html: the chapter for a class, one slide at a time, with the speaker's notes in a second window.

import assert from 'node:assert/strict';
import { it } from 'node:test';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';

const visit = h.visitor();
const SLIDES = { path: '/slides.html', fresh: true };

/** Turns to a slide by its number, from 1; the page follows its address in a later task. */
const turnToNumber = async (tab, number) => {
  await tab.evaluate((to) => { location.hash = String(to); }, number);
  await tab.waitForFunction((to) => document.querySelectorAll('main > section')[to - 1].classList.contains('shown'), number);
};
/** Turns to the slide of the first element that matches. */
const turnTo = async (tab, css) => turnToNumber(tab, await tab.evaluate((selector) => {
  const slide = document.querySelector(selector).closest('main > section');
  return [...document.querySelectorAll('main > section')].indexOf(slide) + 1;
}, css));
const shownTitle = (tab) => tab.evaluate(() => document.querySelector('main > .shown').querySelector('h1').textContent);

it('slides.html has a slide for each widget in the order of the chapter, with links that set it', async () => {
  await visit('', async (tab) => {
    const names = await tab.evaluate(() => [...document.querySelectorAll('section.figure > slam-widget')].map(({ name }) => name));
    assert.deepEqual([...names].sort(), h.schema.map(({ id }) => id).sort());
    assert.ok(names.indexOf('w16.11') < names.indexOf('w16.1') && names.indexOf('w16.5') < names.indexOf('w16.2'), names.join());
    const first = '.figure slam-widget[name="w16.1"]';
    await turnTo(tab, first);
    await h.ready(tab, first);
    assert.equal(await tab.evaluate((css) => document.querySelector(css).get('heading'), first), 25);
    await tab.locator('section.shown').getByRole('link', { name: '75° off' }).click();
    assert.equal(await tab.evaluate((css) => document.querySelector(css).outcome.verdict, first), 'quarter turn');
    assert.deepEqual(await violations(tab), []);
  }, SLIDES);
});

it('slides and their widgets have the typefaces of the chapter, fetched with the page', async () => {
  const faces = async (path) => {
    let found;
    await visit('', async (tab) => {
      found = await tab.evaluate(() => ({
        fetched: [...document.querySelectorAll('link[rel="preload"][as="font"]')].map(({ href }) => new URL(href).pathname),
        used: ['h1', 'slam-widget'].map((one) => getComputedStyle(document.querySelector(one)).getPropertyValue('--label-font')),
        title: getComputedStyle(document.querySelector('slam-widget').shadowRoot.querySelector('.title')).fontFamily,
      }));
      for (const font of found.fetched) assert.equal((await tab.request.get(new URL(font, tab.url()).href)).status(), 200);
    }, { path });
    return found;
  };
  const chapter = await faces('/index.html');
  assert.ok(chapter.title.includes('Source Serif 4') && chapter.fetched.length === 2, JSON.stringify(chapter));
  assert.deepEqual(await faces('/slides.html'), chapter);
});

it('the arrow keys turn a slide, and a widget that has the focus keeps them', async () => {
  await visit('', async (tab) => {
    const one = (await shownTitle(tab));
    await tab.keyboard.press('ArrowRight');
    assert.notEqual(await shownTitle(tab), one);
    assert.equal(await tab.locator('main > section:visible').count(), 1);
    await tab.keyboard.press('ArrowLeft');
    assert.equal(await shownTitle(tab), one);
    await tab.evaluate(() => { location.hash = 'nowhere'; });
    await tab.waitForFunction(() => location.hash === '#1');
    assert.equal(await shownTitle(tab), one);
    await tab.keyboard.press('End');
    const last = await shownTitle(tab);
    await tab.keyboard.press('PageDown');
    assert.equal(await shownTitle(tab), last);
    await turnTo(tab, '.figure slam-widget[name="w16.1"]');
    await h.ready(tab, '.figure slam-widget[name="w16.1"]');
    await tab.locator('.figure slam-widget[name="w16.1"]').getByRole('slider').first().focus();
    await tab.keyboard.press('ArrowRight');
    assert.equal(await shownTitle(tab), 'How far can you turn a sweep before it settles in a false minimum?');
    await tab.keyboard.press('PageDown');
    assert.notEqual(await shownTitle(tab), 'How far can you turn a sweep before it settles in a false minimum?');
  }, SLIDES);
});

it('the speaker’s notes follow the slides in a second window, and turn them', async () => {
  await visit('', async (tab) => {
    assert.deepEqual(await tab.evaluate(() => [...document.querySelectorAll('main > section')]
      .filter((slide) => !slide.querySelector('template.note')?.content.textContent.trim()).map((slide) => slide.textContent.slice(0, 40))), []);
    await tab.keyboard.press('ArrowRight');
    const opened = tab.waitForEvent('popup');
    await tab.keyboard.press('n');
    const notes = await opened;
    // It opens at the slide that one is on.
    await notes.locator('.speaker .now', { hasText: /^2 of / }).waitFor();
    await tab.keyboard.press('ArrowLeft');
    await turnTo(tab, '.figure slam-widget[name="w16.11"]');
    await tab.keyboard.press('PageDown');
    await tab.keyboard.press('PageUp');
    await notes.locator('.speaker .note li', { hasText: 'A sensor upside down' }).waitFor();
    assert.equal(await notes.locator('slam-widget:visible').count(), 0);
    await notes.keyboard.press('ArrowRight');
    await tab.getByText('Prove that no trace exceeds').waitFor();
    assert.match(await shownTitle(tab), /^Exercise 1/);
    await notes.close();
  }, SLIDES);
});

it('sections show their formulas, and one derivation', async () => {
  await visit('', async (tab) => {
    const formulas = await tab.evaluate(() => Object.fromEntries([...document.querySelectorAll('section.formulas')]
      .map((slide) => [slide.querySelector('h1').textContent, slide.querySelectorAll('.math .katex').length])));
    assert.equal(formulas['Correspondence and alignment'], 2);
    assert.equal(formulas['Gradient and Hessian of the score'], 1);
    assert.ok(Object.values(formulas).every((count) => count > 0), JSON.stringify(formulas));
  }, SLIDES);
});

it('slides.html lets a class predict: the slide of a question has its premise and the widget that answers', async () => {
  await visit('', async (tab) => {
    await turnTo(tab, 'slam-predict[exercise="16.4"]');
    const question = tab.locator('slam-predict[exercise="16.4"]');
    await tab.locator('section.shown').getByText('How large an error does each variant').waitFor();
    await question.getByRole('radio').first().check();
    await question.getByRole('button', { name: 'Commit and see' }).click();
    await question.getByText(/^(As you predicted|It turns out differently)/).waitFor();
    assert.equal(await tab.evaluate(() => document.querySelector('.shown slam-widget').get('tau')), 1.4);
    assert.equal(await tab.locator('slam-predict').count(), 11);
  }, SLIDES);
});

/** What is wrong with the slide on show: what scrolls, what lies outside, and letters below 24 pixels. */
const faults = (tab) => tab.evaluate(() => {
  const found = [];
  const turn = document.querySelector('.turn').getBoundingClientRect();
  const isUnderButtons = (text) => {
    const range = document.createRange();
    range.selectNodeContents(text);
    return [...range.getClientRects()].some(({ right, top, bottom }) => right > turn.left && top < turn.bottom && bottom > turn.top);
  };
  const { scrollWidth, scrollHeight } = document.documentElement;
  if (scrollWidth > innerWidth || scrollHeight > innerHeight) found.push(`the page is ${scrollWidth}×${scrollHeight} px`);
  const read = (root) => {
    for (const element of root.querySelectorAll('*:not(.katex *, .hidden, .hidden *, style, option)')) {
      if (element.shadowRoot) read(element.shadowRoot);
      if (!element.checkVisibility({ visibilityProperty: true })) continue;
      const style = getComputedStyle(element);
      // For screen readers only.
      if (style.clipPath !== 'none' || style.clip !== 'auto') continue;
      const name = `${element.localName}.${element.className} “${element.textContent.trim().slice(0, 40)}”`;
      const over = [element.scrollWidth - element.clientWidth, element.scrollHeight - element.clientHeight];
      const isBox = style.display !== 'inline' && element.clientWidth > 0;
      if (isBox && over.some((px, axis) => px > 1 && style[['overflowX', 'overflowY'][axis]] !== 'visible')) found.push(`${name} hides ${over} px`);
      const texts = [...element.childNodes].filter(({ nodeType, textContent }) => nodeType === Node.TEXT_NODE && textContent.trim() !== '');
      const says = texts.length > 0;
      if (texts.some(isUnderButtons)) found.push(`${name} lies under the buttons`);
      if (!says && !['canvas', 'input', 'select'].includes(element.localName)) continue;
      const { left, top, right, bottom, width } = element.getBoundingClientRect();
      if (width > 0 && (left < -1 || top < -1 || right > innerWidth + 1 || bottom > innerHeight + 1)) {
        found.push(`${name} lies at ${[left, top, right, bottom].map(Math.round)}`);
      }
      if (says && parseFloat(style.fontSize) < 24) found.push(`${name} has letters of ${style.fontSize}`);
    }
  };
  read(document.querySelector('main > .shown'));
  return found;
});

/** The smallest labels of a picture by the width of the screen: those of questions have less room. */
const LEAST_LABEL_PX = { 1280: 14, 1920: 24 };

it('slides.html has each slide on the screen of a projector, nothing cut, in letters of 24 pixels', async () => {
  await visit('', async (tab) => {
    const count = await tab.locator('main > section').count();
    const wrong = [];
    for (let k = 1; k <= count; k++) {
      await turnToNumber(tab, k);
      const title = await shownTitle(tab);
      const css = 'main > .shown slam-widget';
      const hasWidget = (await tab.locator(css).count()) > 0;
      if (hasWidget) await h.ready(tab, css);
      for (const [width, height] of [[1280, 720], [1920, 1080]]) {
        await tab.setViewportSize({ width, height });
        await tab.waitForFunction((wide) => innerWidth === wide, width);
        await h.quiet(tab);
        wrong.push(...(await faults(tab)).map((fault) => `${k} ${title}, ${width}×${height}: ${fault}`));
        if (hasWidget) {
          const label = await tab.evaluate((name) => 14 * document.querySelector(name).shadowRoot.querySelector('[data-type]').dataset.type, css);
          if (label < LEAST_LABEL_PX[width]) wrong.push(`${k} ${title}, ${width}×${height}: labels of ${label} pixels`);
        }
      }
    }
    assert.deepEqual(wrong, []);
    // Letters of half a pixel would make a picture higher.
  }, { ...SLIDES, options: { viewport: { width: 1280, height: 720 }, deviceScaleFactor: 1 } });
});
