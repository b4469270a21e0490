// node web/fallback.mjs DIST: puts a picture and a sentence into every widget of the finished page,
// for readers whose browser runs no script at all. The element hides them where it runs.

import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';

const [dist] = process.argv.slice(2);
if (dist === undefined) throw new Error('usage: node web/fallback.mjs DIST');

const schema = JSON.parse(await readFile(join(dist, 'schema.json'), 'utf8'));
const path = join(dist, 'index.html');
const page = await readFile(path, 'utf8');
await writeFile(path, page.replace(/(<slam-widget\b[^>]*>)\s*(<\/slam-widget>)/g, withFallback));

function withFallback(whole, open, close) {
  const name = open.match(/\bname="([^"]*)"/)?.[1];
  const widget = schema.find(({ id }) => id === name);
  if (widget === undefined) throw new Error(`the page has a widget ${name} that does not exist`);
  return `${open}
<picture>
  <source srcset="pictures/${name}-dark.svg" media="(prefers-color-scheme: dark)">
  <img src="pictures/${name}-light.svg" alt="${escape(widget.summary)}" loading="lazy" style="max-width: 100%">
</picture>
<p>This is a still picture of ${escape(widget.title)}: the widget needs JavaScript and WebAssembly.</p>
${close}`;
}

function escape(text) {
  return text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;');
}
