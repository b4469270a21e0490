// The size of a wasm file, and the parts that it does not need.

import { brotliCompressSync, constants } from 'node:zlib';

/** The names of functions are for debuggers only, and a quarter of the module. */
export function withoutNames(module) {
  const kept = [module.subarray(0, 8)];
  for (let at = 8; at < module.length; ) {
    const [size, start] = leb128(module, at + 1);
    const [nameLength, nameStart] = leb128(module, start);
    const name = module.subarray(nameStart, nameStart + nameLength).toString();
    const isCustom = module[at] === 0;
    if (!isCustom || (name !== 'name' && name !== 'producers')) {
      kept.push(module.subarray(at, start + size));
    }
    at = start + size;
  }
  return Buffer.concat(kept);
}

/** The section that holds the mark of a build; web/ts/module.ts looks for it. */
const MARK = 'build';

/** Adds the mark of a build: whoever has compiled the module can read which one it is. */
export function withMark(module, mark) {
  const [name, text] = [MARK, mark].map((words) => Buffer.from(words));
  const section = Buffer.concat([Buffer.from([name.length]), name, text]);
  if (section.length > 127) throw new Error('a mark is short: its size takes one byte');
  return Buffer.concat([module, Buffer.from([0, section.length]), section]);
}

/** An unsigned number at an offset, and the offset behind it. */
function leb128(bytes, at) {
  let value = 0;
  for (let shift = 0; ; shift += 7) {
    const byte = bytes[at];
    at += 1;
    value += (byte & 127) * 2 ** shift;
    if (byte < 128) return [value, at];
  }
}

/** The transferred bytes if the server compresses with brotli at its best level. */
export function brotli(bytes) {
  const params = {
    [constants.BROTLI_PARAM_QUALITY]: 11,
    [constants.BROTLI_PARAM_LGWIN]: 24,
    [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
  };
  return brotliCompressSync(bytes, { params }).length;
}
