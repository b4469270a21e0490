// The oldest browsers are declared once: every sentence names the same ones, and scripts, styles and WebAssembly use nothing
// that one of them lacks by MDN's compatibility data, beside a list of exceptions with their fallbacks.

import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { describe, it } from 'node:test';
import { oldestBrowsers, oldestVersions } from '../../web/browsers.mjs';

const data = createRequire(new URL('../../web/package.json', import.meta.url))('@mdn/browser-compat-data');
const DIST = new URL('../../dist/', import.meta.url);
const OLDEST = oldestVersions();

/** Features that some of the browsers lack, and what happens there. */
const EXCEPTIONS = {
  'AbortSignal.timeout': 'Chrome before 124 gives its error another name, which nobody reads',
  ClipboardItem: 'eframe copies pictures with it, which no widget does',
  Touch: 'Safari on a Mac cannot construct one: touchStart in web/ts/touch.ts sends an event with the same properties',
  TouchEvent: 'the same',
  'Symbol.dispose': 'wasm-bindgen asks for it first',
  ':popover-open': 'web/page/popovers.ts shows the lines of the notation',
  '@property': 'an embedded widget keeps its own height',
  'accent-color': 'Safari has it, with some contrasts off; the colour is only ornament',
  'content-visibility': 'the whole page is laid out at once',
  'text-size-adjust': 'a phone may enlarge texts',
  'text-wrap': 'lines break as they come',
};

const older = (one, other) => {
  const [a, b] = [one, other].map((version) => version.replace('≤', '').split('.').map(Number));
  for (let at = 0; at < Math.max(a.length, b.length); at += 1) if ((a[at] ?? 0) !== (b[at] ?? 0)) return (a[at] ?? 0) < (b[at] ?? 0);
  return false;
};

/** The browsers that lack what an entry of the data describes. */
function lacking(entry) {
  const { support } = entry.__compat;
  return Object.entries(OLDEST).filter(([browser, version]) => {
    const all = [support[browser]].flat().filter(Boolean);
    // What is behind a flag is not there; a prefix is another name.
    const added = all.filter((one) => one.flags === undefined && typeof one.version_added === 'string' && one.version_removed === undefined);
    return !added.some((one) => one.version_added !== 'preview' && !older(version, one.version_added));
  }).map(([browser]) => browser);
}

/** Fails with what the oldest browsers lack. */
function allSupported(found) {
  const missing = [...found].filter(([, entries]) => entries.length > 0 && entries.every((entry) => lacking(entry).length > 0))
    .filter(([name]) => EXCEPTIONS[name] === undefined).map(([name, [entry]]) => `${name} in ${lacking(entry)}`);
  assert.deepEqual(missing.sort(), []);
}

const files = (end) => readdirSync(DIST).filter((file) => file.endsWith(end) && !file.startsWith('katex')).map((file) => readFileSync(new URL(file, DIST), 'utf8'));
const compat = (entry) => (entry?.__compat === undefined ? [] : [entry]);
const words = (text, pattern) => new Set([...text.matchAll(pattern)].map(([, word]) => word));

describe('what the oldest browsers have', () => {
  it('is named alike in README, docs/embedding.md and the pages', () => {
    for (const file of ['README.md', 'docs/embedding.md', 'dist/embed.html', 'dist/index.html']) {
      const text = readFileSync(new URL(`../../${file}`, import.meta.url), 'utf8').replace(/\s+/g, ' ');
      assert.ok(text.includes(oldestBrowsers()), `${file} does not name ${oldestBrowsers()}`);
    }
  });

  it('suffices for the instructions of the module', () => {
    const NAMES = {
      'bulk-memory': 'bulk-memory-operations', 'bulk-memory-opt': 'bulk-memory-operations', multivalue: 'multi-value',
      'nontrapping-fptoint': 'non-trapping-float-to-int-conversions',
      'reference-types': 'reference-types', 'sign-ext': 'sign-extension-operations', simd128: 'fixed-width-SIMD',
      // An encoding that every engine accepts, and what was there from the first version with threads on.
      'call-indirect-overlong': undefined, 'mutable-globals': undefined,
    };
    const module = new WebAssembly.Module(readFileSync(new URL('../../web/pkg/slam_web_bg.wasm', import.meta.url)));
    const [section] = WebAssembly.Module.customSections(module, 'target_features');
    const used = Buffer.from(section).toString('latin1').match(/[a-z][a-z0-9-]{4,}/g);
    assert.ok(used.includes('simd128'), used.join());
    const unknown = used.filter((name) => !(name in NAMES) || (NAMES[name] !== undefined && data.webassembly[NAMES[name]] === undefined));
    assert.deepEqual(unknown, []);
    allSupported(used.filter((name) => NAMES[name] !== undefined).map((name) => [name, compat(data.webassembly[NAMES[name]])]));
  });

  it('suffices for the styles', () => {
    const shadow = readFileSync(new URL('../../web/ts/style.ts', import.meta.url), 'utf8');
    const css = [...files('.css'), shadow].join('\n');
    const found = [
      ...[...words(css, /[{;\s]([a-z][a-z-]+):/g)].map((name) => [name, compat(data.css.properties[name])]),
      ...[...words(css.replace(/\{[^{}]*\}/g, '{}'), /(?<!:):([a-z][a-z-]+)/g)].map((name) => [`:${name}`, compat(data.css.selectors[name])]),
      ...[...words(css, /@([a-z][a-z-]+)/g)].map((name) => [`@${name}`, compat(data.css['at-rules'][name])]),
    ];
    assert.ok(found.some(([name, entries]) => name === ':has' && entries.length > 0));
    allSupported(found);
    // Only Safari has it, and lays the punctuation after a formula over the formula.
    assert.doesNotMatch(css, /hanging-punctuation/);
  });

  // TypeScript's library is the limit of other members.
  it('suffices for the scripts: globals with their static members', () => {
    const script = files('.js').join('\n');
    const { api, javascript: { builtins } } = data;
    const globalOf = (name) => (Object.hasOwn(api, name) ? api[name] : Object.hasOwn(builtins, name) ? builtins[name] : undefined);
    const staticOf = (path) => {
      const [name, member] = path.split('.');
      const owner = globalOf(name);
      return compat(owner?.[`${member}_static`] ?? owner?.[member]);
    };
    const found = [
      ...[...words(script, /\bnew ([A-Z]\w+)/g)].map((name) => [name, compat(globalOf(name))]),
      ...[...words(script, /(?<![.\w])([A-Z]\w+\.[a-z]\w+)/g)].map((path) => [path, staticOf(path)]),
    ];
    for (const known of ['BroadcastChannel', 'AbortSignal.timeout']) {
      assert.ok(found.some(([name, entries]) => name === known && entries.length > 0), known);
    }
    allSupported(found);
  });
});
