// The reader's answers: personal tasks, stored only on request, and saved as a file that `ch16-mark` marks as the page
// does.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { it } from 'node:test';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';
import { native } from '../native.mjs';

const visit = h.visitor();
const reading = (query, test, page = 'index.html') => visit('', test, { path: `/${page}${query}`, fresh: true });

/** Answers every question of the page with its last choice, or with 3; returns the events. */
const answerAll = (tab) => tab.evaluate(async () => {
  const predictions = [];
  for (const question of document.querySelectorAll('slam-predict')) {
    const answered = new Promise((resolve) => question.addEventListener('slam-predict', resolve, { once: true }));
    const form = question.shadowRoot.querySelector('form');
    const fields = [...form.querySelectorAll('input')];
    if (fields[0].type === 'radio') fields.at(-1).checked = true;
    else fields[0].value = '3';
    form.querySelector('button').click();
    predictions.push((await answered).detail);
  }
  return predictions;
});

const isDefined = (tab) => tab.waitForFunction(() => customElements.get('slam-answers') !== undefined);

/** The saved file, and the marks that the command gives it. */
async function marked(tab) {
  const [download] = await Promise.all([
    tab.waitForEvent('download'),
    tab.getByRole('button', { name: 'Save my answers' }).click(),
  ]);
  const text = (await h.bytesOf(download)).toString();
  const folder = mkdtempSync(join(tmpdir(), 'answers-'));
  try {
    const file = join(folder, download.suggestedFilename());
    writeFileSync(file, text);
    return { file: JSON.parse(text), name: download.suggestedFilename(), sheet: JSON.parse(native('ch16-mark', file, '--json')) };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

for (const student of ['', 'Βασίλης “7”']) {
  for (const page of ['index.html', 'robots.html']) it(`the saved file gets the same marks from slam2d as from ${page}: ${student === '' ? 'the chapter’s tasks' : 'tasks of a student'}`, async () => {
    await reading(student === '' ? '' : `?student=${encodeURIComponent(student)}`, async (tab) => {
      await isDefined(tab);
      const predictions = await answerAll(tab);
      const { file, name, sheet } = await marked(tab);
      assert.equal(name, student === '' ? 'answers.json' : 'answers-Βασίλης-7-.json');
      assert.equal(file.student, student);
      assert.deepEqual([sheet.intact, sheet.exercises, sheet.answers.length], [true, 11, predictions.length]);
      for (const [at, { exercise, correct, right, state, time }] of predictions.entries()) {
        const answer = sheet.answers[at];
        assert.deepEqual([answer.exercise, answer.note, answer.mark, answer.right], [exercise, null, correct ? 'right' : 'wrong', right]);
        // The others are the same for everyone.
        assert.equal(state.includes('seed='), student !== '' && exercise.startsWith('16.5'));
        assert.equal(new Date(time).toISOString(), time);
      }
      assert.equal(sheet.right, predictions.filter(({ correct }) => correct).length);
    }, page);
  });
}

it('the page counts attempts, and stores answers in the browser only on request', async () => {
  await reading('?student=Ann#exercise-5', async (tab, server) => {
    await isDefined(tab);
    const question = tab.locator('slam-predict[exercise="16.5a"]');
    const answer = async () => {
      await question.locator('input').first().check();
      await question.getByRole('button', { name: 'Commit and see' }).click();
      await question.getByText(/^(As you predicted|It turns out differently)/).waitFor();
    };
    await question.getByText(/^Your task has noise [\d.]+ and its own seed\. The numbers in the text belong to the chapter’s task, with noise 4\. Go by the ranges\.$/).waitFor();
    await question.getByText('(0.5 to 1 m)').waitFor();
    const same = tab.locator('slam-predict[exercise="16.1"]').getByText('Everyone has this task, because a different seed would barely change the answer.');
    assert.equal(await same.count(), 1);
    await answer();
    await question.getByText(/^This is your personal task, seed \d+\. The numbers in the text belong to the chapter’s task\.$/).waitFor();
    await question.getByRole('button', { name: 'Predict again' }).click();
    await answer();
    assert.equal(await tab.evaluate(() => localStorage.length), 0);
    const box = tab.getByLabel('Keep my answers in this browser');
    await box.check();
    await tab.goto(`${server.url}/index.html`);
    await isDefined(tab);
    assert.equal(await tab.getByLabel(/^Name or token/).inputValue(), 'Ann');
    await tab.getByText('1 exercise answered.').waitFor();
    const { file, sheet } = await marked(tab);
    assert.equal(file.answers[0].attempts, 2);
    assert.equal(sheet.answers[0].mark, 'wrong');
    assert.deepEqual(await violations(tab), []);
    await box.uncheck();
    assert.equal(await tab.evaluate(() => localStorage.length), 0);
    // Another student has answered nothing.
    await tab.getByLabel(/^Name or token/).fill('Bob');
    await tab.getByLabel(/^Name or token/).press('Enter');
    await tab.getByText('0 exercises answered.').waitFor();
    // The chapter's task.
    await tab.getByLabel(/^Name or token/).fill('');
    await tab.getByLabel(/^Name or token/).press('Enter');
    await question.getByText(/^Your task has/).waitFor({ state: 'hidden' });
    assert.ok(await question.getByText('(0.5 to 1 m)').isHidden());
  });
});
