// Links and attributes are checked in TypeScript before any wasm is loaded. Its rules must be those of the
// core, for every parameter of every widget.

import assert from 'node:assert/strict';
import { it } from 'node:test';
import * as esbuild from '../../web/node_modules/esbuild/lib/main.js';
import { ROOT, schema, wasm } from './module.mjs';

async function load(file) {
  const { outputFiles } = await esbuild.build({
    entryPoints: [`${ROOT}web/ts/${file}`],
    bundle: true,
    format: 'esm',
    write: false,
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
}

const { parseValue, defaultText } = await load('values.ts');
const { readQuery, writeQuery } = await load('links.ts');

const TEXTS = ['', ' ', '0', '1', '-1', '3.7', '1e2', '1e400', '-0', '.5', '5.', '+2', 'NaN', 'inf', 'Infinity',
  '0x10', '1_000', '1,5', '12px', 'on', 'off', 'true', 'false', 'ON', 'null', '<b>', '4294967295', '4294967296',
  '1e-9', '0.1234567890123456', '179.99999999999', '180.0000001', '-180', ' 25 '];

/** Numbers as numbers, with a single zero; everything else unchanged. */
function comparable(text) {
  return Number.isNaN(Number(text)) ? text : Number(text) + 0;
}

it('both sides accept and reject the same texts', () => {
  let taken = 0;
  for (const widget of schema) {
    for (const param of widget.params) {
      const texts = param.kind === 'text' ? ['Aa0-_', 'a b', 'a+b', 'A'.repeat(param.max), 'A'.repeat(param.max + 1)] : [];
      const own = [...texts, ...param.options.map((option) => option.id), `${param.min}`, `${param.max}`,
        `${param.min - param.step}`, `${param.max + param.step}`];
      for (const text of [...TEXTS, ...own]) {
        const [ok, answer] = JSON.parse(wasm.parseParam(widget.id, param.id, text));
        const parsed = parseValue(param, text);
        const where = `${widget.id} ${param.id} \`${text}\``;
        assert.equal(parsed.ok, ok, `${where}: ${answer}`);
        if (ok) {
          taken += 1;
          assert.equal(comparable(answer), comparable(parsed.text), where);
        } else {
          assert.match(parsed.problem, new RegExp(`^\`${param.id}\` takes `), where);
        }
      }
    }
  }
  assert.ok(taken > 100, `${taken} texts were taken`);
});

it('a link written for a state is parsed to the same state', () => {
  for (const widget of schema) {
    const values = new Map(widget.params.map((param) => [param.id, defaultText(param)]));
    assert.equal(writeQuery(widget, values), `?w=${widget.id.slice(1)}`);
    for (const param of widget.params) {
      if (param.kind === 'text') values.set(param.id, 'Aa0-_');
      if (param.kind === 'text') continue;
      const last = param.options.at(-1)?.id ?? (param.kind === 'switch' ? 'off' : `${param.max}`);
      values.set(param.id, last);
    }
    const read = readQuery(writeQuery(widget, values));
    assert.deepEqual(read.problems, []);
    for (const [id, text] of read.values) assert.equal(text, values.get(id), id);
  }
});

it('each error of a broken link is reported', () => {
  const { problems, values } = readQuery('?w=16.1&heading=abc&bogus=1&heading=30');
  assert.match(problems[0], /`heading` takes a number, not `abc`/);
  assert.match(problems[1], /has no parameter `bogus`; it has heading/);
  assert.deepEqual(values, [['heading', '30']]);
  assert.match(readQuery('?w=99').problems[0], /no widget `99`/);
  assert.equal(readQuery('?x=1'), undefined);
});
