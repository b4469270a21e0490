// What an exercise reports by SCORM 1.2, in the runtime of scorm-again: over several visits.

import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Scorm12API } from 'scorm-again/scorm12';

const { build } = createRequire(new URL('../../web/package.json', import.meta.url))('esbuild');
const entry = fileURLToPath(new URL('../../web/ts/scorm.ts', import.meta.url));
const { outputFiles } = await build({ entryPoints: [entry], bundle: true, format: 'esm', write: false });
const { connect } = await import(`data:text/javascript,${encodeURIComponent(outputFiles[0].text)}`);

const QUESTIONS = ['16.5a', '16.5b', '16.5c'];

/** A visit: the answers, each a question and whether it came true; what the system stores goes in and out. */
function visit(answers, { stored = {}, counts, lasts_s = 75 } = {}) {
  const api = new Scorm12API({ autocommit: false, logLevel: 5 });
  api.loadFromJSON({ ...stored, core: { ...stored.core, student_id: 's-17' } }, '');
  const top = { API: api };
  top.parent = top;
  let now = 0;
  const session = connect(top, QUESTIONS, counts, () => now);
  assert.equal(session.student, 's-17');
  for (const [exercise, correct] of answers) {
    const time = new Date().toISOString();
    session.answered({ exercise, correct, time, prediction: 'one', right: 'two' }, ['one', 'two']);
  }
  now = 1000 * lasts_s;
  let data;
  api.on('LMSFinish', () => { data = api.renderCMIToJSONObject().cmi; });
  session.end();
  assert.equal(api.lmsGetLastError(), '0', 'every value was accepted');
  data ??= api.renderCMIToJSONObject().cmi;
  return { core: data.core, suspend_data: data.suspend_data, interactions: data.interactions };
}

const scored = ({ core: { score, lesson_status } }) => [score.raw, lesson_status];

it('a student who leaves and comes back keeps what was right', () => {
  const first = visit([['16.5a', true], ['16.5b', true]]);
  assert.deepEqual(scored(first), ['67', 'incomplete']);
  assert.deepEqual(scored(visit([], { stored: first })), ['67', 'incomplete']);
  const second = visit([['16.5c', false]], { stored: first });
  assert.deepEqual(scored(second), ['67', 'completed']);
  // The first visit showed what happens: to answer again is no prediction.
  assert.deepEqual(scored(visit([['16.5c', true]], { stored: second })), ['67', 'completed']);
});

it('a student who comes back sees which questions are answered', () => {
  const { suspend_data } = visit([['16.5a', true], ['16.5b', false]]);
  const api = new Scorm12API({ autocommit: false, logLevel: 5 });
  api.loadFromJSON({ suspend_data, core: { student_id: 's-17' } }, '');
  const top = { API: api };
  top.parent = top;
  assert.deepEqual([...connect(top, QUESTIONS).results], [['16.5a', true], ['16.5b', false]]);
});

it('the first answer counts, or the best or the last by a setting', () => {
  const all = QUESTIONS.map((question) => [question, true]);
  for (const [counts, after] of [['best', '100'], ['first', '100'], ['last', '67']]) {
    const done = visit(all, { counts });
    assert.deepEqual(scored(visit([['16.5a', false]], { stored: done, counts })), [after, 'completed'], counts);
  }
  const wrong = visit([['16.5a', false], ['16.5a', true]], { counts: 'first' });
  assert.equal(wrong.core.score.raw, '0');
});

it('each visit reports its time and leaves the attempt open', () => {
  const { core } = visit([['16.5a', true]], { lasts_s: 3675 });
  assert.deepEqual([core.session_time, core.exit], ['01:01:15', 'suspend']);
});

it('what another version stored does no harm', () => {
  for (const suspend_data of ['{', 'null', '{"16.9":true,"16.5a":"yes"}', '[1]']) {
    assert.deepEqual(scored(visit([['16.5a', true]], { stored: { suspend_data } })), ['33', 'incomplete'], suspend_data);
  }
});
