// The native build in turns: `slam2d_bench turns` answers each line with a line.

import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';

/** Starts the program; `turn` runs a workload for some milliseconds and returns its time. */
export function native(program) {
  const child = spawn(program, ['turns'], { stdio: ['pipe', 'pipe', 'inherit'] });
  const answers = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  return {
    async turn(id, ms) {
      child.stdin.write(`${id} ${ms}\n`);
      const { value, done } = await answers.next();
      if (done) throw new Error(`${program} ended at the workload ${id}`);
      return JSON.parse(value);
    },
    close: () => child.stdin.end(),
  };
}
