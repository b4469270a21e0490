// The page derives a student's seeds as `ch16-mark` does: both are compared with the same numbers.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { it } from 'node:test';
import * as esbuild from '../../web/node_modules/esbuild/lib/main.js';

const source = readFileSync(new URL('../../web/ts/personal-seeds.ts', import.meta.url), 'utf8');
const { code } = await esbuild.transform(source, { loader: 'ts' });
const { ownTask, seedOf, withValues } = await import(`data:text/javascript;base64,${Buffer.from(code).toString('base64')}`);

it('gives each student and exercise the same seed as the command', () => {
  const seeds = JSON.parse(readFileSync(new URL('../reference/student-seeds.json', import.meta.url), 'utf8'));
  for (const { student, exercise, attempt, seed } of seeds) assert.equal(seedOf(student, exercise, attempt), seed, student);
});

it('deals one of the tasks that an exercise lists, or none', () => {
  const own = ownTask('noise seed: 3.25 12, 3.5 7,4 9', 'Ann', '16.5a');
  // 3281447463 modulo 3 is 0.
  assert.deepEqual([...own], [['noise', '3.25'], ['seed', '12']]);
  assert.equal(withValues('noise=4&t=129', own), 'noise=3.25&t=129&seed=12');
  for (const varies of ['', 'no']) assert.equal(ownTask(varies, 'Ann', '16.5a'), undefined);
});
