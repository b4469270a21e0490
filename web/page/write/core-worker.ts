// The core beside a reader's function, in the sandboxed worker: it calls the function synchronously. Bundled as a classic
// script of its own, because the worker's text is put together from the reader's code and this.

import init, { ReaderCode } from '../../pkg-robot/slam_robot.js';

/** Executes an order of a widget; `working` is called between its pieces. */
export type Executor = (order: string, working: () => void) => Float64Array;

/** Starts the module without egui, which has the core, with that function in its seams. */
export async function start(program: ArrayBuffer, name: string, written: (...given: unknown[]) => unknown): Promise<Executor> {
  await init({ module_or_path: program });
  const driver = new ReaderCode(name, written);
  return (order, working) => {
    driver.begin(order);
    for (;;) {
      const answers = driver.step();
      if (answers !== undefined) return answers;
      working();
    }
  };
}
