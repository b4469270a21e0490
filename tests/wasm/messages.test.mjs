// Messages from a page around an embedded widget: ten thousand of them, generated from a seed. None throws,
// none changes what it does not name, and an error is one short sentence. The core's side of the same
// interface is fuzzed: `fuzz/fuzz_targets/messages.rs`.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as esbuild from '../../web/node_modules/esbuild/lib/main.js';

const ROOT = fileURLToPath(new URL('../../', import.meta.url));
const SCHEMA = JSON.parse(readFileSync(`${ROOT}web/pkg/schema.json`, 'utf8'));
const MESSAGES = 10_000;

async function load(file) {
  const { outputFiles } = await esbuild.build({
    entryPoints: [`${ROOT}web/ts/${file}`],
    bundle: true,
    format: 'esm',
    write: false,
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
}

const { receive } = await load('messages.ts');
const { State } = await load('state.ts');

/** Numbers from 0 to 1, the same for the same seed (mulberry32). */
function random(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), 1 | state);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Generates messages for a widget: most of them almost right. */
class Inventor {
  constructor(spec, seed) {
    this.spec = spec;
    this.unit = random(seed);
  }

  pick(list) {
    return list[Math.floor(this.unit() * list.length)];
  }

  value(depth = 0) {
    const param = this.pick(this.spec.params);
    const makers = [
      () => param.min + this.unit() * (param.max - param.min),
      () => String(param.default),
      () => this.pick(param.options)?.id ?? 'on',
      () => this.pick([0, -0, 1, NaN, Infinity, 1e308, 5e-324, 2 ** 53, -1, 10n ** 40n]),
      () => this.pick(['', ' ', 'on', '1e999', '0x10', '<b>', '\u0000\u001b[2J', '9'.repeat(5000), '__proto__']),
      () => this.pick([null, undefined, true, false, new Date(NaN), new Map([[1, 2]]), /x/]),
      () => (depth > 3 ? 0 : Array.from({ length: 3 }, () => this.value(depth + 1))),
      () => (depth > 3 ? 0 : { toString: this.value(depth + 1), valueOf: this.value(depth + 1) }),
    ];
    return this.pick(makers)();
  }

  id() {
    const known = this.spec.params.map((param) => param.id);
    return this.pick([...known, ...known, 'bogus', '__proto__', 'constructor', '', 'x'.repeat(3000)]);
  }

  message() {
    const type = this.pick(['set', 'set', 'set', 'press', 'get', this.value()]);
    const message = { slam: this.unit() < 0.95 ? 1 : this.value(), type };
    const values = Object.fromEntries(Array.from({ length: 3 }, () => [this.id(), this.value()]));
    if (this.unit() < 0.95) message.values = this.unit() < 0.9 ? values : this.value();
    if (this.unit() < 0.9) message.button = this.pick([...this.spec.buttons.map((button) => button.id), this.value()]);
    if (this.unit() < 0.5) message.id = this.value();
    return this.pick([message, message, message, message, message, message, message, this.value()]);
  }
}

/** A widget that validates values by the rules of the element and computes nothing. */
function listener(spec) {
  const state = new State(spec);
  return {
    state: () => ({ value: state.toJSON() }),
    texts: () => new Map(state.texts),
    set(id, given) {
      const parsed = state.parse(id, given);
      if (!parsed.ok) throw new RangeError(parsed.problem);
      state.keep(id, parsed.text);
    },
    async press(button) {
      if (!spec.buttons.some(({ id }) => id === button)) throw new RangeError('no such button');
    },
  };
}

it('no message throws, or changes a parameter that it does not name', async () => {
  const counts = { taken: 0, rejected: 0, answered: 0 };
  for (const [index, spec] of SCHEMA.entries()) {
    const inventor = new Inventor(spec, 1 + index);
    const widget = listener(spec);
    for (let k = 0; k < MESSAGES / SCHEMA.length; k += 1) {
      const message = inventor.message();
      const before = widget.texts();
      receive(
        widget,
        message,
        (answer) => {
          assert.equal(answer.type, 'state');
          counts.answered += 1;
        },
        (error) => {
          assert.ok(error instanceof Error);
          assert.ok(error.message.length > 0 && error.message.length < 400, error.message);
          counts.rejected += 1;
        },
      );
      const named = message?.slam === 1 && message.type === 'set' ? Object.keys(message.values ?? {}) : [];
      for (const [id, text] of widget.texts()) {
        if (text === before.get(id)) continue;
        assert.ok(named.includes(id), `${spec.id}: ${id} changed by itself`);
        counts.taken += 1;
      }
    }
    // Rejections of buttons arrive later.
    await new Promise(setImmediate);
    assert.deepEqual([...widget.texts().keys()], spec.params.map((param) => param.id));
  }
  for (const [what, count] of Object.entries(counts)) assert.ok(count > 500, `${count} ${what}`);
});

it('a value that is accepted here is valid in the core', () => {
  for (const [index, spec] of SCHEMA.entries()) {
    const inventor = new Inventor(spec, 100 + index);
    const state = new State(spec);
    for (let k = 0; k < 2000; k += 1) {
      const id = inventor.id();
      let parsed;
      try {
        parsed = state.parse(id, inventor.value());
      } catch (error) {
        // An object that cannot be converted to a text.
        assert.ok(error instanceof TypeError);
        continue;
      }
      const param = spec.params.find((known) => known.id === id);
      if (!parsed.ok) continue;
      const isNumber = !['choice', 'switch', 'text'].includes(param.kind);
      if (isNumber) assert.ok(Number(parsed.text) >= param.min && Number(parsed.text) <= param.max);
      assert.deepEqual(state.parse(id, parsed.text), parsed);
    }
  }
});
