// Chromium through Playwright: that of run.mjs, if it runs.

import { LAST_RESORT_MS, launch } from '../chromium.mjs';

/** Opens Chromium with one page. */
export async function openChromium() {
  const browser = await launch();
  const context = await browser.newContext();
  context.setDefaultTimeout(LAST_RESORT_MS);
  context.setDefaultNavigationTimeout(LAST_RESORT_MS);
  const page = await context.newPage();
  return {
    goto: (url) => page.goto(url),
    back: () => page.goBack(),
    evaluate: (source) => page.evaluate(source),
    move: (x, y) => page.mouse.move(x, y),
    down: () => page.mouse.down(),
    up: () => page.mouse.up(),
    press: (key) => page.keyboard.press(key),
    resize: (width, height) => page.setViewportSize({ width, height }),
    screenshot: () => page.screenshot(),
    close: async () => {
      await context.close();
      await browser.close();
    },
  };
}
