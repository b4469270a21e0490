// The reader's best win in each room of the matcher, kept in this browser.

/** A win: seconds from the first touch until ICP was home, and how far from the truth, cm. */
export interface Win {
  seconds: number;
  cm: number;
}

const STORAGE_KEY = 'slam-match-records';

/** Takes a win into account; returns the best one in that room, the faster and then the nearer. */
export function recordOf(room: string, win: Win): Win {
  const best = kept();
  const before = best[room];
  const isBetter = before === undefined || win.seconds < before.seconds || (win.seconds === before.seconds && win.cm < before.cm);
  if (!isBetter) return before;
  try {
    localStorage.setItem(STORAGE_KEY, JSON.stringify({ ...best, [room]: win }));
  } catch {
    // It lasts until the next win.
  }
  return win;
}

function kept(): Record<string, Win> {
  try {
    const read = JSON.parse(localStorage.getItem(STORAGE_KEY) ?? '{}') as Record<string, Partial<Win>>;
    const isWin = (one: [string, Partial<Win>]): one is [string, Win] => Number.isFinite(one[1].seconds) && Number.isFinite(one[1].cm);
    return Object.fromEntries(Object.entries(read).filter(isWin));
  } catch {
    return {};
  }
}
