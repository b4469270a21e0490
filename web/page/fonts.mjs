// The typefaces of the pages: one for text and one for labels, both variable, Latin only.

import { cp, mkdir } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';

/** The packages, each with its family, the property of the styles that names it, and its files by style. */
const FACES = [
  {
    package: '@fontsource-variable/source-serif-4', family: 'Source Serif 4', file: 'source-serif-4-latin-wght',
    styles: ['normal', 'italic'], weights: '200 900', property: '--text-font',
    fallback: 'Charter, "Bitstream Charter", "Sitka Text", Cambria, "Liberation Serif", serif',
  },
  {
    package: '@fontsource-variable/public-sans', family: 'Public Sans', file: 'public-sans-latin-wght',
    styles: ['normal'], weights: '100 900', property: '--label-font',
    fallback: 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", sans-serif',
  },
];
const LATIN = 'U+0000-00FF, U+0131, U+0152-0153, U+02BB-02BC, U+02C6, U+02DA, U+02DC, U+2000-206F, U+20AC, U+2122, U+2212';

const resolve = createRequire(import.meta.url).resolve;
const folderOf = (name) => path.dirname(resolve(`${name}/package.json`));

/** The folders of the packages, for the notices. */
export const FONT_FOLDERS = FACES.map((face) => folderOf(face.package));

/** Fetches the upright faces with the page, because a face that comes late is not used. */
export const FONT_PRELOADS = FACES.map(({ file }) =>
  `<link rel="preload" href="fonts/${file}-normal.woff2" as="font" type="font/woff2" crossorigin>`).join('\n');

/** Copies the files into `fonts/` of the site. Returns the rules that declare and name them. */
export async function copyFonts(outDir) {
  const target = path.join(outDir, 'fonts');
  await mkdir(target, { recursive: true });
  const rules = FACES.flatMap(({ package: name, family, file, styles, weights }) => styles.map(async (style) => {
    const font = `${file}-${style}.woff2`;
    await cp(path.join(folderOf(name), 'files', font), path.join(target, font));
    // Optional: a face that comes late must not move the text.
    return `@font-face{font-family:"${family}";font-style:${style};font-weight:${weights};font-display:optional;`
      + `src:url(fonts/${font}) format("woff2");unicode-range:${LATIN}}\n`;
  }));
  const names = FACES.map(({ property, family, fallback }) => `${property}:"${family}",${fallback}`);
  return `${(await Promise.all(rules)).join('')}:root{${names.join(';')}}\n`;
}
