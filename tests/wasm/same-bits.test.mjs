// The published wasm computes the same bits as the native build that the other tests check.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { native } from '../native.mjs';
import { afterEachPreset, schema, wasm } from './module.mjs';

describe('a lap', () => {
  for (const [seed, noise] of [[12648430, 1], [6, 1], [1, 0.25], [2, 2], [4, 4]]) {
    it(`of seed ${seed} at noise ×${noise} has the same digest of all poses`, () => {
      const lap = JSON.parse(native('ch16', 'lap', '--seed', `${seed}`, '--noise', `${noise}`, '--json'));
      assert.match(lap.digest, /^[0-9a-f]{16}$/);
      assert.equal(wasm.lapDigest(seed, noise), lap.digest);
    });
  }

  it('by the estimator for logs has the same digest of all poses, and a different one than by the chapter\'s', () => {
    const words = ['--seed', '12648430', '--noise', '2', '--front-end', 'local-map', '--json'];
    const digest = wasm.lapDigest(12648430, 2, true);
    assert.equal(digest, JSON.parse(native('ch16', 'lap', ...words)).digest);
    assert.notEqual(digest, wasm.lapDigest(12648430, 2));
  });

  it('of another seed has another digest', () => {
    assert.notEqual(wasm.lapDigest(1, 1), wasm.lapDigest(2, 1));
  });
});

describe('every widget', () => {
  for (const { id } of schema) {
    it(`${id} reports the same as natively after each preset`, () => {
      const lines = afterEachPreset(id).split('\n');
      const expected = native('states', id).split('\n');
      assert.equal(lines.length, expected.length);
      for (const [at, line] of lines.entries()) assert.equal(line, expected[at]);
    });
  }
});
