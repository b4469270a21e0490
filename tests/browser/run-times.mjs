// Runs the browser tests: `node tests/browser/run.mjs [--only manners,drag] [--jobs 2] [--write docs/testing.md]`.
//
// All files share one Chromium. Two files run at a time; those with measurements that others could disturb run alone. The
// output of a failing file is printed. With --write, the table of the engines' tests goes into that document.

import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { writeGeneratedBlock } from '../../web/generated-block.mjs';
import { launchServer } from './chromium.mjs';
import { ENGINES, engineTable } from './engines/table.mjs';

const HERE = fileURLToPath(new URL('.', import.meta.url));
/** These count frames, or depend on the garbage collector. */
const ALONE = ['frames', 'leaks'];
/** Time limit of a file that hangs; no test takes that long. */
const LAST_RESORT_MS = 20 * 60_000;
/** Number of slowest tests to list. */
const SLOWEST = 120;

/** The child processes, which are killed with this one. */
const running = new Set();
for (const signal of ['SIGINT', 'SIGTERM']) {
  process.on(signal, () => {
    for (const child of running) child.kill('SIGKILL');
    process.exit(1);
  });
}

const { only, jobs, document } = readArguments(process.argv.slice(2));
const folder = mkdtempSync(join(tmpdir(), 'slam-browser-'));
const chromium = await launchServer();
const started = performance.now();
let results;
try {
  results = await runAll();
} finally {
  await chromium.close();
  rmSync(folder, { recursive: true });
}
report(results);
if (document !== undefined) await writeGeneratedBlock(document, 'engines', engineTable(results));
process.exitCode = results.every(({ failed, code }) => failed === 0 && code === 0) ? 0 : 1;

/** Parses the arguments; exits with one line if one is wrong. */
function readArguments(args) {
  const known = readdirSync(HERE).map((file) => file.match(/^(.+)\.test\.mjs$/)?.[1]).filter(Boolean).sort();
  const found = { only: known, jobs: 2, document: undefined };
  for (let at = 0; at < args.length; at += 2) {
    const [option, value = ''] = args.slice(at, at + 2);
    if (option === '--only') {
      found.only = value.split(',');
      const unknown = found.only.filter((name) => !known.includes(name));
      if (unknown.length > 0) reject(`there is no ${unknown.join(', ')}; there are ${known.join(', ')}`);
    } else if (option === '--jobs' && /^[1-9]\d*$/.test(value)) {
      found.jobs = Number(value);
    } else if (option === '--write' && value !== '') {
      found.document = value;
    } else {
      reject(`run.mjs takes --only NAME,NAME, --jobs NUMBER and --write DOCUMENT, not \`${[option, value].join(' ').trim()}\``);
    }
  }
  const lacking = Object.keys(ENGINES).filter((name) => !found.only.includes(name));
  if (found.document !== undefined && lacking.length > 0) reject(`--write needs the tests of every engine, also ${lacking.join(', ')}`);
  return found;
}

function reject(sentence) {
  console.error(sentence);
  process.exit(2);
}

async function runAll() {
  const done = [];
  const together = only.filter((name) => !ALONE.includes(name));
  const worker = async (queue) => {
    for (let name = queue.shift(); name !== undefined; name = queue.shift()) {
      const result = await runFile(name);
      done.push(result);
      reportFile(result);
    }
  };
  await Promise.all(Array.from({ length: jobs }, () => worker(together)));
  await worker(only.filter((name) => ALONE.includes(name)));
  return done;
}

/** Runs one file in a separate process. */
function runFile(name) {
  const log = join(folder, `${name}.json`);
  const child = spawn(process.execPath, [
    '--test-reporter=spec', '--test-reporter-destination=stdout',
    `--test-reporter=${join(HERE, 'events.mjs')}`, `--test-reporter-destination=${log}`,
    join(HERE, `${name}.test.mjs`),
  ], { env: { ...process.env, SLAM_CHROMIUM: chromium.wsEndpoint() }, stdio: ['ignore', 'pipe', 'pipe'] });
  running.add(child);
  let printed = '';
  for (const stream of [child.stdout, child.stderr]) stream.on('data', (bytes) => (printed += bytes));
  const begun = performance.now();
  const hang = setTimeout(() => child.kill('SIGKILL'), LAST_RESORT_MS);
  return new Promise((resolve) => {
    child.on('close', (code, signal) => {
      clearTimeout(hang);
      running.delete(child);
      const tests = readLog(log);
      resolve({
        name,
        tests,
        printed,
        code: code ?? 1,
        signal,
        ms: performance.now() - begun,
        failed: tests.filter(({ passed }) => !passed).length,
      });
    });
  });
}

function readLog(log) {
  try {
    return readFileSync(log, 'utf8').split('\n').filter(Boolean).map((line) => JSON.parse(line));
  } catch {
    return [];
  }
}

function seconds(ms) {
  return `${(ms / 1000).toFixed(1).padStart(7)} s`;
}

function reportFile({ name, tests, failed, code, signal, ms, printed }) {
  const isWell = failed === 0 && code === 0;
  if (!isWell) console.log(printed);
  const end = signal === null ? '' : `, ended by ${signal}`;
  const verdict = isWell ? '' : `, ${failed} failed${end}`;
  console.log(`${seconds(ms)}  ${name}: ${tests.length} tests${verdict}`);
}

function report(files) {
  const all = files.flatMap(({ name, tests }) => tests.map((test) => ({ file: name, ...test })));
  console.log('\nThe slowest tests');
  for (const { ms, file, name } of all.sort((a, b) => b.ms - a.ms).slice(0, SLOWEST)) {
    console.log(`${seconds(ms)}  ${file}: ${name}`);
  }
  const passed = all.filter((test) => test.passed && test.skipped === false).length;
  const skipped = all.filter((test) => test.passed && test.skipped !== false);
  for (const { file, name, skipped: why } of skipped) console.log(`skipped: ${file}: ${name}: ${why}`);
  // A file that crashed has a failure outside of its tests.
  const failed = files.reduce((sum, file) => sum + Math.max(file.failed, file.code === 0 ? 0 : 1), 0);
  console.log(`\n${seconds(performance.now() - started).trim()} in all`);
  console.log(`${passed} passed, ${failed} failed, ${skipped.length} skipped`);
}
