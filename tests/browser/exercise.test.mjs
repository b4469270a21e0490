// A single exercise in a frame: its answers go to the surrounding page and to a learning management system.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';

const { unzipSync } = createRequire(new URL('../../web/package.json', import.meta.url))('fflate');
const visit = h.visitor();

/** A page that embeds the frame and records its messages; `head` has the learning management system. */
async function framed(query, test, { head = '', sandbox = '', ...how } = {}) {
  const page = `<!doctype html><html lang="en"><title>Host</title><link rel="icon" href="data:,">
    <script>window.heard = []; addEventListener('message', (event) => heard.push(event.data));${head}</script>
    <iframe title="Exercise" src="/embed.html${query}" style="width: 100%; height: 800px" ${sandbox}></iframe></html>`;
  await visit('', async (tab, server) => {
    const frame = tab.frames().find((candidate) => candidate !== tab.mainFrame());
    await test(tab, frame, server);
  }, { path: '/host.html', fresh: true, ...how, server: { ...how.server, pages: { '/host.html': page } } });
}

/** Commits to a choice by its index, and waits for the verdict. */
async function answer(frame, exercise, place) {
  const question = frame.locator(`slam-predict[exercise="${exercise}"]`);
  await question.locator('input').nth(place).check();
  await question.getByRole('button', { name: 'Commit and see' }).click();
  await question.getByText(/^(As you predicted|It turns out differently)/).waitFor();
}

/** That many answers, once the page has heard them: a frame in a sandbox may have a process of its own. */
const answers = async (tab, count) => {
  const found = await tab.waitForFunction((many) => {
    const all = heard.filter((data) => data?.type === 'answer');
    return all.length >= many && all;
  }, count);
  return found.jsonValue();
};

it('embed.html shows one part in a sandbox under the strict policy, and reports the answer to the surrounding page', async () => {
  await framed('?exercise=16.5a&student=Bob', async (tab, frame) => {
    await frame.locator('slam-predict').first().waitFor();
    assert.equal(await frame.locator('slam-predict').count(), 1);
    assert.equal(await frame.locator('slam-widget').getAttribute('name'), 'w16.2');
    assert.equal(await frame.locator('h1').textContent(), 'Exercise 5: noise, gates, and luck');
    await answer(frame, '16.5a', 0);
    const [told] = await answers(tab, 1);
    assert.deepEqual([told.slam, told.exercise, told.student, told.attempts], [1, '16.5a', 'Bob', 1]);
    assert.match(told.state, /^noise=3\.75&t=129&seed=\d+$/);
    // The file of answers, though this sandbox saves no files.
    await frame.getByText('1 exercise answered. A reload forgets them, unless you keep or save them.').waitFor();
    await frame.getByRole('button', { name: 'Save my answers' }).click();
    const text = await frame.getByLabel('If this frame may not save files, copy this into a file answers-Bob.json:').inputValue();
    const { schema, student, answers: saved } = JSON.parse(text);
    assert.deepEqual([schema, student, saved[0].exercise, saved[0].state], ['slam2d-answers/1', 'Bob', '16.5a', told.state]);
    assert.deepEqual(tab.troubles.splice(0).filter((trouble) => !trouble.includes('Download is disallowed')), []);
  }, { sandbox: 'sandbox="allow-scripts"', server: { policy: `${h.STRICT_POLICY}; frame-src 'self'`.replace("script-src 'self'", "script-src 'self' 'unsafe-inline'") } });
});

it('embed.html shows every part of an exercise, each widget once, and satisfies axe-core', async () => {
  await visit('', async (tab) => {
    await tab.locator('slam-predict').nth(2).waitFor();
    assert.equal(await tab.locator('slam-predict').count(), 3);
    assert.equal(await tab.locator('slam-widget').count(), 1);
    assert.equal(await tab.title(), 'Exercise 5: noise, gates, and luck');
    await h.ready(tab);
    assert.deepEqual(await violations(tab), []);
  }, { path: '/embed.html?exercise=5', fresh: true });
});

it('embed.html says if the exercises arrive in part', async () => {
  await visit('', async (tab) => {
    await tab.getByText('exercises.json arrived incomplete. Reload the page.').waitFor();
  }, {
    path: '/embed.html?exercise=5', fresh: true, quiet: false,
    server: {
      answer: (path, response) => {
        const isCut = path === '/exercises.json';
        if (isCut) response.end('[{"name": "16.5",');
        return isCut;
      },
    },
  });
});

it('embed.html lists the exercises if the address names an unknown one', async () => {
  await visit('', async (tab) => {
    await tab.getByText('There is no exercise `99`; there are 16.1, 16.2, 16.3').waitFor();
    assert.equal(await tab.locator('slam-predict').count(), 0);
  }, { path: '/embed.html?exercise=99', fresh: true });
});

/** The runtime of SCORM 1.2, strict about names, order and values. */
const RUNTIME = `
  const rules = {
    'cmi.core.lesson_status': /^(passed|completed|failed|incomplete|browsed)$/,
    'cmi.core.score.(raw|min|max)': /^\\d{1,3}$/,
    'cmi.core.session_time': /^\\d{4}:[0-5]\\d:[0-5]\\d$/,
    'cmi.core.exit': /^suspend$/,
    'cmi.suspend_data': /^.{1,4096}$/,
    'cmi.interactions.\\\\d+.id': /^[\\w.-]{1,255}$/,
    'cmi.interactions.\\\\d+.type': /^(choice|numeric)$/,
    'cmi.interactions.\\\\d+.time': /^([01]\\d|2[0-3]):[0-5]\\d:[0-5]\\d$/,
    'cmi.interactions.\\\\d+.student_response': /^([a-z]|-?[\\d.]+)$/,
    'cmi.interactions.\\\\d+.correct_responses.0.pattern': /^([a-z]|-?[\\d.]+)$/,
    'cmi.interactions.\\\\d+.result': /^(correct|wrong)$/,
  };
  window.data = { 'cmi.core.student_id': 's-17', 'cmi.core.lesson_status': 'not attempted' };
  window.calls = [];
  let state = 'new';
  const running = () => { if (state !== 'running') throw new Error('not running: ' + state); };
  window.API = {
    LMSInitialize: () => { if (state !== 'new') return 'false'; state = 'running'; return 'true'; },
    LMSGetValue: (name) => {
      running();
      if (name !== 'cmi.interactions._count') return data[name] ?? '';
      return String(new Set(Object.keys(data).map((key) => key.match(/^cmi.interactions.(\\d+)/)?.[1]).filter(Boolean)).size);
    },
    LMSSetValue: (name, value) => {
      running();
      const rule = Object.entries(rules).find(([pattern]) => new RegExp('^' + pattern + '$').test(name));
      if (rule === undefined || !rule[1].test(value)) throw new Error(name + ' = ' + value);
      data[name] = value;
      return 'true';
    },
    LMSCommit: () => { running(); calls.push('commit'); return 'true'; },
    LMSFinish: () => { running(); state = 'finished'; calls.push('finish'); return 'true'; },
    LMSGetLastError: () => '0', LMSGetErrorString: () => '', LMSGetDiagnostic: () => '',
  };`;

it('an exercise reports answers, score and status by SCORM 1.2, and gets the student from it', async () => {
  await framed('?exercise=5', async (tab, frame) => {
    for (const part of ['a', 'b', 'c']) await answer(frame, `16.5${part}`, 0);
    const told = await answers(tab, 3);
    const data = await tab.evaluate(() => window.data);
    for (const [k, { exercise, student, correct, right, state }] of told.entries()) {
      const field = (name) => data[`cmi.interactions.${k}.${name}`];
      assert.deepEqual([student, state.includes('seed=')], ['s-17', true]);
      assert.deepEqual([field('id'), field('type'), field('student_response')], [exercise, 'choice', 'a']);
      assert.equal(field('result'), correct ? 'correct' : 'wrong');
      const choices = await frame.locator(`slam-predict[exercise="${exercise}"] [data-choice]`).evaluateAll((all) => all.map((one) => one.dataset.choice));
      assert.equal(choices['abcd'.indexOf(field('correct_responses.0.pattern'))], right);
    }
    const score = Math.round((100 * told.filter(({ correct }) => correct).length) / 3);
    assert.equal(data['cmi.core.score.raw'], String(score));
    assert.equal(data['cmi.core.lesson_status'], 'completed');
    await tab.evaluate(() => document.querySelector('iframe').remove());
    assert.deepEqual(await tab.evaluate(() => calls), ['commit', 'commit', 'commit', 'commit', 'commit', 'finish']);
  }, { head: RUNTIME });
});

it('the SCORM package has every file that its manifest and exercises need', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'scorm-'));
  try {
    const target = join(folder, 'exercises.zip');
    execFileSync(process.execPath, [fileURLToPath(new URL('../../teaching/scorm/package.mjs', import.meta.url)), h.DIST, target]);
    const inside = unzipSync(readFileSync(target));
    const manifest = new TextDecoder().decode(inside['imsmanifest.xml']);
    const hrefs = [...manifest.matchAll(/href="([^"?]+)(\?exercise=([^"&]+)[^"]*)?"/g)];
    for (const [, file] of hrefs) assert.ok(inside[file], file);
    const named = hrefs.map(([, , , exercise]) => exercise).filter(Boolean);
    assert.deepEqual(named.slice(0, 3), ['16.1', '16.2', '16.3']);
    // Serves only files of the package.
    const answerFromZip = (path, response) => {
      const bytes = inside[path.slice('/course/'.length)];
      if (!path.startsWith('/course/') || bytes === undefined) return false;
      const type = { html: 'text/html; charset=utf-8', js: 'text/javascript', json: 'application/json', wasm: 'application/wasm', svg: 'image/svg+xml' };
      response.setHeader('Content-Type', type[path.split('.').at(-1)] ?? 'text/plain');
      response.end(Buffer.from(bytes));
      return true;
    };
    for (const exercise of ['16.5', '16.flat-ground']) {
      assert.ok(named.includes(exercise));
      await visit('', async (tab) => {
        await h.ready(tab);
        assert.ok(await tab.locator('slam-predict').count() > 0);
      }, { path: `/course/embed.html?exercise=${exercise}`, server: { answer: answerFromZip }, fresh: true });
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
});
