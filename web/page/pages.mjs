// The pages of the companion: their files and names, and the layout that they share.

import { readFile } from 'node:fs/promises';
import path from 'node:path';

/** In reading order: the file of the site, its source, its name in the navigation. */
export const PAGES = [
  { file: 'index.html', source: 'index.html', name: 'Matching and the graph' },
  { file: 'robots.html', source: 'web/page/robots.html', name: 'What robots run' },
  { file: 'own-robot.html', source: 'web/page/own-robot.html', name: 'Your own robot' },
  { file: 'break.html', source: 'web/page/break.html', name: 'Break my SLAM' },
  { file: 'reference.html', source: 'web/page/reference.html', name: 'Reference' },
];

/** Reads the sources of all pages. */
export function readPages(root) {
  return Promise.all(PAGES.map(async (page) => ({ ...page, html: await readFile(path.join(root, page.source), 'utf8') })));
}

/** The first page of each anchor and widget, for redirects and for links between pages. */
export function placesOf(pages) {
  const each = (pattern) => pages.flatMap(({ file, html }) => [...html.matchAll(pattern)].map(([, name]) => [name, file]));
  const first = (pattern) => Object.fromEntries(each(pattern).reverse());
  return {
    anchors: first(/\sid="([^"]+)"/g),
    widgets: first(/<slam-widget name="([^"]+)"/g),
  };
}

/** Puts the shared head, navigation and footer around a page. */
export function withFrame(template, page, pages, places) {
  const parts = page.html.match(/^([\s\S]*?)(<header[\s\S]*<\/main>)\s*$/);
  if (parts === null) throw new Error(`${page.source} is no title, description, header and main`);
  const body = withAnchors(withLinks(withTerms(parts[2], pages), page, places));
  const at = pages.indexOf(page);
  const filled = {
    head: parts[1].trim(),
    page: path.parse(page.file).name,
    pages: pages.map(({ file, name }) => `<li><a href="${file}"${file === page.file ? ' aria-current="page"' : ''}>${name}</a></li>`).join('\n    '),
    body,
    steps: [step('prev', pages[at - 1]), step('next', pages[at + 1])].filter(Boolean).join('\n  '),
    challenges: pages.flatMap(({ html }) => html.match(/<p class="challenge"/g) ?? []).length,
    contents: headings(body).map(({ id, text }) => `<li><a href="#${id}">${text}</a></li>`).join('\n      '),
  };
  return template.replace(/\{(head|page|pages|body|steps|contents|challenges)\}/g, (_, name) => filled[name]);
}

function step(rel, page) {
  return page === undefined ? '' : `<a rel="${rel}" href="${page.file}"><small>${rel === 'next' ? 'Next' : 'Previous'}</small> ${page.name}</a>`;
}

/** Makes of the first use of a term a button that opens its line of the notation, which only one page holds. */
function withTerms(html, pages) {
  return html.replace(/<a class="term" href="#(term-[^"]+)">([^<]+)<\/a>/g, (_, id, word) => {
    const line = pages.map((page) => page.html.match(new RegExp(`<tr id="${id}"><th[^>]*>([\\s\\S]*?)</th><td>([\\s\\S]*?)</td>`))).find(Boolean);
    if (line === undefined) throw new Error(`no line of the notation is ${id}`);
    return `<button type="button" class="term" popovertarget="${id}-line">${word}</button>`
      + `<span popover id="${id}-line" class="term-line"><b>${line[1]}</b>: ${line[2]}</span>`;
  });
}

/** Adds the page to links whose target is on another one. */
function withLinks(html, { file, source }, { anchors, widgets }) {
  const inText = html.replace(/(<a\b[^>]*\bhref=")#([^"]+)"/g, (whole, before, id) => {
    if (anchors[id] === undefined) throw new Error(`${source} links to #${id}, which is on no page`);
    return anchors[id] === file ? whole : `${before}${anchors[id]}#${id}"`;
  });
  return inText.replace(/(<a\b[^>]*\bhref=")(\?w=([\d.]+)[^"]*)"/g, (whole, before, query, id) => {
    const on = widgets[`w${id}`];
    return on === undefined || on === file || html.includes(`<slam-widget name="w${id}"`) ? whole : `${before}${on}${query}"`;
  });
}

/** A heading with its id, or with that of the section that it opens. */
const HEADING = /(<(?:section|article)\b[^>]*\bid="([^"]+)"[^>]*>\s*)?<h([23])(\s+id="([^"]+)")?>([\s\S]*?)<\/h\3>/g;

/** Adds a link to itself to each heading with an id. */
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
