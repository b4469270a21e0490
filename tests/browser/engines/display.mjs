// A screen without a monitor: Firefox has WebGL in a window only, and WebKit's browser needs a window.

import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { delimiter, join } from 'node:path';

/** The path of a program; undefined if there is none. */
export function pathOf(...names) {
  const folders = (process.env.PATH ?? '').split(delimiter);
  return names.flatMap((name) => folders.map((folder) => join(folder, name))).find((path) => existsSync(path));
}

/** How to get what is missing on Debian. */
export const HOW = 'sudo apt-get install firefox-esr webkit2gtk-driver xvfb libpci3 libgl1-mesa-dri';

/** Starts Xvfb on the first free number; returns the variables for programs on it, and a function that ends it. */
export async function openDisplay() {
  const server = spawn('Xvfb', ['-displayfd', '3', '-screen', '0', '1600x2400x24', '-nolisten', 'tcp'], {
    stdio: ['ignore', 'ignore', 'ignore', 'pipe'],
  });
  const number = await new Promise((resolve, reject) => {
    server.once('error', reject);
    server.once('exit', (code) => reject(new Error(`Xvfb ended with ${code}`)));
    server.stdio[3].once('data', (digits) => resolve(Number(digits)));
  });
  // Several threads of a software renderer only disturb each other beside the suite.
  const env = { ...process.env, DISPLAY: `:${number}`, LIBGL_ALWAYS_SOFTWARE: '1', LP_NUM_THREADS: '1' };
  return { env, close: () => ended(server) };
}

/** Ends a program that we started; resolves once it has ended. */
export function ended(child) {
  if (child.exitCode !== null || child.signalCode !== null) return Promise.resolve();
  const gone = new Promise((resolve) => child.once('exit', resolve));
  child.kill('SIGTERM');
  const stubborn = setTimeout(() => child.kill('SIGKILL'), 5000);
  return gone.then(() => clearTimeout(stubborn));
}
