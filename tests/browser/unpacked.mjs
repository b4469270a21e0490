// The offline site as a reader unpacks it.

import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { DIST } from './harness.mjs';

const { unzipSync } = createRequire(new URL('../../web/package.json', import.meta.url))('fflate');

/** Zips the site to `zip`, and unpacks it into `folder`; `edited` returns what is written of each file. */
export function unpackOffline(zip, folder, edited = (_name, bytes) => bytes) {
  execFileSync(process.execPath, [fileURLToPath(new URL('../../web/offline.mjs', import.meta.url)), DIST, zip]);
  for (const [name, bytes] of Object.entries(unzipSync(readFileSync(zip)))) {
    const path = join(folder, name);
    mkdirSync(dirname(path), { recursive: true });
    writeFileSync(path, edited(name, bytes));
  }
}
