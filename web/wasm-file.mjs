// Edits and measures wasm files.

import { brotliCompressSync, constants } from 'node:zlib';

/** Removes the function names: only debuggers need them, and they are a quarter of the module. */
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

/** The custom section with the build id; web/ts/module.ts reads it. */
const BUILD_ID_SECTION = 'build';

/** Adds the id of a build as a custom section. */
export function withBuildId(module, id) {
  const [name, text] = [BUILD_ID_SECTION, id].map((words) => Buffer.from(words));
  const section = Buffer.concat([Buffer.from([name.length]), name, text]);
  if (section.length > 127) throw new Error('a build id must be short: the size of its section is one byte');
  return Buffer.concat([module, Buffer.from([0, section.length]), section]);
}

/** Reads an unsigned LEB128 number; returns it with the offset after it. */
function leb128(bytes, at) {
  let value = 0;
  for (let shift = 0; ; shift += 7) {
    const byte = bytes[at];
    at += 1;
    value += (byte & 127) * 2 ** shift;
    if (byte < 128) return [value, at];
  }
}

/** The size after brotli compression at the highest level. */
export function brotli(bytes) {
  const params = {
    [constants.BROTLI_PARAM_QUALITY]: 11,
    [constants.BROTLI_PARAM_LGWIN]: 24,
    [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
  };
  return brotliCompressSync(bytes, { params }).length;
}
