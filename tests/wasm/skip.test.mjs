// A skipped test is listed, and fails if skipping is not allowed.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { it } from 'node:test';

const SKIP = new URL('../skip.mjs', import.meta.url).href;

it('a skipped test is listed, and fails if no test may be skipped', () => {
  const folder = mkdtempSync(join(tmpdir(), 'slam-skip-'));
  try {
    const [file, list] = [join(folder, 'one.mjs'), join(folder, 'list')];
    writeFileSync(file, `import { it } from 'node:test';
import { skip } from '${SKIP}';
it('one', (context) => skip(context, 'no data'));
`);
    const run = (more) => {
      const env = { ...process.env, SLAM_SKIPPED: list, SLAM_NO_SKIP: '0', ...more };
      // A nested test run would report to the outer one.
      delete env.NODE_TEST_CONTEXT;
      return spawnSync(process.execPath, [file], { env, encoding: 'utf8' });
    };
    assert.equal(run({}).status, 0);
    assert.equal(readFileSync(list, 'utf8'), 'one: no data\n');
    const strict = run({ SLAM_NO_SKIP: '1' });
    assert.equal(strict.status, 1);
    assert.match(strict.stdout, /one: no data, and SLAM_NO_SKIP forbids skips/);
  } finally {
    rmSync(folder, { recursive: true });
  }
});
