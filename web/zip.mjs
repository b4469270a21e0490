import { mkdir, writeFile } from 'node:fs/promises';
import { dirname } from 'node:path';
import { crc32, deflateRawSync } from 'node:zlib';

/** 1 January 1980, as MS-DOS writes it, so that the same files make the same zip. */
const DATE = (1 << 5) | 1;
/** Version 2.0 of the format; names in UTF-8; deflated. */
const [VERSION, UTF8, DEFLATED] = [20, 1 << 11, 8];

/**
 * Writes a reproducible zip of files by their names, by Node alone: the packages for courses need no npm. Returns its size
 * in bytes. Format: PKWARE APPNOTE 6.3.10, sections 4.3.7, 4.3.12 and 4.3.16.
 */
export async function writeZip(target, contents) {
  const [bodies, directory] = [[], []];
  let offset = 0;
  for (const [name, content] of Object.entries(contents)) {
    const path = Buffer.from(name);
    const packed = deflateRawSync(content, { level: 9 });
    const common = Buffer.concat([
      shorts(VERSION, UTF8, DEFLATED, 0, DATE), longs(crc32(content), packed.length, content.length), shorts(path.length, 0),
    ]);
    const body = [Buffer.from('PK\x03\x04'), common, path, packed];
    bodies.push(...body);
    directory.push(Buffer.from('PK\x01\x02'), shorts(VERSION), common, shorts(0, 0, 0), longs(0, offset), path);
    offset += body.reduce((sum, { length }) => sum + length, 0);
  }
  const entries = Object.keys(contents).length;
  const size = directory.reduce((sum, { length }) => sum + length, 0);
  const end = [Buffer.from('PK\x05\x06'), shorts(0, 0, entries, entries), longs(size, offset), shorts(0)];
  const zip = Buffer.concat([...bodies, ...directory, ...end]);
  await mkdir(dirname(target), { recursive: true });
  await writeFile(target, zip);
  return zip.length;
}

/** Numbers of two bytes, the low one first. */
function shorts(...numbers) {
  return Buffer.from(Uint16Array.from(numbers).buffer);
}

/** Numbers of four bytes, the low one first. */
function longs(...numbers) {
  return Buffer.from(Uint32Array.from(numbers).buffer);
}
