import { mkdir, writeFile } from 'node:fs/promises';
import { dirname } from 'node:path';
import { zipSync } from 'fflate';

/** Writes a reproducible zip of files by their names. Returns its size in bytes. */
export async function writeZip(target, contents) {
  const packed = zipSync(contents, { level: 9, mtime: new Date(1980, 0, 1) });
  await mkdir(dirname(target), { recursive: true });
  await writeFile(target, packed);
  return packed.length;
}
