// slides.html: the chapter for a class. Each section of the pages has a slide of its formulas and one of a derivation, each
// of its widgets a slide and each question about a widget another, with the widget. The script of teaching/guide/widgets.md
// is the speaker's note.

import { escapeHtml } from '../html.mjs';
import { FONT_PRELOADS } from './fonts.mjs';

/** What the slides take from a page, in order: headings, first paragraphs, formulas, folds and widgets. */
const PARTS = /<h[12]\b[^>]*>([\s\S]*?)<\/h[12]>|<p>([\s\S]*?)<\/p>|<tex display>[\s\S]*?<\/tex>|<slam-widget name="([^"]*)"|<(details)\b[^>]*>\s*(?:<summary>([\s\S]*?)<\/summary>)?|<\/details>/g;

/**
 * The page of slides, in the order of the pages.
 *
 * @param {{ html: string }[]} pages
 * @param {string} scripts of the widgets, as Markdown
 * @param {{ title: string, intro: string, questions: { exercise: string, widget: string, html: string }[] }[]} exercises
 * @param {(html: string) => string} render turns formulas into HTML
 */
export function slidesPage(pages, scripts, exercises, render) {
  const scriptOf = new Map(scripts.split(/^## /m).slice(1).map((text) => [text.match(/^\S+/)[0], text]));
  const shown = new Set();
  const isFirst = (widget) => !shown.has(widget) && shown.add(widget);
  const slides = pages.flatMap(({ html }) => sections(html)).flatMap((section) => [
    ...formulas(section, render),
    ...section.widgets.filter(isFirst).flatMap((widget) => [slide(scriptOf.get(widget)), ...questions(widget, exercises)]),
  ]);
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<script src="early.js"></script>
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>SLAM in two dimensions: slides</title>
<link rel="icon" href="data:,">
${FONT_PRELOADS}
<link rel="stylesheet" href="katex/katex.css">
<link rel="stylesheet" href="slides.css">
<script type="module" src="slides.js"></script>
<script type="module" src="slam-widget.js"></script>
<script type="module" src="slam-predict.js"></script>
</head>
<body>
<main>
<section class="title"><h1>SLAM in two dimensions</h1>
<p>The arrow keys change slides, and N opens the speaker notes in a second window.</p>
<p><a href="index.html">The chapter</a></p>
<template class="note"><p>Each widget asks a question: let the class answer it before you drag.</p></template></section>
${slides.join('\n')}
</main>
<nav class="turn" aria-label="Slides"><button type="button" data-turn="-1" aria-label="Previous slide">←</button><output></output><button type="button" data-turn="1" aria-label="Next slide">→</button><button type="button" data-notes>Notes</button></nav>
<aside class="speaker" hidden aria-live="polite"><p class="now"></p><div class="note"></div><p class="then"></p></aside>
</body>
</html>
`;
}

/** The sections of a page with their own formulas, the first derivation in a fold, and their widgets. */
function sections(html) {
  const found = [];
  /** @type {(string | undefined)[]} */
  const folds = [];
  for (const [text, heading, paragraph, widget, details, summary] of html.matchAll(PARTS)) {
    const section = found.at(-1);
    if (heading !== undefined) found.push({ title: heading, lead: '', formulas: [], derivation: undefined, widgets: [] });
    else if (section === undefined) continue;
    else if (widget !== undefined) section.widgets.push(widget);
    else if (details !== undefined) folds.push(summary);
    else if (text === '</details>') folds.pop();
    else if (paragraph !== undefined) section.lead ||= paragraph;
    else if (folds.length === 0) section.formulas.push(text);
    else {
      section.derivation ??= { title: folds.at(-1), formulas: [] };
      if (section.derivation.title === folds.at(-1)) section.derivation.formulas.push(text);
    }
  }
  return found;
}

/** The slides of a section's formulas and of its derivation, if it has them. */
function formulas({ title, lead, formulas: own, derivation }, render) {
  const note = `<template class="note"><p>${render(lead)}</p></template>`;
  const one = (heading, words, all) => `<section class="formulas">
<h1>${heading}</h1>
${words}${all.map(render).join('\n')}
${note}
</section>`;
  return [
    ...(own.length === 0 ? [] : [one(title, `<p>${render(firstSentence(lead))}</p>\n`, own)]),
    ...(derivation === undefined ? [] : [one(render(derivation.title), '', derivation.formulas)]),
  ];
}

/** The first sentence of a paragraph, without links. */
function firstSentence(paragraph) {
  const plain = paragraph.replace(/<(\/?)(a|span|button)\b[^>]*>/g, '');
  return plain.match(/^[\s\S]*?(?<! al)[.?!](?=\s|$)/)?.[0] ?? plain;
}

/** The slide of a script: title, `w16.1 Basin explorer`, goal, misconception, numbered steps with links. */
function slide(text) {
  const [, name, title] = text.match(/^(w\S+) (.*)$/m);
  const [, misconception] = text.match(/^\*\*Misconception\.\*\* ([\s\S]*?)\n\n/m);
  const [, goal] = text.match(/^\*\*Goal\.\*\* ([\s\S]*?)\n\n/m);
  const links = [...text.matchAll(/\[([^\]]+)\]\([a-z./-]+\.html(\?w=[^)]+)\)/g)];
  const steps = text.split(/^\d+\. /m).slice(1).map((step) => `<li>${inLine(step)}</li>`);
  const first = new URLSearchParams(links[0]?.[2] ?? '');
  const state = [...first].filter(([id]) => id !== 'w').map(([id, value]) => ` ${id}="${escapeHtml(value)}"`).join('');
  return `<section class="figure">
<header><h1>${escapeHtml(title)}</h1>
<nav aria-label="States of ${escapeHtml(title)}">${links.map(([, words, query]) => `<a class="slam-link" href="${escapeHtml(query)}">${inLine(words)}</a>`).join('')}</nav></header>
<slam-widget name="${name}"${state}></slam-widget>
<template class="note"><p>${inLine(misconception)}</p><p>${inLine(goal)}</p><ol>${steps.join('')}</ol></template>
</section>`;
}

/** A slide for each question about a widget: what it assumes, the question, and the widget that answers it. */
function questions(widget, exercises) {
  return exercises.flatMap(({ title, intro, questions: asked }) => asked.filter((question) => question.widget === widget)
    .map(({ html }) => `<section class="question">
<h1>${title}</h1>
<div class="premise">${intro.replace(/<details\b[\s\S]*?<\/details>/g, '')}</div>
<div>${html}</div>
<slam-widget name="${widget}"></slam-widget>
<template class="note"><p>Let the class commit by a show of hands, then press “Commit and see”.</p>${html.match(/<div data-why>([\s\S]*?)<\/div>/)?.[1] ?? ''}</template>
</section>`));
}

/** Converts inline Markdown to HTML. */
function inLine(text) {
  return text.trim()
    .replace(/\[([^\]]+)\]\([^)]*\)/g, '$1')
    .replace(/\*\*([^*]+)\*\*/g, '<b>$1</b>')
    .replace(/`([^`]+)`/g, '<code>$1</code>');
}
