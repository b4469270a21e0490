// Shared by the measurements in Chromium: the description of the machine, and statistics of times.

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { cpus, platform } from 'node:os';
import { forTimes } from '../browser/chromium.mjs';

/** Processor, system and browser, as in a table. */
export function machine() {
  const browser = execFileSync(forTimes(), ['--version'], {
    encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'],
  });
  return `${processor()}, ${cpus().length} cores, ${platform()}, ${browser.trim()}, WebGL by software`;
}

function processor() {
  try {
    return readFileSync('/proc/cpuinfo', 'utf8').match(/^model name\s*: (.*)$/m)?.[1] ?? process.arch;
  } catch {
    return process.arch;
  }
}

/** The quantile of a share; at 0.5 the median. */
export function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)];
}
