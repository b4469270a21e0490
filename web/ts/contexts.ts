// Who draws: browsers take the oldest WebGL context away beyond sixteen, so widgets share fewer.
//
// The reader's eye decides: what has the focus or the pointer first, then what is next to the middle
// of the screen. Who has to wait shows a picture.

/** Contexts at most, of widgets that draw or begin to. */
const MOST = 8;

export interface Drawer {
  /** How far it is from where the reader looks, in CSS pixels. */
  readonly distance: number;
  /** Gives its context to another one. */
  yield(): void;
  /** Asks again, where it still wants a context. */
  askAgain(): void;
}

const holding = new Set<Drawer>();
const waiting = new Set<Drawer>();

/** Takes a context, from who is farthest away where all are taken; false where that is the one who asks. */
export function claim(drawer: Drawer): boolean {
  waiting.delete(drawer);
  if (holding.has(drawer)) return true;
  if (holding.size >= MOST) {
    const farthest = [...holding].reduce((far, other) => (other.distance > far.distance ? other : far));
    if (farthest.distance <= drawer.distance) {
      waiting.add(drawer);
      return false;
    }
    holding.delete(farthest);
    farthest.yield();
    waiting.add(farthest);
  }
  holding.add(drawer);
  return true;
}

/** Gives a context back, or wants none any more. */
export function release(drawer: Drawer): void {
  waiting.delete(drawer);
  if (holding.delete(drawer)) lookAgain();
}

/** The reader looks elsewhere: who waits asks again, the nearest first. */
export function lookAgain(): void {
  for (const drawer of [...waiting].sort((a, b) => a.distance - b.distance)) drawer.askAgain();
}
