// The licence texts of a package: from the package itself, or from its authors' repository.

import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';

import { LicenceProblem, SHIPPED, acceptedChoices } from './allowed.mjs';
import { ROOT } from './packages.mjs';

const LICENCE_FILE = /^(licen[cs]e|copying|copyright|notice|authors|unlicense)/i;
/** Files with additional notices. */
const NOTICE_FILE = /^(copying|copyright|notice|authors)/i;

/** Texts that packages lack; `texts/README.md` documents their sources. */
const SUPPLIED = [
  { file: 'faer-MIT.txt', id: 'MIT', packages: ['faer', 'faer-traits'] },
  { file: 'nano-gemm-MIT.txt', id: 'MIT', packages: /^nano-gemm(-\w+)?$/ },
  { file: 'katex-fonts-OFL-1.1.txt', id: 'OFL-1.1', packages: ['KaTeX fonts'] },
  { file: 'rust-Unicode-3.0.txt', id: 'Unicode-3.0', packages: ['The Rust standard library'] },
];

/**
 * Adds the licence texts to packages: `texts` is a list of `{ id, text }`, and `id` a licence or the file of a notice.
 *
 * A package with a choice of licences is used under the first one of SHIPPED whose text exists.
 */
export function withTexts(packages) {
  return packages.map((one) => {
    const files = licenceFiles(one.folder);
    const neighbours = packages.filter((other) => other.repository !== '' && other.repository === one.repository);
    const what = `${one.name} ${one.version}`;
    const choices = acceptedChoices(one.licence, SHIPPED.keys(), what);
    const textOf = (id) => ownText(files, id) ?? supplied(one.name, id) ?? fromNeighbour(neighbours, id) ?? terms(id);
    const found = choices.map((ids) => ids.map((id) => ({ id, text: textOf(id) })));
    const complete = found.find((texts) => texts.every(({ text }) => text !== undefined));
    if (complete === undefined) {
      throw new LicenceProblem(
        `${what} is under ${one.licence}, and its package has no text of it: `
        + 'put the text of its repository into web/licences/texts/ and name it in web/licences/texts.mjs.',
      );
    }
    const notices = files
      .filter(({ name, text }) => NOTICE_FILE.test(name) && !complete.some((taken) => taken.text === text))
      .map(({ name, text }) => ({ id: name, text }));
    return { ...one, texts: [...complete, ...notices] };
  });
}

/** Supplied texts that no package uses any more. */
export function unusedTexts(packages) {
  return SUPPLIED.filter((entry) => !packages.some(({ name }) => isFor(entry, name))).map(({ file }) => file);
}

function licenceFiles(folder) {
  if (folder === undefined) return [];
  return readdirSync(folder, { withFileTypes: true })
    .filter((entry) => entry.isFile() && LICENCE_FILE.test(entry.name))
    .map(({ name }) => ({ name, text: readFileSync(path.join(folder, name), 'utf8') }))
    .sort((a, b) => (a.name < b.name ? -1 : 1));
}

/** The shortest matching file: a longer one may contain several licences. */
function ownText(files, id) {
  const fitting = files.filter(({ text }) => SHIPPED.get(id).test(squeezed(text)));
  return fitting.sort((a, b) => a.text.length - b.text.length)[0]?.text;
}

const isFor = ({ packages }, name) => (Array.isArray(packages) ? packages.includes(name) : packages.test(name));

function supplied(name, id) {
  const entry = SUPPLIED.find((candidate) => candidate.id === id && isFor(candidate, name));
  return entry && readFileSync(path.join(ROOT, 'web/licences/texts', entry.file), 'utf8');
}

/** The text from another package of the same repository. */
function fromNeighbour(neighbours, id) {
  return neighbours.map(({ folder }) => ownText(licenceFiles(folder), id)).find((text) => text !== undefined);
}

/** The terms of the Apache License are the same for all: our copy without its appendix, which names us. */
function terms(id) {
  if (id !== 'Apache-2.0') return undefined;
  const end = 'END OF TERMS AND CONDITIONS\n';
  const [before] = readFileSync(path.join(ROOT, 'LICENSE-APACHE'), 'utf8').split(end);
  return `${before}${end}`;
}

/** Normalizes case and white space for comparison. */
export function squeezed(text) {
  return text.toLowerCase().replace(/\s+/g, ' ').trim();
}
