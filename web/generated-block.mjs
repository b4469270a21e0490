// Generated blocks of documents, between two comments.

import { readFile, writeFile } from 'node:fs/promises';

/** Replaces the text between `<!-- NAME: … -->` and `<!-- end of NAME -->`. */
export async function writeGeneratedBlock(page, name, text) {
  const old = await readFile(page, 'utf8');
  const block = new RegExp(`(<!-- ${name}: [^>]*-->\\n)[\\s\\S]*?(<!-- end of ${name} -->)`);
  if (!block.test(old)) throw new Error(`${page} has no generated block named ${name}`);
  const updated = old.replace(block, (_, begin, end) => `${begin}${text}\n${end}`);
  if (updated !== old) await writeFile(page, updated);
}
