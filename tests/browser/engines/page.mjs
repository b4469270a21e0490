// What the tests ask of a page in any engine: scripts in the page that wait for a state, and clicks by a real pointer.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

/** The script that records a page's errors; the server puts it before everything else. */
export const WATCH = '/engine-watch.js';
export const WATCH_TEXT = readFileSync(fileURLToPath(new URL('watch.js', import.meta.url)), 'utf8');

/** A page as text, with the recorder of its errors first. */
export function watched(html) {
  return html.replace(/<head>|<meta charset/, (first) => (first === '<head>' ? `${first}<script src="${WATCH}"></script>` : `<script src="${WATCH}"></script>${first}`));
}

/** Calls a function in the page with arguments of JSON. */
export function ask(page, call, ...given) {
  return page.evaluate(`(${call})(...${JSON.stringify(given)})`);
}

/** Ends a hang, and decides nothing else. */
const HANG_MS = 150_000;

/** Waits until a function in the page returns something; returns that. */
export function until(page, condition, ...given) {
  return page.evaluate(`(async () => {
    const condition = ${condition};
    const end = Date.now() + ${HANG_MS};
    for (;;) {
      if (Date.now() > end) throw new Error('not in time: ' + ${JSON.stringify(String(condition))} + ${JSON.stringify(JSON.stringify(given))});
      const found = await condition(...${JSON.stringify(given)});
      if (found) return found;
      await new Promise((resolve) => setTimeout(resolve, 40));
    }
  })()`);
}

/** Waits until a page has loaded and knows the element. */
export function loaded(page) {
  return until(page, () => document.readyState === 'complete' && customElements.get('slam-widget') !== undefined);
}

/** Waits until a widget shows its first frame; fails with the sentence that stands in its place. */
export async function live(page, id) {
  const state = await until(page, (name) => {
    const widget = document.querySelector(`slam-widget[name="${name}"]`);
    const { shadowRoot } = widget;
    return shadowRoot.querySelector('.failure:not(.late) p')?.textContent ?? (shadowRoot.querySelector('.stage.live') !== null && 'live');
  }, id);
  if (state !== 'live') assert.fail(`${id}: ${state} ${JSON.stringify(await troublesOf(page))}`);
}

/** Clicks what a function in the page finds, with the pointer, once it rests and nothing covers it; again if it moved away. */
export async function click(page, find, ...given) {
  for (;;) {
    const [x, y] = await until(page, `(...given) => {
      const found = (${find})(...given);
      if (!found) return false;
      found.scrollIntoView({ behavior: 'instant', block: 'center' });
      const { left, top, width, height } = found.getBoundingClientRect();
      const [x, y] = [left + width / 2, top + height / 2];
      const isResting = window.lastClick?.found === found && window.lastClick.x === x && window.lastClick.y === y;
      window.lastClick = { found, x, y };
      if (!isResting || width === 0 || !found.contains(found.getRootNode().elementFromPoint(x, y))) return false;
      // WebKit tells of no click if the target moved between press and release.
      document.addEventListener('mouseup', () => {
        let hit = false;
        const note = (event) => { hit = event.composedPath().includes(found); };
        document.addEventListener('click', note, true);
        setTimeout(() => {
          document.removeEventListener('click', note, true);
          window.lastClick = { hit };
        });
      }, { capture: true, once: true });
      return [x, y];
    }`, ...given);
    await page.move(x, y);
    await page.down();
    await page.up();
    const hit = await until(page, () => window.lastClick.hit !== undefined && [window.lastClick.hit]);
    if (hit[0]) return;
  }
}

/** Clicks a control of a widget by its id. */
export function clickControl(page, widget, control) {
  return click(page, (name, id) => document.querySelector(`slam-widget[name="${name}"]`).shadowRoot.querySelector(`button[data-control="${id}"]`), widget, control);
}

/** Clicks the button with that text. */
export function clickButton(page, text) {
  return click(page, (wanted) => [...document.querySelectorAll('button')].find(({ textContent }) => textContent.startsWith(wanted)), text);
}

/** The errors of a page. */
export function troublesOf(page) {
  return ask(page, () => window.troubles);
}
