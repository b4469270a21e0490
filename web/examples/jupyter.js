// Stands in for a notebook: a model with traits that renders the module.

import module from '../slam-anywidget.js';

const traits = { name: 'w16.2', value: { noise: 2 }, outcome: null };
const callbacks = new Map();

const model = {
  get: (trait) => traits[trait],
  /** Like a notebook, it also calls back for values that the widget writes. */
  set: (trait, value) => {
    traits[trait] = value;
    callbacks.get(`change:${trait}`)?.();
  },
  save_changes: () => {},
  on: (event, callback) => callbacks.set(event, callback),
  off: (event) => callbacks.delete(event),
};

/** The effect of `lap.value = {...}` in Python. */
window.assign = (value) => model.set('value', value);
window.traits = traits;
/** Runs the cell. */
window.mount = () => (window.unmount = module.render({ model, el: document.querySelector('#cell') }));
window.mount();
