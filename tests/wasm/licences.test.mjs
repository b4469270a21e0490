// The accepted licences, and the notices of everything that is published.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { LicenceProblem, SHIPPED, acceptedChoices } from '../../web/licences/allowed.mjs';
import { npmPackagesIn } from '../../web/licences/packages.mjs';
import { withTexts } from '../../web/licences/texts.mjs';

const ROOT = fileURLToPath(new URL('../../', import.meta.url));
const ALLOWED = ['MIT', 'Apache-2.0', 'Unicode-3.0'];
const ways = (expression) => acceptedChoices(expression, ALLOWED, 'foo 1.0.0');

describe('an expression of licences', () => {
  it('is resolved to its first accepted choice, with all licences that apply together', () => {
    assert.deepEqual(ways('Apache-2.0 OR MIT'), [['MIT'], ['Apache-2.0']]);
    assert.deepEqual(ways('MIT/Apache-2.0'), [['MIT'], ['Apache-2.0']]);
    assert.deepEqual(ways('GPL-2.0-only OR Apache-2.0'), [['Apache-2.0']]);
    assert.deepEqual(ways('(MIT OR GPL-3.0-only) AND Unicode-3.0'), [['MIT', 'Unicode-3.0']]);
  });

  it('without an accepted choice gives one sentence with package and licence', () => {
    for (const expression of ['GPL-3.0-only', 'MIT AND GPL-2.0-only', 'Apache-2.0 WITH LLVM-exception', 'MPL-2.0+']) {
      assert.throws(() => ways(expression), (problem) => problem instanceof LicenceProblem
        && problem.message.startsWith(`foo 1.0.0 is under ${expression}, which web/licences/allowed.mjs does not accept`));
    }
    assert.throws(() => ways('MIT or something'), /`MIT or something`, which is no expression of SPDX/);
    assert.throws(() => ways(null), /foo 1\.0\.0 names no licence/);
  });
});

describe('the texts of a package', () => {
  const MIT = readFileSync(`${ROOT}LICENSE-MIT`, 'utf8');

  /** The texts of a package with these files, by the names of the licences. */
  function taken(licence, files, others = []) {
    const folder = mkdtempSync(join(tmpdir(), 'licences-'));
    const made = [{ name: 'foo', licence, files }, ...others].map((one) => {
      const place = join(folder, one.name);
      mkdirSync(place);
      for (const [file, text] of Object.entries(one.files)) writeFileSync(join(place, file), text);
      return { version: '1.0.0', repository: 'https://example.org/foo', ...one, folder: place };
    });
    try {
      return withTexts(made)[0].texts;
    } finally {
      rmSync(folder, { recursive: true });
    }
  }

  it('are recognized by their wording, whatever their files are called', () => {
    assert.deepEqual(taken('Zlib OR MIT', { 'LICENSE.md': MIT }), [{ id: 'MIT', text: MIT }]);
  });

  it('include further notices of the package', () => {
    const texts = taken('MIT', { LICENSE: MIT, 'COPYING.OTHER': 'Parts are by others.' });
    assert.deepEqual(texts.slice(1), [{ id: 'COPYING.OTHER', text: 'Parts are by others.' }]);
  });

  it('come from another package of the same repository if its own has none', () => {
    const bar = { name: 'bar', licence: 'MIT', files: { LICENSE: MIT } };
    assert.deepEqual(taken('MIT', {}, [bar]), [{ id: 'MIT', text: MIT }]);
  });

  it('of the Apache License name nobody if the package has none', () => {
    const [{ id, text }] = taken('MIT OR Apache-2.0', {});
    assert.equal(id, 'Apache-2.0');
    assert.match(text, /END OF TERMS AND CONDITIONS\s*$/);
    assert.doesNotMatch(text, /RustSLAM/);
  });

  it('that are missing give one sentence with the place for them', () => {
    assert.throws(() => taken('MIT', { LICENSE: 'See the manifest.' }), (problem) => problem instanceof LicenceProblem
      && /^foo 1\.0\.0 is under MIT, and its package has no text of it: put .* into web\/licences\/texts\//.test(problem.message));
  });
});

it('npm packages in a bundle come from esbuild’s metafile', async () => {
  const inputs = { 'web/node_modules/katex/dist/katex.mjs': {}, 'web/ts/main.ts': {}, 'web/node_modules/katex/src/a.js': {} };
  process.chdir(ROOT);
  const [katex, ...others] = await npmPackagesIn({ inputs });
  assert.equal(katex.name, 'katex');
  assert.deepEqual(others, []);
});

describe('the published notices', () => {
  const dist = (file) => readFileSync(`${ROOT}dist/${file}`, 'utf8');
  // Requested as lines of names, independently of the build's own query.
  const tree = execFileSync('cargo', ['tree', '-p', 'slam_web', '--target', 'wasm32-unknown-unknown',
    '-e', 'normal,no-proc-macro', '--prefix', 'none', '-f', '{p}'], { cwd: ROOT, encoding: 'utf8' });
  const others = tree.split('\n').filter((line) => line !== '' && !line.includes('(/'));
  const crates = [...new Set(others.map((line) => line.split(' ').slice(0, 2).join(' ').replace(' v', ' ')))];

  it('name every crate of the module, in the page and in the package', () => {
    assert.ok(crates.length > 100);
    const [text, page] = [dist('THIRD-PARTY-NOTICES.txt'), dist('notices.html').replace(/<[^>]*>/g, '')];
    for (const crate of crates) {
      assert.ok(text.includes(`\n  ${crate}: `), `${crate} is not in the package's notices`);
      assert.ok(page.includes(`\n${crate}, under `), `${crate} is not on the page`);
    }
  });

  it('have the texts of the fonts, of KaTeX and of the standard library', () => {
    const page = dist('notices.html');
    for (const words of ['Bitstream Vera Fonts Copyright', 'SIL OPEN FONT LICENSE', 'Khan Academy', 'The Rust standard library', 'UNICODE LICENSE V3']) {
      assert.ok(page.includes(words), words);
    }
    assert.ok(dist('THIRD-PARTY-NOTICES.txt').includes('Bitstream Vera Fonts Copyright'));
  });

  it('link each package to each of its texts', () => {
    const page = dist('notices.html');
    const anchors = new Set([...page.matchAll(/<h3 id="([^"]*)"/g)].map(([, id]) => `#${id}`));
    const rows = page.match(/^<li>.*<\/li>$/gm);
    assert.ok(rows.length > crates.length);
    for (const row of rows) {
      const links = [...row.matchAll(/href="(#[^"]*)"/g)].map(([, href]) => href);
      assert.ok(links.length > 0 && links.every((href) => anchors.has(href)), row);
    }
  });

  it('include our own licences, and are linked from the chapter', () => {
    const { files } = JSON.parse(dist('package.json'));
    for (const file of ['LICENSE-MIT', 'LICENSE-APACHE']) {
      assert.equal(dist(file), readFileSync(`${ROOT}${file}`, 'utf8'));
      assert.ok(files.includes(file));
    }
    assert.ok(files.includes('THIRD-PARTY-NOTICES.txt'));
    assert.match(dist('index.html'), /<footer[\s\S]*href="notices\.html"[\s\S]*<\/footer>/);
  });
});

it('every accepted licence is distinguished from every other by its text', () => {
  const texts = { MIT: `${ROOT}LICENSE-MIT`, 'Apache-2.0': `${ROOT}LICENSE-APACHE`,
    'OFL-1.1': `${ROOT}web/licences/texts/katex-fonts-OFL-1.1.txt`, 'Bitstream-Vera': `${ROOT}web/fonts/dejavu/LICENSE.txt` };
  for (const [id, file] of Object.entries(texts)) {
    const words = readFileSync(file, 'utf8').toLowerCase().replace(/\s+/g, ' ');
    const known = [...SHIPPED].filter(([, pattern]) => pattern.test(words)).map(([name]) => name);
    assert.deepEqual(known, [id]);
  }
});
