// Each question of the page has an id of its own, by which an answer is collected and marked.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';

import { readExercises } from '../../web/page/exercises.mjs';
import { readPages } from '../../web/page/pages.mjs';

const page = (await readPages(fileURLToPath(new URL('../..', import.meta.url)))).map(({ html }) => html).join('');
const first = /<slam-predict exercise="16\.1"/;

it('gives each question of the page an id', () => {
  const exercises = readExercises(page);
  assert.equal(exercises.length, page.match(/<slam-predict/g).length);
  const { choices, varies, ...rest } = exercises.find(({ exercise }) => exercise === '16.5a');
  assert.deepEqual(rest, {
    exercise: '16.5a', widget: 'w16.2', state: 'noise=4&t=129', fact: 'front_end_error_m', unit: ' m',
  });
  assert.match(varies, /^noise seed: 3\.5 1, /);
  assert.deepEqual(choices[2], { choice: 'twice', from: 1, to: 2 });
});

it('ch16-mark has the questions of the page', () => {
  const marked = JSON.parse(readFileSync(new URL('../../teaching/mark/src/exercises.json', import.meta.url), 'utf8'));
  assert.deepEqual(marked, readExercises(page), 'run cargo xtask build, which writes the file, and commit it');
});

it('rejects a question with a missing, malformed or duplicate id', () => {
  assert.throws(() => readExercises(page.replace(first, '<slam-predict')), /w16\.11.* has no id: add exercise="16\.5a"/);
  assert.throws(() => readExercises(page.replace(first, '<slam-predict exercise="first"')), /exercise="first" is no id/);
  assert.throws(() => readExercises(page.replace(first, '<slam-predict exercise="16.2"')), /two questions have exercise="16\.2"/);
});
