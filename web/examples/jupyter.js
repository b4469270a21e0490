// The part of a notebook: a model with traits, and the module's render.

import module from '../slam-anywidget.js';

const traits = { name: 'w16.2', value: { noise: 2 }, outcome: null };
const callbacks = new Map();

const model = {
  get: (trait) => traits[trait],
  set: (trait, value) => (traits[trait] = value),
  save_changes: () => {},
  on: (event, callback) => callbacks.set(event, callback),
  off: (event) => callbacks.delete(event),
};

/** What `lap.value = {...}` does in Python. */
window.assign = (value) => {
  traits.value = value;
  callbacks.get('change:value')?.();
};
window.traits = traits;
window.unmount = module.render({ model, el: document.querySelector('#cell') });
