// The native programs of the workspace, for tests that compare with their output.

import { execFileSync } from 'node:child_process';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const ROOT = fileURLToPath(new URL('../', import.meta.url));

/**
 * The output of a native program of the workspace. The suite passes the folder of the compiled programs;
 * without it cargo compiles them first.
 */
export function native(program, ...words) {
  const options = { cwd: ROOT, encoding: /** @type {const} */ ('utf8'), maxBuffer: 1 << 28 };
  const compiled = process.env.SLAM_NATIVE;
  if (compiled !== undefined) return execFileSync(join(compiled, program), words, options);
  return execFileSync('cargo', ['run', '--quiet', '--bin', program, '--', ...words], options);
}
