// The Python wheel as users get it, for tests that need a Python with other packages.

import { execFileSync } from 'node:child_process';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const ROOT = fileURLToPath(new URL('../', import.meta.url));
export const PYTHON = process.env.PYTHON ?? 'python3';

/** Why a test that needs these modules cannot run; undefined if they are installed. */
export function without(...modules) {
  const missing = modules.filter((module) => !has(module));
  if (missing.length === 0) return undefined;
  return `${PYTHON} has no ${missing.join(', no ')}; pip install ${modules.join(' ')}, and name it by PYTHON`;
}

function has(module) {
  try {
    execFileSync(PYTHON, ['-c', `import ${module}`], { stdio: 'ignore' });
    return true;
  } catch {
    return false;
  }
}

/**
 * Packs dist/ into `folder`, and installs the wheel there: the names of the packages, and the folder to
 * import from.
 */
export function install(folder) {
  const packages = join(folder, 'packages');
  execFileSync('node', [join(ROOT, 'web', 'package.mjs'), join(ROOT, 'dist'), packages], { cwd: ROOT, stdio: 'ignore' });
  const files = readdirSync(packages).sort();
  const wheel = files.find((file) => file.endsWith('.whl'));
  const site = join(folder, 'site');
  const pip = ['-m', 'pip', 'install', '--quiet', '--no-deps', '--no-index', '--target', site];
  execFileSync(PYTHON, [...pip, join(packages, wheel)], { stdio: 'ignore' });
  return { files, site };
}
