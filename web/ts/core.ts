// An instance of the module: with frames for a widget, or without frames for figures of the page.

import { createGlue, type FrameSource, type Glue } from '../pkg/glue.js';
import { forgetModule, loadModule, StaleError } from './module';

const NO_FRAMES: FrameSource = {
  request: () => 0,
  cancel: () => {},
  pixelRatio: () => 1,
  deviceSize: () => [],
};

/** The compiled module, for example for a worker. */
export function coreModule(progress: (share: number) => void = () => {}): Promise<WebAssembly.Module> {
  return loadModule(progress);
}

/** An instance without a widget. */
export async function core(frames = NO_FRAMES, progress?: (share: number) => void): Promise<Glue> {
  const module = await coreModule(progress);
  const glue = createGlue(frames);
  try {
    await glue({ module_or_path: module });
    return glue;
  } catch {
    forgetModule();
    throw new StaleError();
  }
}
