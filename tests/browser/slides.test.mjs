// slides.html: a slide for each widget, in the first state of its script.

import assert from 'node:assert/strict';
import { it } from 'node:test';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';

const visit = h.visitor();

it('slides.html has a slide for each widget, with links that set it and the speaker’s script', async () => {
  await visit('', async (tab) => {
    const names = await tab.evaluate(() => [...document.querySelectorAll('section > slam-widget')].map(({ name }) => name));
    assert.deepEqual([...names].sort(), h.schema.map(({ id }) => id).sort());
    const first = 'slam-widget[name="w16.1"]';
    await tab.locator(first).scrollIntoViewIfNeeded();
    await h.ready(tab, first);
    assert.equal(await tab.evaluate((css) => document.querySelector(css).get('heading'), first), 25);
    const slide = tab.locator('section').filter({ has: tab.locator(first) });
    await slide.getByRole('link', { name: '75° off' }).click();
    assert.equal(await tab.evaluate((css) => document.querySelector(css).outcome.verdict, first), 'quarter turn');
    await slide.getByText('Script').click();
    await slide.getByText('Cover the verdict and ask what the robot').waitFor();
    assert.deepEqual(await violations(tab), []);
  }, { path: '/slides.html', fresh: true });
});

it('slides.html lets a class predict: the widget on the slide before has the answer', async () => {
  await visit('', async (tab) => {
    const question = tab.locator('slam-predict[exercise="16.4"]');
    await question.scrollIntoViewIfNeeded();
    await question.getByRole('radio').first().check();
    await question.getByRole('button', { name: 'Commit and see' }).click();
    await question.getByText(/^(As you predicted|It turns out differently)/).waitFor();
    assert.equal(await tab.evaluate(() => document.querySelector('slam-widget[name="w16.1"]').get('tau')), 1.4);
    assert.equal(await tab.locator('slam-predict').count(), 11);
  }, { path: '/slides.html', fresh: true });
});

it('slides.html fits each widget on the screen of a projector', async () => {
  await visit('', async (tab) => {
    for (const { id } of h.schema) {
      const css = `slam-widget[name="${id}"]`;
      await tab.locator(css).scrollIntoViewIfNeeded();
      await h.ready(tab, css);
      const box = await tab.locator(css).evaluate((widget) => {
        widget.closest('section').scrollIntoView();
        const { top, bottom } = widget.getBoundingClientRect();
        return { top, bottom, height: innerHeight };
      });
      assert.ok(box.top >= 0 && box.bottom <= box.height, `${id}: ${JSON.stringify(box)}`);
    }
  }, { path: '/slides.html', fresh: true, options: { viewport: { width: 1280, height: 720 } } });
});

it('slides.html turns by arrow keys, and the speaker’s view in a second window follows and leads', async () => {
  await visit('', async (tab, { url }) => {
    const notes = await tab.context().newPage();
    await notes.goto(`${url}/slides.html?notes`);
    const present = () => tab.evaluate(() => [...document.querySelectorAll('main > section')]
      .findIndex((slide) => Math.abs(slide.getBoundingClientRect().top) < 2));
    const titled = (title) => notes.getByRole('heading', { name: title }).waitFor();
    assert.equal(await notes.locator('slam-widget:visible').count(), 0);
    await tab.keyboard.press('ArrowRight');
    assert.equal(await present(), 1);
    await titled('Basin explorer');
    await notes.getByText('Cover the verdict and ask what').waitFor();
    await notes.keyboard.press('ArrowLeft');
    await titled('SLAM in two dimensions');
    await tab.waitForFunction(() => Math.abs(document.querySelector('main > section').getBoundingClientRect().top) < 2);
    await notes.close();
  }, { path: '/slides.html', fresh: true });
});
