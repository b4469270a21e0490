// The published wasm in Node, and its results: computed once for all tests of a process.

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { createGlue } from '../../web/pkg/glue.js';

export const ROOT = fileURLToPath(new URL('../../', import.meta.url));

export const wasm = createGlue();
wasm.initSync({ module: readFileSync(`${ROOT}web/pkg/slam_web_bg.wasm`) });

/** The widgets' schema. */
export const schema = JSON.parse(wasm.widgetSchemas());

const afterPresets = new Map();

/** State and results of a widget after each of its presets, a line of JSON each. */
export function afterEachPreset(id) {
  if (!afterPresets.has(id)) afterPresets.set(id, wasm.afterEachPreset(id));
  return afterPresets.get(id);
}
