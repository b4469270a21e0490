// Disables scaling: a transform would blur the canvas and shift the pointer.

import Reveal from './reveal/reveal.mjs';

const deck = new Reveal({ width: 1060, height: 700, minScale: 1, maxScale: 1, hash: true });
window.deck = deck.initialize().then(() => deck);
