// The dependencies of this project, from cargo and npm.

import { execFileSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const ROOT = fileURLToPath(new URL('../../', import.meta.url));
const TARGET = 'wasm32-unknown-unknown';

function run(program, ...words) {
  return execFileSync(program, words, { cwd: ROOT, encoding: 'utf8', maxBuffer: 1 << 28 });
}

/** `CARGO` is set if cargo started this script. */
const cargo = (...words) => run(process.env.CARGO ?? 'cargo', ...words);

/** All external crates of a workspace, for every target, including tests and tools. */
export function cratesOf(manifest, ...filter) {
  const metadata = cargo('metadata', '--format-version', '1', '--manifest-path', manifest, ...filter);
  return JSON.parse(metadata)
    .packages.filter((crate) => crate.source !== null)
    .map((crate) => ({
      name: crate.name,
      version: crate.version,
      licence: crate.license,
      repository: crate.repository ?? '',
      url: `https://crates.io/crates/${crate.name}/${crate.version}`,
      folder: path.dirname(crate.manifest_path),
    }));
}

/**
 * The external crates in a WebAssembly module, `slam_web` or `slam_robot`, without procedural macros.
 *
 * `cargo metadata` unites the features of all members, and so lists crates that are not in the module; `cargo tree`
 * resolves the features of one package.
 */
export function cratesOfModule(name) {
  const tree = cargo('tree', '--package', name, '--target', TARGET, '--edges', 'normal,no-proc-macro',
    '--prefix', 'none', '--format', '{p}');
  const inside = new Set(tree.split('\n').map((line) => line.match(/^(\S+) v(\S+)/)?.slice(1).join(' ')));
  const all = cratesOf('Cargo.toml', '--filter-platform', TARGET);
  return all.filter(({ name, version }) => inside.has(`${name} ${version}`));
}

/** The version of the standard library. */
export function rustVersion() {
  return run('rustc', '--version').split(' ')[1];
}

/** All npm packages of a lock file, for every system. */
export async function npmPackagesOf(folder) {
  const lock = JSON.parse(await readFile(path.join(ROOT, folder, 'package-lock.json'), 'utf8'));
  return Object.entries(lock.packages)
    .filter(([place]) => place !== '')
    .map(([place, { version, license }]) => ({ name: place.replace(/^.*node_modules\//, ''), version, licence: license }));
}

/** The npm packages in bundles of esbuild, from their metafiles. */
export async function npmPackagesIn(...metafiles) {
  const folders = new Set();
  for (const input of metafiles.flatMap((metafile) => Object.keys(metafile.inputs))) {
    const folder = input.match(/^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//)?.[1];
    if (folder !== undefined) folders.add(path.resolve(folder));
  }
  return Promise.all([...folders].sort().map(npmPackage));
}

/** An installed npm package. */
export async function npmPackage(folder) {
  const { name, version, license } = JSON.parse(await readFile(path.join(folder, 'package.json'), 'utf8'));
  return { name, version, licence: license, repository: '', url: `https://www.npmjs.com/package/${name}/v/${version}`, folder };
}

/** The manifests of the cargo workspaces: the fuzz targets have a separate one. */
export function workspaces() {
  return ['Cargo.toml', 'fuzz/Cargo.toml'].filter((manifest) => existsSync(path.join(ROOT, manifest)));
}
