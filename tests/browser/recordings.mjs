// Files for w16.10, and what it says of them.

/** Passes a file with those bytes to the widget, with its purpose. */
export const giveBytes = (tab, name, bytes, use) => tab.evaluate(([file, text, what]) => {
  const content = Uint8Array.from(atob(text), (digit) => digit.charCodeAt(0));
  document.querySelector('slam-widget').openFile(new File([content], file), what);
}, [name, Buffer.from(bytes).toString('base64'), use]);

/** Waits until the result matches; the regular expression applies to the verdict and the sentence. */
export const says = (tab, pattern) => tab.waitForFunction((source) => {
  const { verdict, sentence } = document.querySelector('slam-widget').outcome ?? {};
  return new RegExp(source).test(`${verdict}: ${sentence}`);
}, pattern.source);

/** Waits until a recording is mapped. */
export const isMapped = (tab) => says(tab, /^(mapped|[^:]*in doubt):/);
