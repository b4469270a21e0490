// The parts of a page that a command generates, between two comments.

import { readFile, writeFile } from 'node:fs/promises';

/** Replaces the text between `<!-- NAME: … -->` and `<!-- end of NAME -->`. */
export async function writeMarked(page, name, text) {
  const old = await readFile(page, 'utf8');
  const marked = new RegExp(`(<!-- ${name}: [^>]*-->\\n)[\\s\\S]*?(<!-- end of ${name} -->)`);
  if (!marked.test(old)) throw new Error(`${page} has no place named ${name}`);
  const updated = old.replace(marked, (_, begin, end) => `${begin}${text}\n${end}`);
  if (updated !== old) await writeFile(page, updated);
}
