// An instance of the module: with frames for a widget, or without frames for figures of the page.

import { createGlue, type Glue } from '../pkg/glue.js';
import { observerOf, windowOf, type FrameSource } from './glue-scope';
import { forgetModule, loadModule, startProblem } from './module';

/** The compiled module, for example for a worker. */
export function coreModule(progress: (share: number) => void = () => {}): Promise<WebAssembly.Module> {
  return loadModule(progress);
}

/** An instance without a widget. */
export async function core(frames?: FrameSource, progress?: (share: number) => void): Promise<Glue> {
  const module = await coreModule(progress);
  const glue = frames === undefined ? createGlue() : createGlue(windowOf(frames), observerOf(frames));
  try {
    await glue({ module_or_path: module });
    return glue;
  } catch (error) {
    forgetModule();
    throw startProblem(error);
  }
}
