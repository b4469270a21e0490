// A pool of WebGL contexts. Browsers discard the oldest context beyond sixteen, so widgets share fewer.
//
// The widget with focus or pointer has priority, then those closest to the middle of the viewport. The others show
// a picture.

/** Shorter side of the largest phone, CSS pixels. */
const PHONE_PX = 600;
/** Widgets that may have a context at a time; docs/performance.md says what each takes of a phone's memory. */
const MAX_CONTEXTS = Math.min(screen.width, screen.height) < PHONE_PX ? 4 : 8;

export interface Drawer {
  /** Distance from the middle of the viewport, in CSS pixels; zero with focus or pointer. */
  readonly distance: number;
  /** Gives up the context, which another widget needs. */
  yield(): void;
  /** Claims a context again, if one is still needed. */
  retry(): void;
}

const holding = new Set<Drawer>();
const waiting = new Set<Drawer>();

/** Claims a context, if necessary from the farthest widget; returns false if `drawer` itself is the farthest. */
export function claim(drawer: Drawer): boolean {
  waiting.delete(drawer);
  if (holding.has(drawer)) return true;
  if (holding.size >= MAX_CONTEXTS) {
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

/** Releases a context, or withdraws a claim. */
export function release(drawer: Drawer): void {
  waiting.delete(drawer);
  if (holding.delete(drawer)) retryWaiting();
}

/** Lets waiting widgets claim again, the nearest first. */
export function retryWaiting(): void {
  for (const drawer of [...waiting].sort((a, b) => a.distance - b.distance)) drawer.retry();
}
