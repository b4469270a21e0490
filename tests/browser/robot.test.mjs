// w16.10, the reader's own log: opened in all ways, mapped beside the page, corrected, saved, and preserved
// while the picture comes and goes.

import assert from 'node:assert/strict';
import { cpSync, existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { native } from '../native.mjs';
import { skip } from '../skip.mjs';
import { OF_COLORS, violations } from './axe.mjs';
import * as h from './harness.mjs';
import { giveBytes, isMapped, says } from './recordings.mjs';
import { fingers } from './touch.mjs';

const BODY = '<slam-widget name="w16.10" more="on"></slam-widget>';
const SAMPLE = readFileSync(join(h.DIST, 'samples', 'ring.log'), 'utf8');
const OTHER_DAY = readFileSync(join(h.DIST, 'samples', 'ring-another-day.log'), 'utf8');
/** Four poses and a loop: a map without scans. */
const SQUARE = [
  ...[[0, 0, 0], [4, 0, 1.5707963], [4, 4, 3.1415926], [0, 4, -1.5707963]].map((pose, k) => `VERTEX_SE2 ${k} ${pose.join(' ')}`),
  ...[[0, 1], [1, 2], [2, 3], [3, 0]].map((ends) => `EDGE_SE2 ${ends.join(' ')} 4 0 1.5707963 100 0 0 100 0 100`),
].join('\n');
const RECORDINGS = fileURLToPath(new URL('../../crates/robots/robot_io/recordings/', import.meta.url));
const LOGS = fileURLToPath(new URL('../../../shared/data/logs/', import.meta.url));

const FIELD = fileURLToPath(new URL('../../../shared/data/field/', import.meta.url));

const visit = h.visitor();
const page = (test, how) => visit(BODY, async (tab, server) => {
  await h.ready(tab);
  await test(tab, server);
}, how);

const widget = (tab, act, given) => tab.evaluate(
  ([code, value]) => new Function('widget', 'given', `return (${code})(widget, given)`)(document.querySelector('slam-widget'), value),
  [act.toString(), given]);
const outcome = (tab) => tab.evaluate(() => document.querySelector('slam-widget').outcome);
const press = (tab, id) => tab.evaluate((name) => document.querySelector('slam-widget').press(name), id);

/** Passes a file with that text to the widget. */
const give = (tab, name, text) => tab.evaluate(([file, content]) => {
  document.querySelector('slam-widget').openFile(new File([content], file));
}, [name, text]);

/** Drops several files on the picture. */
const drop = (tab, files) => tab.evaluate((given) => {
  const all = new DataTransfer();
  for (const [name, text] of given) {
    all.items.add(new File([Uint8Array.from(atob(text), (digit) => digit.charCodeAt(0))], name));
  }
  // The canvas handles drops as well, and must not get this one.
  const canvas = document.querySelector('slam-widget').shadowRoot.querySelector('canvas');
  const on = canvas ?? document.querySelector('slam-widget').shadowRoot.querySelector('.frame');
  for (const type of ['dragover', 'drop']) {
    on.dispatchEvent(new DragEvent(type, { dataTransfer: all, bubbles: true, cancelable: true }));
  }
}, files.map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]));

/** The doctor's report, once it shows the laser at that pose. */
const diagnosis = async (tab, laser) => {
  await tab.waitForFunction((at) => {
    const found = document.querySelector('slam-widget').diagnosis;
    return found !== null && (at === undefined || found.laser === at);
  }, laser);
  return tab.evaluate(() => document.querySelector('slam-widget').diagnosis);
};

/** The saved file of that name in the list. */
const saved = async (tab, id) => {
  await tab.evaluate((choice) => document.querySelector('slam-widget').set('file', choice), id);
  const download = tab.waitForEvent('download');
  await press(tab, 'save');
  const file = await download;
  return [file.suggestedFilename(), await h.bytesOf(file)];
};

const table = async (tab, id) => {
  const tables = await tab.evaluate(() => document.querySelector('slam-widget').tables());
  const found = tables.find((one) => one.id === id);
  return found?.csv.trim().split('\r\n').map((row) => row.split(','));
};

/** The sample repeated many times, one after the other in time, for a long mapping. */
const longLog = (times) => {
  const lines = SAMPLE.trimEnd().split('\n');
  const last = Number(lines.at(-1).split(' ').at(-1)) + 1;
  const later = (line, by) => {
    const words = line.split(' ');
    for (const at of [words.length - 3, words.length - 1]) words[at] = String(Number(words[at]) + by);
    return words.join(' ');
  };
  return Array.from({ length: times }, (_, round) => lines.map((line) => later(line, round * last)).join('\n')).join('\n');
};

describe('a reader’s log', () => {
  it('stays in the browser, and the sample is mapped, paused and graded', async () => {
    await page(async (tab) => {
      assert.match((await outcome(tab)).sentence, /none of it is sent anywhere/);
      const written = await tab.evaluate(() => document.querySelector('slam-widget').shadowRoot.textContent);
      assert.doesNotMatch(written, /\d of \d/, 'without a log there is no keyframe to count');
      // In one task, or a busy machine would map the sample before the test can pause it.
      await tab.evaluate(async () => {
        const it = document.querySelector('slam-widget');
        await it.press('sample');
        await it.press('play');
      });
      await says(tab, /^held:/);
      await press(tab, 'play');
      await isMapped(tab);
      await says(tab, /from the truth/);
      const { facts } = await outcome(tab);
      assert.ok(facts.scans > 100 && facts.keyframes > 40 && facts.loops > 0, JSON.stringify(facts));
      assert.ok(facts.error_m < 0.1, String(facts.error_m));
      assert.ok((await h.painted(tab)).share > 0.05);
      const tables = await tab.evaluate(() => document.querySelector('slam-widget').tables());
      assert.deepEqual(tables.map(({ id }) => id).slice(-2), ['all-loops', 'keyframes']);
    }, { options: { sees: true }, server: { policy: h.STRICT_POLICY } });
  });

  it('is opened by button, drop and program, and replaced by the next one', async () => {
    await page(async (tab) => {
      const chosen = tab.waitForEvent('filechooser');
      await press(tab, 'open');
      await (await chosen).setFiles({ name: 'first.log', mimeType: 'text/plain', buffer: Buffer.from(SAMPLE) });
      await says(tab, /(mapped|in doubt): first\.log/);
      await tab.evaluate((text) => {
        const files = new DataTransfer();
        files.items.add(new File([text], 'second.log'));
        const frame = document.querySelector('slam-widget').shadowRoot.querySelector('.frame');
        for (const type of ['dragover', 'drop']) {
          frame.dispatchEvent(new DragEvent(type, { dataTransfer: files, bubbles: true, cancelable: true }));
        }
      }, SAMPLE);
      await says(tab, /(mapped|in doubt): second\.log/);
      // A reference does not replace the map, whichever button opened it.
      const picked = tab.waitForEvent('filechooser');
      await press(tab, 'open');
      const chooser = await picked;
      // Of a list of extensions iOS knows few, and greys out logs.
      assert.equal(await chooser.element().getAttribute('accept'), null);
      await chooser.setFiles(join(h.DIST, 'samples', 'ring-truth.tum'));
      await says(tab, /(mapped|in doubt): second\.log.*from the truth/);
      await give(tab, 'third.log', SAMPLE.split('\n').slice(0, 80).join('\n'));
      await says(tab, /(mapped|in doubt): third\.log: .*80 scans/);
    });
  });

  it('is mapped and saved in a sandboxed frame without an origin', async () => {
    const frame = '<iframe title="A robot" src="/embed.html?w=16.10" sandbox="allow-scripts allow-downloads" ' +
      'style="width: 800px; height: 900px"></iframe>';
    await visit(frame, async (tab) => {
      const inside = await (await tab.waitForSelector('iframe')).contentFrame();
      await inside.waitForFunction(() => document.querySelector('slam-widget')?.state === 'running');
      const download = tab.waitForEvent('download');
      await inside.evaluate(async (log) => {
        const widget = document.querySelector('slam-widget');
        widget.openFile(new File([log], 'framed.log'));
        widget.file = 'trajectory';
      }, SAMPLE.split('\n').slice(0, 80).join('\n'));
      await inside.waitForFunction(() => /^(mapped|no map)/.test(document.querySelector('slam-widget').outcome.verdict));
      assert.match((await outcome(inside)).sentence, /^framed\.log: .*80 scans/);
      await press(inside, 'save');
      assert.equal((await h.bytesOf(await download)).toString().trim().split('\n').length, 80);
    });
  });

  it('is zoomed by two fingers wherever they start, without a drag', async () => {
    await page(async (tab) => {
      await give(tab, 'square.g2o', SQUARE);
      await says(tab, /in doubt: square\.g2o: 4 poses/);
      await tab.evaluate(() => { document.querySelector('slam-widget').value = { keyframe: 2 }; });
      await h.moreFrames(tab, 2);
      const { touch, felt } = await fingers(tab);
      const size = async () => {
        const [[left], [right]] = [await h.pointOf(tab, 'map', 0, 0), await h.pointOf(tab, 'map', 1, 0)];
        return right - left;
      };
      const before = await table(tab, 'keyframes');
      // On another keyframe, on the selected and draggable one, and on nothing: a zoomed map can be moved
      // from all of them.
      for (const [x, y] of [[0, 0], [4, 4], [3.5, 3.5]]) {
        if (x !== 3.5) await tab.evaluate(() => document.querySelector('slam-widget').look('whole'));
        await h.moreFrames(tab, 2);
        const small = await size();
        const [left, top] = await h.pointOf(tab, 'map', x, y);
        const spots = (apart) => [[left, top], [left + (left > 200 ? -apart : apart), top]];
        // The first finger does not rest long enough to grab.
        await tab.evaluate(() => frameClock.hold(true));
        await touch('touchStart', spots(40).slice(0, 1));
        await touch('touchStart', spots(40));
        await tab.evaluate(() => frameClock.hold(false));
        await h.moreFrames(tab, 2);
        // Both rest longer than a long press.
        await tab.evaluate(() => frameClock.pass(2000));
        for (const apart of [50, 60]) {
          await touch('touchMove', spots(apart));
          await h.moreFrames(tab, 1);
        }
        await touch('touchEnd');
        await h.moreFrames(tab, 2);
        const large = await size();
        assert.ok(large > 1.2 * small && large < 2 * small, `at ${x}, ${y}: ${small} and ${large} after ${await felt()}`);
      }
      assert.deepEqual(await table(tab, 'keyframes'), before);
      assert.equal(await tab.evaluate(() => document.querySelector('slam-widget').get('keyframe')), 2);
    }, { options: { viewport: { width: 390, height: 844 }, hasTouch: true } });
  });

  it('can be stopped halfway, and keeps its map', async () => {
    await page(async (tab) => {
      const log = longLog(40);
      await give(tab, 'long.log', log);
      await tab.waitForFunction(() => document.querySelector('slam-widget').outcome.facts.scans > 0);
      // A screen reader gets the progress, although the changes never settle.
      await tab.evaluate(() => {
        frameClock.hold(true);
        const now = performance.now;
        performance.now = () => now() + 11_000;
      });
      await tab.waitForFunction(() => {
        const { textContent } = document.querySelector('slam-widget').shadowRoot.querySelector('[aria-live]');
        return /^long\.log: \d+% done/.test(textContent);
      });
      await tab.evaluate(() => frameClock.hold(false));
      await press(tab, 'cancel');
      await says(tab, /Stopped after \d+ scans/);
      await isMapped(tab);
      const { facts } = await outcome(tab);
      assert.ok(facts.scans > 0 && facts.scans < log.split('\n').length, String(facts.scans));
    });
  });

  it('does not change an address that the reader set meanwhile', async () => {
    const two = '<slam-widget name="w16.10" linked></slam-widget><slam-widget name="w16.1" linked hidden></slam-widget>';
    await visit(two, async (tab) => {
      await h.ready(tab);
      await tab.evaluate((text) => {
        frameClock.hold(true);
        document.querySelector('slam-widget').openFile(new File([text], 'some.log'));
        // In the task that opens the log, so all changes by the mapping come later.
        document.querySelector('[name="w16.1"]').set('heading', 77);
      }, SAMPLE.split('\n').slice(0, 80).join('\n'));
      await isMapped(tab);
      await tab.evaluate(() => frameClock.hold(false));
      await tab.evaluate(() => frameClock.pass(1000));
      assert.match(await tab.evaluate(() => location.search), /w=16\.1&.*heading=77/);
    });
  });

  it('shows its loops, removes and restores one, adds one by hand, and follows a dragged keyframe', async () => {
    await page(async (tab) => {
      await press(tab, 'sample');
      await isMapped(tab);
      const before = (await outcome(tab)).facts.loops;
      const loops = async () => (await outcome(tab)).facts.loops;
      await press(tab, 'turn');
      await says(tab, /was removed from the graph/);
      assert.equal(await loops(), before - 1);
      await press(tab, 'turn');
      await says(tab, /was added to the graph/);
      assert.equal(await loops(), before);
      await tab.evaluate(() => {
        document.querySelector('slam-widget').value = { keyframe: 0 };
      });
      await press(tab, 'mark');
      await tab.evaluate(() => document.querySelector('slam-widget').set('keyframe', 1));
      await press(tab, 'add');
      await says(tab, /does not close a loop|closes a loop/);

      // A keyframe far from others: halfway along the path.
      const middle = Math.round((await outcome(tab)).facts.keyframes / 4);
      await tab.evaluate((at) => document.querySelector('slam-widget').set('keyframe', at), middle);
      const row = async () => {
        const tables = await tab.evaluate(() => document.querySelector('slam-widget').tables());
        const [, ...rows] = tables.find(({ id }) => id === 'keyframes').csv.trim().split('\r\n');
        return rows[middle].split(',').slice(2, 4).map(Number);
      };
      const [x, y] = await row();
      await h.moreFrames(tab, 2);
      const [left, top] = await h.pointOf(tab, 'map', x, y);
      await tab.mouse.move(left, top);
      await tab.mouse.down();
      await tab.mouse.move(left + 20, top, { steps: 3 });
      await tab.mouse.up();
      await tab.waitForFunction(([before, at]) => {
        const widget = document.querySelector('slam-widget');
        return widget.outcome.facts.path_length_m !== before && widget.get('keyframe') === at;
      }, [(await outcome(tab)).facts.path_length_m - 1e9, middle]);
      await tab.waitForFunction(async ([old, at]) => {
        const tables = await document.querySelector('slam-widget').tables();
        const rows = tables.find(({ id }) => id === 'keyframes').csv.split('\r\n');
        return Math.abs(Number(rows[at + 1].split(',')[2]) - old) > 0.05;
      }, [x, middle]);
      await press(tab, 'unpin');
      await says(tab, /No keyframe is fixed any more/);
      await isMapped(tab);
      const [back] = await row();
      assert.ok(Math.abs(back - x) < 0.02, `${back} and ${x}`);
    }, { viewport: { width: 1000, height: 1200 } });
  });

  it('is saved as map, trajectory, graph and report', async () => {
    await page(async (tab) => {
      await press(tab, 'sample');
      await isMapped(tab);
      const { facts } = await outcome(tab);
      const [pgmName, pgm] = await saved(tab, 'map-pgm');
      assert.equal(pgmName, 'map.pgm');
      const [, width, height] = /^P5\n(\d+) (\d+)\n255\n/.exec(pgm.toString('latin1'));
      assert.equal(pgm.length, `P5\n${width} ${height}\n255\n`.length + width * height);
      const [, yaml] = await saved(tab, 'map-yaml');
      assert.match(yaml.toString(), /^image: map\.pgm\nmode: trinary\nresolution: 0\.05\n/);
      const [, png] = await saved(tab, 'map-png');
      assert.equal(png.subarray(1, 4).toString(), 'PNG');
      assert.equal(png.readUInt32BE(16), Number(width));
      const [, tum] = await saved(tab, 'trajectory');
      const lines = tum.toString().trim().split('\n');
      assert.equal(lines.length, facts.scans);
      assert.ok(lines.every((line) => line.split(' ').length === 8));
      const [, graph] = await saved(tab, 'graph');
      assert.equal(graph.toString().match(/^VERTEX_SE2/gm).length, facts.keyframes);
      assert.equal(graph.toString().match(/^EDGE_SE2/gm).length, facts.keyframes - 1 + facts.loops);
      const [reportName, report] = await saved(tab, 'report');
      assert.equal(reportName, 'report.html');
      assert.match(report.toString(), /ring\.log[\s\S]*<svg/);

      // A saved graph can be opened again, without scans.
      await give(tab, 'saved.g2o', graph.toString());
      await says(tab, /saved\.g2o: \d+ poses/);
      assert.equal((await outcome(tab)).facts.loops, facts.loops);
      await press(tab, 'turn');
      await says(tab, /was removed from the graph/);
    });
  });

  it('is saved as the same session as by the command, opened again, and saved with changes', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'slam-session-'));
    try {
      native('slam2d', 'run', join(h.DIST, 'samples', 'ring.log'), '-o', folder);
      const left = readFileSync(join(folder, 'session.slam2d'));
      await page(async (tab) => {
        await press(tab, 'sample');
        await isMapped(tab);
        const [name, session] = await saved(tab, 'session');
        assert.equal(name, 'session.slam2d');
        assert.ok(session.equals(left), 'the same bytes in the page as natively');
        const before = (await outcome(tab)).facts;

        await press(tab, 'defaults');
        await says(tab, /no log yet/);
        const chosen = tab.waitForEvent('filechooser');
        await tab.getByRole('button', { name: 'Open a log…' }).press('Enter');
        await (await chosen).setFiles(join(folder, 'session.slam2d'));
        await says(tab, /(mapped|in doubt): session\.slam2d/);
        const after = (await outcome(tab)).facts;
        for (const id of ['scans', 'keyframes', 'loops', 'path_length_m']) assert.equal(after[id], before[id], id);
        await press(tab, 'turn');
        await says(tab, /was removed from the graph/);
        const [, changed] = await saved(tab, 'session');
        assert.ok(!changed.equals(session));
        await giveBytes(tab, 'changed.slam2d', changed);
        await says(tab, /(mapped|in doubt): changed\.slam2d/);
        assert.equal((await outcome(tab)).facts.loops, before.loops - 1);

        // Also if its name has no extension; a damaged one is reported.
        await giveBytes(tab, 'monday', session);
        await says(tab, /(mapped|in doubt): monday:/);
        const spoilt = Buffer.from(session);
        spoilt[session.length >> 1] ^= 1;
        const newer = Buffer.from(session);
        newer[8] = 9;
        for (const [bytes, said] of [
          [session.subarray(0, session.length / 2), /no map: bad\.slam2d ends at byte \d+ of \d+/],
          [spoilt, /no map: bad\.slam2d is damaged/],
          [newer, /no map: bad\.slam2d is a session of version 9, but this program reads version 5/],
          [Buffer.from('hello'), /no map: bad\.slam2d is not a session/],
          [Buffer.alloc(0), /no map: bad\.slam2d is empty/],
        ]) {
          await giveBytes(tab, 'bad.slam2d', bytes);
          await says(tab, said);
        }
      });
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('localizes the robot of another day, describes and saves its track, and keeps it after a crash', async () => {
    await page(async (tab) => {
      await giveBytes(tab, 'early.log', Buffer.from(OTHER_DAY), 'where');
      await says(tab, /early\.log needs a map/);
      // The preset maps the sample and localizes the other day's robot on it.
      await press(tab, 'where');
      await says(tab, /^(mapped|[^:]*in doubt): .*The robot of ring-another-day\.log is found at scan \d+: of \d+ scans/);
      const { facts } = await outcome(tab);
      const scans = OTHER_DAY.trim().split('\n').length;
      assert.equal(facts.where_localized + facts.where_doubtful + facts.where_lost, scans);
      assert.ok(facts.where_localized > scans / 2, JSON.stringify(facts));
      const rows = await table(tab, 'where');
      assert.equal(rows.length, scans + 1);
      assert.equal(rows.filter((row) => row[2] === 'found' || row[2] === 'followed').length, facts.where_localized);

      // Every scan can be asked for, and the next change of the verdict.
      const first = rows.slice(1).find((row) => row[2] === 'found');
      await tab.evaluate((scan) => document.querySelector('slam-widget').set('scan', scan), Number(first[0]));
      const { sentence } = await outcome(tab);
      assert.match(sentence, new RegExp(`At scan ${first[0]} it is found at x `));
      await press(tab, 'change');
      assert.notEqual(await tab.evaluate(() => document.querySelector('slam-widget').get('scan')), Number(first[0]));
      assert.match(await tab.evaluate(() => document.querySelector('slam-widget').summary), /ring-another-day\.log/);

      const [name, tum] = await saved(tab, 'where');
      assert.equal(name, 'where.tum');
      assert.equal(tum.toString().trim().split('\n').length, facts.where_localized);

      // What the reader moves moves the places, and a worker that breaks finds them again.
      await press(tab, 'turn');
      await says(tab, /was removed from the graph/);
      await widget(tab, (it) => it.crashForTest('worker'));
      await says(tab, /was restarted/);
      await says(tab, /^(mapped|[^:]*in doubt): .*is found at scan \d+: of/);

      // A file that is not a log changes no result.
      await giveBytes(tab, 'empty.log', Buffer.alloc(0), 'where');
      await says(tab, /empty\.log is empty; use a recorded log/);
      await giveBytes(tab, 'x.slam2d', Buffer.from('SLAM2D\r\n'), 'where');
      await says(tab, /x\.slam2d is a saved session, not a log of scans/);
      assert.match((await outcome(tab)).sentence, /The robot of ring-another-day\.log is found/);
    }, { options: { sees: true } });
  });

  it('localizes a log dropped with a session, and uses a single log as the setting says', async () => {
    await page(async (tab) => {
      await press(tab, 'sample');
      await isMapped(tab);
      const [, session] = await saved(tab, 'session');
      await drop(tab, [['day.log', OTHER_DAY], ['monday.slam2d', session]]);
      await says(tab, /^(mapped|[^:]*in doubt): monday\.slam2d.*The robot of day\.log is found/);
      await tab.evaluate(() => Object.assign(document.querySelector('slam-widget'), { drop: 'where' }));
      // A resting picture is started to provide the start pose.
      await widget(tab, (it) => it.suspend());
      await drop(tab, [['again.log', OTHER_DAY]]);
      await says(tab, /monday\.slam2d.*The robot of again\.log is found/);
      // Near the keyframe shown, which is the wrong start.
      await tab.evaluate(() => { document.querySelector('slam-widget').value = { start: 'here', keyframe: 0 }; });
      await drop(tab, [['near.log', OTHER_DAY]]);
      await says(tab, /The robot of near\.log is found/);
      await tab.evaluate(() => { document.querySelector('slam-widget').value = { drop: 'map' }; });
      await drop(tab, [['map.log', OTHER_DAY]]);
      await says(tab, /^(mapped|[^:]*in doubt): map\.log/);
      assert.doesNotMatch((await outcome(tab)).sentence, /The robot of/);
    });
  });

  it('offers the topics and frames of a recording, and maps it again with another one', async () => {
    await page(async (tab) => {
      await giveBytes(tab, 'plain.mcap', readFileSync(join(RECORDINGS, 'plain.mcap')));
      await says(tab, /(mapped|in doubt): plain\.mcap: .*24 scans/);
      const taken = async () => (await table(tab, 'offers')).find(([label]) => label === 'body frame')[1];
      const before = await taken();
      const way = (await outcome(tab)).facts.path_length_m;
      await tab.evaluate(() => Object.assign(document.querySelector('slam-widget'), { option: 'body-frame' }));
      await press(tab, 'other');
      // Another frame makes another map: the keyframes stand elsewhere.
      await tab.waitForFunction((way) => {
        const { verdict, facts } = document.querySelector('slam-widget').outcome;
        return /mapped|in doubt/.test(verdict) && facts.path_length_m !== way;
      }, way);
      assert.notEqual(await taken(), before);
      assert.match((await outcome(tab)).sentence, /plain\.mcap: .*24 scans/);
      await tab.evaluate(() => Object.assign(document.querySelector('slam-widget'), { option: 'scan-topic' }));
      const other = tab.locator('slam-widget').getByRole('button', { name: 'Take another', exact: true });
      assert.equal(await other.getAttribute('aria-disabled'), 'true', 'the recording has one topic of scans');
    });
  });

  it('reports broken, empty, foreign and truncated files in a sentence, and maps the next one', async () => {
    await page(async (tab) => {
      for (const [name, text, said] of [
        ['empty.log', '', /no map: empty\.log is empty; use a recorded log/],
        ['packed.log', '\u001f\u008b', /no map: packed\.log/],
        ['photo.png', '\u0089PNG\u0000\u0001', /no map: photo\.png is a map or a picture, not a log of scans/],
        ['broken.g2o', 'VERTEX_SE2 0 zero\n', /no map: broken\.g2o.*line 1/],
        ['cut.mcap', '\u0089MCAP', /no map: cut\.mcap/],
        ['<b>x</b>.log', 'words', /no map: <b>x<\/b>\.log/],
      ]) {
        await give(tab, name, text);
        await says(tab, said);
      }
      await give(tab, 'half.log', SAMPLE.slice(0, SAMPLE.length / 2));
      await says(tab, /(mapped|in doubt): half\.log/);
      const remarks = (await tab.evaluate(() => document.querySelector('slam-widget').tables()))
        .find(({ id }) => id === 'remarks');
      assert.match(remarks.csv, /is incomplete/);
      await give(tab, 'truth.tum', 'not a pose\n');
      await says(tab, /truth\.tum: line 1/);
      assert.match((await outcome(tab)).sentence, /half\.log/, 'the map stays');
    });
  });

  it('lays the scans of each contradicting loop on each other, to be accepted or rejected', async () => {
    await page(async (tab) => {
      const host = tab.locator('slam-widget');
      const stop = host.getByRole('button', { name: 'Stop', exact: true });
      const isDisabled = async () => await stop.getAttribute('aria-disabled') === 'true';
      assert.ok(await isDisabled(), 'at rest');
      // On a busy machine the sample may be mapped before the test looks.
      const seen = await stop.evaluateHandle((button) => {
        const states = [];
        new MutationObserver(() => states.push(button.getAttribute('aria-disabled')))
          .observe(button, { attributeFilter: ['aria-disabled'] });
        return states;
      });
      await press(tab, 'sample');
      await isMapped(tab);
      await tab.waitForFunction((states) => states.at(-1) === 'true', seen);
      assert.ok((await seen.jsonValue()).some((state) => state !== 'true'), 'while the sample is mapped');
      assert.match((await outcome(tab)).verdict, /^none of \d+ loops in doubt$/);
      const list = host.getByRole('region', { name: 'Loops in doubt' });
      assert.ok(await list.isHidden());

      // A keyframe held beside its place contradicts its loops.
      const [, [from]] = await table(tab, 'all-loops');
      await tab.evaluate((keyframe) => document.querySelector('slam-widget').set('keyframe', keyframe), Number(from));
      for (let k = 0; k < 10; k += 1) await press(tab, 'east');
      await list.waitFor();
      await says(tab, /^\d+ of \d+ loops in doubt:/);
      const before = await outcome(tab);
      assert.equal(before.standing, 'doubtful');
      const count = before.facts.loops_doubted;
      const buttons = (name) => list.getByRole('button', { name });
      assert.equal(await buttons(/^Reject/).count(), Math.min(count, 6));
      const picture = list.getByRole('button', { name: /^Show the loop/ }).first().locator('svg');
      assert.ok(await picture.evaluate((it) => [...it.children].every((dots) => dots.getTotalLength() === 0 && dots.getAttribute('d').length > 500)));
      assert.deepEqual(await violations(tab, 'slam-widget', OF_COLORS), []);

      // The buttons do it with the keyboard, and the focus stays with the next loop.
      await buttons(/^Accept/).first().focus();
      await tab.keyboard.press('Enter');
      await tab.waitForFunction((left) => document.querySelector('slam-widget').outcome.facts.loops_doubted === left, count - 1);
      assert.equal((await outcome(tab)).facts.loops, before.facts.loops, 'an accepted loop stays');
      assert.match((await outcome(tab)).sentence, /1 accepted by you/);
      const rejected = await buttons(/^Reject/).first().getAttribute('aria-label');
      await buttons(/^Reject/).first().focus();
      await tab.keyboard.press('Enter');
      await says(tab, /was removed from the graph; keyframes moved/);
      await list.getByRole('button', { name: rejected }).waitFor({ state: 'detached' });
      const after = await outcome(tab);
      assert.equal(after.facts.loops, before.facts.loops - 1);
      assert.ok(after.facts.loops_doubted <= count - 2, 'the rejected one does not count');
      const isInList = () => document.querySelector('slam-widget').shadowRoot.activeElement?.closest('.loops') !== null;
      assert.ok(await tab.evaluate(isInList), 'the focus is lost');
    });
  });

  it('survives scrolling away, a lost context, and crashes of widget and worker', async () => {
    await page(async (tab) => {
      await press(tab, 'sample');
      await isMapped(tab);
      await press(tab, 'turn');
      await says(tab, /was removed from the graph/);
      const { facts: { loops, keyframes } } = await outcome(tab);
      const same = async () => {
        await isMapped(tab);
        const { facts } = await outcome(tab);
        assert.deepEqual([facts.loops, facts.keyframes], [loops, keyframes]);
      };
      await widget(tab, (it) => it.suspend());
      await press(tab, 'mark');
      await same();

      await tab.evaluate(() => {
        const canvas = document.querySelector('slam-widget').shadowRoot.querySelector('canvas');
        canvas?.getContext('webgl2')?.getExtension('WEBGL_lose_context')?.loseContext();
      });
      await press(tab, 'mark');
      await same();

      await widget(tab, (it) => { try { it.crashForTest(); } catch { /* on purpose */ } });
      await tab.getByRole('button', { name: 'Restart with these settings' }).click();
      await h.ready(tab);
      await same();

      await widget(tab, (it) => it.crashForTest('worker'));
      await says(tab, /was restarted/);
      await isMapped(tab);
      await tab.waitForFunction((goal) => document.querySelector('slam-widget').outcome.facts.loops === goal, loops);
    }, { quiet: false });
  });

  it('reports in a sentence that the page may start no worker', async () => {
    const policy = `${h.STRICT_POLICY}; worker-src 'none'`;
    await page(async (tab) => {
      await press(tab, 'sample');
      await says(tab, /no map: .*may not start one/);
    }, { quiet: false, server: { policy } });
  });

  it('reports in a sentence that its program does not arrive', async () => {
    const answer = (path, response) => {
      const isProgram = /^\/slam_robot-.*\.wasm$/.test(path);
      if (isProgram) {
        response.statusCode = 404;
        response.end();
      }
      return isProgram;
    };
    await page(async (tab) => {
      await press(tab, 'sample');
      await says(tab, /The log cannot be mapped: the program could not be fetched \(404\)\./);
    }, { quiet: false, server: { answer } });
  });

  it('maps the Intel log', async (context) => {
    const log = join(LOGS, 'intel.clf');
    if (!existsSync(log)) return skip(context, 'recorded logs: see docs/testing.md');
    await page(async (tab) => {
      const chosen = tab.waitForEvent('filechooser');
      await press(tab, 'open');
      const start = performance.now();
      await (await chosen).setFiles(log);
      await isMapped(tab);
      const seconds = ((performance.now() - start) / 1000).toFixed(1);
      await give(tab, 'intel.relations', readFileSync(join(LOGS, 'intel.relations'), 'utf8'));
      await says(tab, /relations: /);
      const { facts } = await outcome(tab);
      context.diagnostic(`Intel: ${seconds} s from file to map, ${facts.error_m.toFixed(4)} m over the relations`);
      assert.equal(facts.scans, 2726);
      // docs/robots.md: 0.076; the module has the same bits as the command.
      assert.ok(facts.error_m < 0.08, String(facts.error_m));
    });
  });
});

/** Opens a recording, or the files of its folder, and compares doctor's report, rejection and map with those of the command. */
async function matchesCommand(tab, name) {
  const path = join(FIELD, name);
  const parts = statSync(path).isDirectory() ? readdirSync(path).map((part) => join(path, part)) : [path];
  const command = (...words) => {
    try {
      return { json: JSON.parse(native('slam2d', ...words, '--json')) };
    } catch ({ status, stdout, stderr }) {
      // 1: something was repaired, or needs attention; 2, of the doctor: it cannot be mapped.
      return { json: String(stdout) === '' ? undefined : JSON.parse(stdout), status, rejection: String(stderr).trim().split('\n').at(-1) };
    }
  };
  await drop(tab, parts.map((part) => [basename(part), readFileSync(part)]));
  const told = command('doctor', path);
  if (told.json !== undefined) {
    // The same bits in the page as natively; a recording from a folder has the name of its file.
    // What only mapping shows is added at the end; the comparison tells what is missing.
    await tab.waitForFunction(([files, remarks]) => {
      const found = document.querySelector('slam-widget').diagnosis;
      return files.some((file) => found?.name.startsWith(file)) && found.remarks.length >= remarks;
    }, [parts.map((part) => basename(part)), told.json.remarks.length]).catch(() => {});
    assert.deepEqual({ ...(await diagnosis(tab)), name: told.json.name }, told.json, name);
  }
  const { json: run, rejection } = command('run', path);
  if (run === undefined) {
    // The page gives a file, or the first one of a folder, without its path.
    await says(tab, /^no map: /);
    const { sentence } = await outcome(tab);
    const fault = rejection.replace(`slam2d: ${path}`, '');
    assert.ok(sentence.includes(fault), `${sentence}\n${fault}`);
    return;
  }
  await isMapped(tab);
  const { facts } = await outcome(tab);
  assert.deepEqual([facts.scans, facts.keyframes], [run.scans, run.keyframes], name);
}

describe('the doctor', () => {
  it('shows a report before the map, with buttons and fields that map the log again, by keyboard and in any width', async () => {
    await visit(`<main><h1>A robot</h1>${BODY}</main>`, async (tab) => {
      await h.ready(tab);
      await give(tab, 'ring.log', SAMPLE);
      const before = await tab.waitForFunction(() => {
        const { outcome: { facts }, diagnosis: found } = document.querySelector('slam-widget');
        return facts.scans > 0 && { verdict: found?.verdict };
      });
      assert.equal((await before.jsonValue()).verdict, 'good', 'the screen comes before the first scan');
      const screen = tab.getByRole('region', { name: 'What the doctor found' });
      await screen.getByText('✓ ring.log: the recording is in order').first().waitFor();
      await isMapped(tab);
      assert.ok(await screen.getByLabel('turned left, °').isHidden(), 'a log without a fault leaves the map where it is');
      await screen.locator('summary').click();

      // By hand, and by keys: a laser that looks backwards is reported with the option that corrects it.
      await screen.getByLabel('turned left, °').fill('180');
      await screen.getByLabel('turned left, °').press('Enter');
      const turned = await diagnosis(tab, '0,0,180');
      assert.equal(turned.verdict, 'wrong');
      assert.deepEqual(turned.remarks.find(({ part }) => part === 'mounting').options, ['--laser 0,0,0']);
      const focused = () => tab.evaluate(() => document.querySelector('slam-widget').shadowRoot.activeElement?.localName);
      assert.equal(await focused(), 'summary', 'the heading has the focus of what is gone');
      await screen.getByRole('img', { name: 'not repaired' }).waitFor();
      await tab.setViewportSize({ width: 390, height: 844 });
      for (const colorScheme of ['light', 'dark']) {
        await tab.emulateMedia({ colorScheme });
        await tab.waitForFunction((dark) => document.querySelector('slam-widget').shadowRoot
          .querySelector('.frame').classList.contains('dark') === dark, colorScheme === 'dark');
        assert.deepEqual(await violations(tab, colorScheme === 'dark' ? OF_COLORS : undefined), []);
      }
      assert.equal(await tab.evaluate(() => document.documentElement.scrollWidth), 390);
      await isMapped(tab);
      await screen.getByRole('button', { name: 'Map with --laser 0,0,0' }).press('Enter');
      assert.equal((await diagnosis(tab, '0,0,0')).verdict, 'good');
      await screen.getByRole('button', { name: 'Map without options' }).press('Enter');
      assert.equal((await diagnosis(tab, null)).verdict, 'good');
      await isMapped(tab);
      assert.match((await outcome(tab)).sentence, /^ring\.log: .*\d+ scans/);
      // Any other option of the command, and the way back from one that it rejects.
      const another = screen.getByLabel('Another option of slam2d run');
      await another.fill('--min-range -1');
      await another.press('Enter');
      await screen.getByText('✗ ring.log cannot be mapped with these options').first().waitFor();
      await another.fill('--min-range 0.2');
      await another.press('Enter');
      await diagnosis(tab, null);
      await screen.getByText('Mapped with --min-range 0.2.').waitFor();
      await screen.getByRole('button', { name: 'Map without options' }).press('Enter');
      await isMapped(tab);
      // Neither a graph nor an empty widget has a doctor's report.
      await give(tab, 'square.g2o', SQUARE);
      await says(tab, /in doubt: square\.g2o/);
      assert.ok(await screen.isHidden());
      await give(tab, 'ring.log', SAMPLE);
      await diagnosis(tab);
      await press(tab, 'defaults');
      await says(tab, /no log yet/);
      assert.ok(await screen.isHidden());
    }, { options: { viewport: { width: 1000, height: 900 } }, fresh: true });
  });

  it('opens a dropped rosbag2 folder, and reports a file that is missing from it', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'slam-bag-'));
    try {
      cpSync(join(RECORDINGS, 'plain.db3'), join(folder, 'bag_0.db3'));
      writeFileSync(join(folder, 'metadata.yaml'), 'relative_file_paths:\n  - bag_0.db3\n');
      await page(async (tab) => {
        const system = await tab.context().newCDPSession(tab);
        const [x, y] = await h.pointOf(tab, 'map', 0, 0);
        const data = { items: [], files: [folder], dragOperationsMask: 1 };
        for (const type of ['dragEnter', 'dragOver', 'drop']) {
          await system.send('Input.dispatchDragEvent', { type, x, y, data });
        }
        await says(tab, /(mapped|in doubt): bag_0\.db3: .*24 scans/);
        const metadata = 'relative_file_paths:\n  - bag_0.db3\n  - bag_1.db3\n';
        await drop(tab, [['bag_0.db3', readFileSync(join(folder, 'bag_0.db3'))], ['metadata.yaml', metadata]]);
        await tab.waitForFunction(() => JSON.stringify(document.querySelector('slam-widget').diagnosis).includes('bag_1.db3'));
        await isMapped(tab);
        await drop(tab, [['a.log', SAMPLE], ['b.log', SAMPLE]]);
        await says(tab, /no map: a\.log and 1 more is neither a recording of ROS nor scans.*give one log at a time/);
      });
    } finally {
      rmSync(folder, { recursive: true });
    }
  });

  it('reports the same as the command on real recordings', async (context) => {
    if (!existsSync(FIELD)) return skip(context, 'recordings with the faults that people report: see docs/recordings.md');
    await page(async (tab) => {
      for (const name of [
        'base/base.mcap',
        'carmen/six_digit_stamps.log',
        'containers/index_length_lies.bag',
        'containers/rosbag2_db3',
        'containers/whole_file.mcap.zstd',
        'mount/mirrored_driver.mcap',
        'odom/millimetres_odom.mcap',
        'stamps/scan_clock_+3600.mcap',
        'units/degrees.mcap',
        'tum/euroc.csv',
      ]) await matchesCommand(tab, name);
    });
  });

  it('maps or rejects slow sweeps, restarts, two robots, folders and tables as the command does', async (context) => {
    if (!existsSync(FIELD)) return skip(context, 'files that people have: see docs/recordings.md');
    await page(async (tab) => {
      for (const name of [
        'deskew/drive_no_wheels_sweep100.mcap',
        'deskew/rest12_drive12_wheels_sweep100.mcap',
        'deskew_real/create3_rplidar_20s.mcap',
        'restart/carried_3s_ahead.mcap',
        'two_robots/namespaced.mcap',
        'two_robots/two_drivers_one_topic.mcap',
        'starts_in_the_open/first_20_no_return_noodo.mcap',
        'body/body_behind_108deg.mcap',
        'folders/killed_recording_wal',
        'folders/git_lfs_pointer',
        'formats/rostopic_echo_p.csv',
        'formats/map.pbstream',
      ]) await matchesCommand(tab, name);
    });
  });
});
