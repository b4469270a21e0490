// A property and an attribute for every parameter of every widget.

import { SlamWidget } from './element';
import { allParamIds } from './schema';
import type { Value } from './values';

for (const id of allParamIds()) {
  SlamWidget.observedAttributes.push(id);
  const property = id.replace(/[-_]([a-z])/g, (_, letter: string) => letter.toUpperCase());
  for (const name of new Set([id, property])) {
    Object.defineProperty(SlamWidget.prototype, name, {
      configurable: true,
      enumerable: true,
      get(this: SlamWidget): Value | undefined {
        return this.get(id);
      },
      set(this: SlamWidget, value: Value) {
        this.set(id, value);
      },
    });
  }
}
