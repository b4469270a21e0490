// The wasm that readers get computes the same bits as the native build that the other tests check.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { ROOT, afterEachPreset, schema, wasm } from './module.mjs';

/**
 * The output of a native program of the workspace. The suite says in which folder it has compiled
 * them; without it cargo compiles them first.
 */
function native(program, ...words) {
  const options = { cwd: ROOT, encoding: 'utf8', maxBuffer: 1 << 28 };
  const compiled = process.env.SLAM_NATIVE;
  if (compiled !== undefined) return execFileSync(join(compiled, program), words, options);
  const cargo = ['run', '--quiet', '--package', program === 'states' ? 'slam_web' : 'slam2d_cli'];
  return execFileSync('cargo', [...cargo, '--bin', program, '--', ...words], options);
}

describe('a lap', () => {
  for (const [seed, noise] of [[12648430, 1], [6, 1], [1, 0.25], [2, 2], [4, 4]]) {
    it(`of seed ${seed} at noise ×${noise} has the same digest of all poses`, () => {
      const lap = JSON.parse(native('slam2d', 'lap', '--seed', `${seed}`, '--noise', `${noise}`, '--json'));
      assert.match(lap.digest, /^[0-9a-f]{16}$/);
      assert.equal(wasm.lapDigest(seed, noise), lap.digest);
    });
  }

  it('of another seed has another digest', () => {
    assert.notEqual(wasm.lapDigest(1, 1), wasm.lapDigest(2, 1));
  });
});

describe('every widget', () => {
  for (const { id } of schema) {
    it(`${id} says the same after each preset`, () => {
      const lines = afterEachPreset(id).split('\n');
      const expected = native('states', id).split('\n');
      assert.equal(lines.length, expected.length);
      lines.forEach((line, at) => assert.equal(line, expected[at]));
    });
  }
});
