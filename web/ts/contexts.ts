// Distributes WebGL contexts: browsers discard the oldest one beyond sixteen, so widgets share fewer.
//
// The reader's attention decides: the widget with the focus or the pointer comes first, then those next to
// the middle of the screen. The others show a picture.

/** Largest number of contexts of widgets that draw or start to. */
const MOST = 8;

export interface Drawer {
  /** Distance from the reader's attention, in CSS pixels. */
  readonly distance: number;
  /** Gives its context to another widget. */
  yield(): void;
  /** Requests a context again, if it still needs one. */
  askAgain(): void;
}

const holding = new Set<Drawer>();
const waiting = new Set<Drawer>();

/** Takes a context, if necessary from the farthest widget; returns false if that is the requesting one. */
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

/** Releases a context, or withdraws a request. */
export function release(drawer: Drawer): void {
  waiting.delete(drawer);
  if (holding.delete(drawer)) lookAgain();
}

/** Lets waiting widgets request again after the reader has moved, the nearest first. */
export function lookAgain(): void {
  for (const drawer of [...waiting].sort((a, b) => a.distance - b.distance)) drawer.askAgain();
}
