// Tests that cannot run here: they are listed as skipped, and fail if skipping is not allowed. The protocol
// is that of tests/src/skip.rs: SLAM_NO_SKIP forbids skipping, SLAM_SKIPPED names the list.

import { appendFileSync } from 'node:fs';

/** Skips the running test `context` of node:test; the test returns after it. */
export function skip(context, reason) {
  if (!['', '0', 'false'].includes(process.env.SLAM_NO_SKIP ?? '')) {
    throw new Error(`${context.name}: ${reason}, and SLAM_NO_SKIP forbids skips`);
  }
  const list = process.env.SLAM_SKIPPED;
  if (list !== undefined) appendFileSync(list, `${context.name}: ${reason}\n`);
  context.skip(reason);
}
