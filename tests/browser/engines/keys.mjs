// Keys as WebDriver writes them; a character is itself.

const KEYS = {
  Tab: '\uE004', Enter: '\uE007', Escape: '\uE00C', End: '\uE010', Home: '\uE011',
  ArrowLeft: '\uE012', ArrowUp: '\uE013', ArrowRight: '\uE014', ArrowDown: '\uE015',
};

/** The actions of a pointer or of a key, in the words of WebDriver and of its successor BiDi. */
export const actions = {
  move: (x, y) => mouse({ type: 'pointerMove', duration: 0, origin: 'viewport', x: Math.round(x), y: Math.round(y) }),
  down: () => mouse({ type: 'pointerDown', button: 0 }),
  up: () => mouse({ type: 'pointerUp', button: 0 }),
  press: (key) => {
    const value = KEYS[key] ?? key;
    return [{ type: 'key', id: 'keys', actions: [{ type: 'keyDown', value }, { type: 'keyUp', value }] }];
  },
};

function mouse(action) {
  return [{ type: 'pointer', id: 'mouse', parameters: { pointerType: 'mouse' }, actions: [action] }];
}
