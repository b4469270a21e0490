// The npm package as users get it: packed from dist/, installed into a folder from the archive.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import * as h from './harness.mjs';

/** A folder with a project that has the package; `remove` deletes it. */
export function installPackage() {
  const folder = mkdtempSync(join(tmpdir(), 'slam-package-'));
  const npm = (...args) => execFileSync('npm', args, { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'] });
  writeFileSync(join(folder, 'package.json'), JSON.stringify({ private: true, type: 'module' }));
  npm('pack', h.DIST, '--ignore-scripts');
  const archive = readdirSync(folder).find((file) => file.endsWith('.tgz'));
  npm('install', `./${archive}`, '--offline', '--ignore-scripts', '--no-audit', '--no-fund');
  return {
    folder,
    installed: join(folder, 'node_modules', 'slam-widgets'),
    remove: () => rmSync(folder, { recursive: true }),
  };
}
