// The pages of the companion: what each is called, what stands on it, and what all of them share.

import { readFile } from 'node:fs/promises';
import path from 'node:path';

/** In the order in which they are read: the file of the site, its source, its name in the navigation. */
export const PAGES = [
  { file: 'index.html', source: 'index.html', name: 'Matching and the graph' },
  { file: 'robots.html', source: 'web/page/robots.html', name: 'What robots run' },
  { file: 'own-robot.html', source: 'web/page/own-robot.html', name: 'Your own robot' },
  { file: 'reference.html', source: 'web/page/reference.html', name: 'Reference' },
];

/** Reads the sources of all pages. */
export function readPages(root) {
  return Promise.all(PAGES.map(async (page) => ({ ...page, html: await readFile(path.join(root, page.source), 'utf8') })));
}

/** The page of each anchor and of each widget: old addresses and links between pages are led there. */
export function placesOf(pages) {
  const each = (pattern) => pages.flatMap(({ file, html }) => [...html.matchAll(pattern)].map(([, name]) => [name, file]));
  return {
    anchors: Object.fromEntries(each(/\sid="([^"]+)"/g)),
    widgets: Object.fromEntries(each(/<slam-widget name="([^"]+)"/g)),
  };
}

/** Puts the head, the navigation and the end that all pages share around a page. */
export function withFrame(template, page, pages, places) {
  const parts = page.html.match(/^([\s\S]*?)(<header[\s\S]*<\/main>)\s*$/);
  if (parts === null) throw new Error(`${page.source} is no title, description, header and main`);
  const body = withAnchors(withLinks(parts[2], page, places));
  const at = pages.indexOf(page);
  const filled = {
    head: parts[1].trim(),
    pages: pages.map(({ file, name }) => `<li><a href="${file}"${file === page.file ? ' aria-current="page"' : ''}>${name}</a></li>`).join('\n    '),
    body,
    steps: [step('prev', pages[at - 1]), step('next', pages[at + 1])].filter(Boolean).join('\n  '),
    contents: headings(body).map(({ id, text }) => `<li><a href="#${id}">${text}</a></li>`).join('\n      '),
  };
  return template.replace(/\{(head|pages|body|steps|contents)\}/g, (_, name) => filled[name]);
}

function step(rel, page) {
  return page === undefined ? '' : `<a rel="${rel}" href="${page.file}"><small>${rel === 'next' ? 'Next' : 'Before'}</small> ${page.name}</a>`;
}

/** Links to what stands on another page name that page. */
function withLinks(html, { file, source }, { anchors, widgets }) {
  const inText = html.replace(/(<a\b[^>]*\bhref=")#([^"]+)"/g, (whole, before, id) => {
    if (anchors[id] === undefined) throw new Error(`${source} links to #${id}, which is on no page`);
    return anchors[id] === file ? whole : `${before}${anchors[id]}#${id}"`;
  });
  return inText.replace(/(<a\b[^>]*\bhref=")(\?w=([\d.]+)[^"]*)"/g, (whole, before, query, id) => {
    const on = widgets[`w${id}`];
    return on === undefined || on === file ? whole : `${before}${on}${query}"`;
  });
}

/** The id of a section is that of its first heading, if that has none. */
const HEADING = /(<(?:section|article)\b[^>]*\bid="([^"]+)"[^>]*>\s*)?<h([23])(\s+id="([^"]+)")?>([\s\S]*?)<\/h\3>/g;

/** Each heading with an anchor gets a link to itself. */
function withAnchors(html) {
  return html.replace(HEADING, (whole, before = '', ofSection, level, attribute = '', own, text) => {
    const id = ofSection ?? own;
    if (id === undefined) return whole;
    // The contents list has the same links for the keyboard and for screen readers.
    const link = `<a class="anchor" href="#${id}" tabindex="-1" aria-hidden="true">#</a>`;
    return `${before}<h${level}${attribute}>${text}${link}</h${level}>`;
  });
}

function headings(html) {
  return [...html.matchAll(HEADING)]
    .filter(([, , , level]) => level === '2')
    .map(([, , ofSection, , , own, text]) => ({ id: ofSection ?? own, text: plain(text.replace(/<a class="anchor"[\s\S]*?<\/a>/, '')) }))
    .filter(({ id }) => id !== undefined);
}

function plain(html) {
  return html.replace(/<[^>]+>/g, '').trim();
}
