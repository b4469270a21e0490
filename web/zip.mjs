import { mkdir, writeFile } from 'node:fs/promises';
import { dirname } from 'node:path';
import { zipSync } from 'fflate';

/** Writes files by their names as a zip, the same bytes for the same files. Returns its size in bytes. */
export async function writeZip(target, contents) {
  const packed = zipSync(contents, { level: 9, mtime: new Date(1980, 0, 1) });
  await mkdir(dirname(target), { recursive: true });
  await writeFile(target, packed);
  return packed.length;
}
