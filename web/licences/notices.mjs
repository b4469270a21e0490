// The notices for everything that we distribute: a text for the npm package, a page for the site.

import { cp, readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';

import { escapeHtml, withPolicy } from '../html.mjs';
import { FONT_FOLDERS } from '../page/fonts.mjs';
import { ROOT, cratesOfModule, npmPackage, npmPackagesIn, rustVersion } from './packages.mjs';
import { squeezed, withTexts } from './texts.mjs';

export const OWN_LICENCES = ['LICENSE-MIT', 'LICENSE-APACHE'];
export const PACKAGE_NOTICES = 'THIRD-PARTY-NOTICES.txt';
export const PAGE = 'notices.html';

/** Third-party packages in the widgets, as groups `{ title, packages }`. */
export async function partsOfWidgets(metafiles) {
  const library = {
    name: 'The Rust standard library',
    version: rustVersion(),
    licence: '(MIT OR Apache-2.0) AND Unicode-3.0',
    repository: '',
    url: 'https://github.com/rust-lang/rust',
  };
  const font = (name, version, licence, url, folder) => (
    { name: `${name}, a subset`, version, licence, repository: '', url, folder: path.join(ROOT, 'web/fonts', folder) });
  const fonts = [
    font('Public Sans', '2.001', 'OFL-1.1', 'https://public-sans.digital.gov/', 'public-sans'),
    font('DejaVu Sans Condensed', '2.37', 'Bitstream-Vera', 'https://dejavu-fonts.github.io/', 'dejavu'),
  ];
  return grouped({
    'In the WebAssembly module': [library, ...cratesOfModule('slam_web'), ...fonts],
    'In the module that maps a reader’s log': [library, ...cratesOfModule('slam_robot')],
    'In the scripts of the element': await npmPackagesIn(...metafiles),
  });
}

/** Third-party packages in the pages of the chapter. */
export async function partsOfPage(metafiles) {
  const katex = await npmPackage(path.join(ROOT, 'web/node_modules/katex'));
  const fonts = { ...katex, name: 'KaTeX fonts', licence: 'OFL-1.1', folder: undefined };
  const typefaces = await Promise.all(FONT_FOLDERS.map(npmPackage));
  return grouped({ 'On the chapter’s page': [katex, fonts, ...typefaces, ...(await npmPackagesIn(...metafiles))] });
}

function grouped(packagesOf) {
  return Object.entries(packagesOf)
    .filter(([, packages]) => packages.length > 0)
    .map(([title, packages]) => ({ title, packages: withTexts(packages) }));
}

/** Writes our licences, and the notices as text, for the npm package. */
export async function writePackageNotices(parts, folder) {
  for (const file of OWN_LICENCES) await cp(path.join(ROOT, file), path.join(folder, file));
  const lines = parts.flatMap(({ title, packages }) => ['', `${title}:`, ...packages.map((one) => `  ${titleOf(one)}: ${one.licence}`)]);
  const texts = textsOf(parts).flatMap(({ heading, names, text }) => ['-'.repeat(80), `${heading}: ${names.join(', ')}`, '', text.trimEnd(), '']);
  await writeFile(
    path.join(folder, PACKAGE_NOTICES),
    ['This package contains work of others under the licences below.', ...lines, '', ...texts].join('\n'),
  );
}

/** Writes the notices as a page with the chapter's style sheet `style`. */
export async function writeNoticesPage(parts, folder, style) {
  const own = await Promise.all(OWN_LICENCES.map((file) => readFile(path.join(ROOT, file), 'utf8')));
  const texts = textsOf(parts);
  const linkTo = new Map(texts.flatMap(({ anchor, packages }) => packages.map(([one, id]) => [`${titleOf(one)} ${id}`, anchor])));
  const row = (one) => {
    const links = one.texts.map(({ id }) => `<a href="#${linkTo.get(`${titleOf(one)} ${id}`)}">${escapeHtml(id)}</a>`);
    return `<li><a href="${escapeHtml(one.url)}">${escapeHtml(one.name)}</a> ${escapeHtml(one.version)}, `
      + `under ${escapeHtml(one.licence)}. ${links.length === 1 ? 'Text' : 'Texts'}: ${links.join(', ')}.</li>`;
  };
  const lists = parts.map(({ title, packages }) => [title, `<ul>\n${packages.map(row).join('\n')}\n</ul>`]);
  const articles = texts.map(({ heading, names, anchor, text }) =>
    `<h3 id="${anchor}">${escapeHtml(heading)}</h3>\n<p>For ${escapeHtml(names.join(', '))}.</p>\n${verbatim(text)}`);
  const sections = [
    ['This project', own.map((text, at) => `<h3>${OWN_LICENCES[at]}</h3>\n${verbatim(text)}`).join('\n')],
    ...lists,
    ['The texts', articles.join('\n')],
  ];
  await writeFile(path.join(folder, PAGE), withPolicy(`<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Licences and notices: scan matching and the pose graph</title>
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<link rel="stylesheet" href="${style}">
</head>
<body>
<a class="skip" href="#notices">Skip to the notices</a>

<header class="masthead">
  <p class="kicker"><a href="index.html">Scan matching and the pose graph</a></p>
  <h1>Licences and notices</h1>
  <p class="lede">This page and its widgets are under the MIT licence or the Apache License 2.0, as you choose.
  They contain work of others, listed here with the texts of its licences.</p>
</header>

<nav class="contents" aria-labelledby="contents-title">
  <h2 id="contents-title">Contents</h2>
  <ol>
${sections.map(([title], at) => `    <li><a href="#part-${at + 1}">${escapeHtml(title)}</a></li>`).join('\n')}
  </ol>
</nav>

<main id="notices">

${sections.map(section).join('\n\n')}

</main>
</body>
</html>
`));
}

function section([title, content], at) {
  return `<section id="part-${at + 1}">\n<h2>${escapeHtml(title)}</h2>\n${content}\n</section>`;
}

const verbatim = (text) => `<pre class="verbatim">${escapeHtml(text.trimEnd())}</pre>`;

/** Each licence text once, with its packages. */
function textsOf(parts) {
  const found = new Map();
  for (const one of parts.flatMap(({ packages }) => packages)) {
    for (const { id, text } of one.texts) {
      const key = `${id} ${squeezed(text)}`;
      const entry = found.get(key) ?? { heading: id, text, packages: [] };
      entry.packages.push([one, id]);
      found.set(key, entry);
    }
  }
  return [...found.values()].map((entry, at) => ({
    ...entry,
    anchor: `text-${at + 1}`,
    names: entry.packages.map(([one]) => titleOf(one)),
  }));
}

const titleOf = ({ name, version }) => `${name} ${version}`;
