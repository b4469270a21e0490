// Touch input.
//
// Chromium acknowledges a touch before a busy page has processed it, and a touch that begins and ends between two frames
// has no effect. So each touch here waits until the page has processed it.

/** The pointer event of each touch. */
const FELT = { touchStart: 'pointerdown', touchMove: 'pointermove', touchEnd: 'pointerup', touchCancel: 'pointercancel' };

/**
 * Touch input for a tab: `touch(type, spots)` dispatches a touch event with one finger for each spot `[x, y]`, and `felt()`
 * lists the pointer events that the page got. If a finger scrolls the page, its touch is cancelled.
 */
export async function fingers(tab) {
  const session = await tab.context().newCDPSession(tab);
  const events = await tab.evaluateHandle((types) => {
    const heard = [];
    for (const type of types) addEventListener(type, () => heard.push(type), true);
    return heard;
  }, Object.values(FELT));
  return {
    async touch(type, spots = []) {
      const before = await events.evaluate((heard) => heard.length);
      await session.send('Input.dispatchTouchEvent', { type, touchPoints: spots.map(([x, y], id) => ({ x, y, id })) });
      await tab.waitForFunction(
        ([heard, named, from]) => heard.includes(named, from) || (named !== 'pointerdown' && heard.at(-1) === 'pointercancel'),
        [events, FELT[type], before],
      );
    },
    felt: () => events.jsonValue(),
  };
}
