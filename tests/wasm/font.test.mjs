// Every character that a widget can show is in the supplied font: a missing one would look different on each
// machine.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { it } from 'node:test';
import { ROOT, afterEachPreset, schema, wasm } from './module.mjs';

/** The characters of the font's own table (format 4 or 12 of `cmap`). */
function charactersOf(file) {
  const font = readFileSync(file);
  const tables = Array.from({ length: font.readUInt16BE(4) }, (_, i) => 12 + 16 * i);
  const cmap = font.readUInt32BE(tables.find((at) => font.toString('latin1', at, at + 4) === 'cmap') + 8);
  const found = new Set();
  for (let i = 0; i < font.readUInt16BE(cmap + 2); i += 1) {
    const at = cmap + font.readUInt32BE(cmap + 4 + 8 * i + 4);
    if (font.readUInt16BE(at) === 12) {
      for (let group = 0; group < font.readUInt32BE(at + 12); group += 1) {
        const [first, last] = [0, 4].map((offset) => font.readUInt32BE(at + 16 + 12 * group + offset));
        for (let code = first; code <= last; code += 1) found.add(code);
      }
    } else if (font.readUInt16BE(at) === 4) {
      const double = font.readUInt16BE(at + 6);
      for (let segment = 0; segment < double; segment += 2) {
        const last = font.readUInt16BE(at + 14 + segment);
        const first = font.readUInt16BE(at + 16 + double + segment);
        for (let code = first; code <= last && code !== 0xffff; code += 1) found.add(code);
      }
    }
  }
  return found;
}

it('the font has every character of every widget', () => {
  const fonts = ['public-sans', 'dejavu'].map((name) => charactersOf(`${ROOT}web/fonts/${name}/subset.ttf`));
  const font = new Set(fonts.flatMap((characters) => [...characters]));
  assert.ok(font.has('a'.codePointAt(0)) && font.has('χ'.codePointAt(0)) && !font.has('漢'.codePointAt(0)));
  for (const { id } of schema) {
    const widget = new wasm.Widget(id);
    const pictureText = [...widget.picture(900, 'light').matchAll(/<text[^>]*>([^<]*)/g)].map(([, text]) => text);
    const shown = [JSON.stringify(schema.find((found) => found.id === id)), afterEachPreset(id), ...pictureText];
    const missing = new Set([...shown.join('')].filter((char) => char >= ' ' && !font.has(char.codePointAt(0))));
    assert.deepEqual([...missing], [], `${id} shows characters that the font lacks`);
    widget.free();
  }
});
