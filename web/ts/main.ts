// Defines <slam-widget>: the only module that a page has to load.

import { SlamWidget } from './element';
import './properties';
import { installLinks } from './page-links';

export type { Outcome, Timeline, TimelineMark, CsvFile } from './instance';
export type { Value } from './values';
export { SlamWidget };
export { widgets } from './schema';
export { core, coreModule } from './core';
export { coreBytes, type Driver } from './driver';

if (customElements.get('slam-widget') === undefined) {
  customElements.define('slam-widget', SlamWidget);
  installLinks();
}
