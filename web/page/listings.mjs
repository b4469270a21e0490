// Listings with functions from source files that are compiled and tested, highlighted in the build:
// `<pre class="listing" data-file="crates/…/align.rs" data-items="motion corners"></pre>`.

import { readFile } from 'node:fs/promises';
import path from 'node:path';

const KEYWORDS = new Set(('as assert break const continue else enum false fn for if impl in let loop match mod mut pub '
  + 'ref return self Self static struct super true type use where while').split(' '));
/** Groups: comment, string, number, macro, word, anything else. */
const TOKEN = /(\/\/[^\n]*)|("(?:[^"\\]|\\.)*")|(\b\d[\d_]*(?:\.\d+)?(?:e-?\d+)?(?:f64|usize)?\b)|(\b[a-z_]+!)|([A-Za-z_]\w*)|([\s\S])/g;

/** Fills every listing of a page. */
export async function addListings(html, root) {
  const places = [...html.matchAll(/<pre class="listing" data-file="([^"]*)" data-items="([^"]*)"><\/pre>/g)];
  for (const [place, file, items] of places) {
    const source = await readFile(path.join(root, file), 'utf8');
    const code = items.split(' ').map((name) => itemOf(source, name, file)).join('\n\n');
    const name = `<span>From <code>${file}</code></span>`;
    html = html.replace(place, () => `<figure class="listing"><figcaption>${name}</figcaption><pre tabindex="0"><code>${highlight(code)}</code></pre></figure>`);
  }
  return html;
}

/** A function of a source file from its signature to its closing brace, without comments and attributes. */
export function itemOf(source, name, file) {
  const start = source.search(new RegExp(`^(?:pub(?:\\([a-z]+\\))? )?fn ${name}\\b`, 'm'));
  if (start < 0) throw new Error(`${file} has no function ${name}, which a page lists`);
  const end = source.indexOf('\n}\n', start);
  return source.slice(start, end + 2);
}

/** Highlights Rust code with a span for each token. */
export function highlight(code) {
  return code.replace(TOKEN, (token, comment, text, number, macro, word) => {
    const escaped = token.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;');
    if (comment !== undefined) return span('comment', escaped);
    if (text !== undefined) return span('text', escaped);
    if (number !== undefined) return span('number', escaped);
    if (macro !== undefined || KEYWORDS.has(word)) return span('word', escaped);
    if (word !== undefined && /^[A-Z]/.test(word)) return span('type', escaped);
    return escaped;
  });
}

function span(kind, text) {
  return `<span class="code-${kind}">${text}</span>`;
}
