// Fingers on the glass of a page.
//
// Chromium acknowledges a touch before a busy page has processed it, and a touch that begins and ends between
// two frames has no effect. So each touch here ends once the page has processed it.

/** The pointer event of each touch. */
const FELT = { touchStart: 'pointerdown', touchMove: 'pointermove', touchEnd: 'pointerup', touchCancel: 'pointercancel' };

/**
 * Fingers for a tab: `touch(type, spots)` sends a touch with each finger that is down at a spot `[x, y]`,
 * and `felt()` lists the events that the page got. A finger that scrolls the page is cancelled, and its
 * later events do not arrive.
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
