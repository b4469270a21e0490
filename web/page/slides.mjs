// slides.html: a slide for each widget, from the scripts of docs/teaching/widgets.md, and one for each question about it,
// to predict before the class sees the result. The states of a script are links on its slide, and its text is folded below the
// widget.

import { escapeHtml } from '../html.mjs';

/** The page of slides; `exercises` are those of `frameExercises`. */
export function slidesPage(scripts, exercises) {
  const slides = scripts.split(/^## /m).slice(1).flatMap((text) => [slide(text), ...questions(text.match(/^\S+/)[0], exercises)]);
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>SLAM in two dimensions: slides</title>
<link rel="icon" href="data:,">
<style>
html { scroll-snap-type: y mandatory; color-scheme: light dark; font: 1.375rem/1.35 system-ui, sans-serif; }
body { margin: 0; }
section { box-sizing: border-box; min-height: 100vh; padding: 1vh 2vw; scroll-snap-align: start; }
h1, h2 { margin: 0 0 0.5rem; font-size: 1.25rem; }
header { display: flex; flex-wrap: wrap; gap: 0.25rem 1rem; align-items: center; margin-bottom: 0.3rem; }
header h2 { margin: 0; font-size: 1rem; }
.title { display: grid; align-content: center; justify-items: center; text-align: center; }
p { margin: 0 0 0.5rem; }
nav { display: flex; flex-wrap: wrap; gap: 0.25rem 0.4rem; font-size: 0.75rem; }
nav a { padding: 0.1rem 0.6rem; border: 1px solid; border-radius: 6px; color: inherit; text-decoration: none; }
slam-widget { max-height: calc(98vh - 2.2rem); overflow: auto; }
details { margin-top: 0.5rem; }
slam-predict { max-width: 45rem; }
.notes :is(slam-widget, slam-predict, nav, summary) { display: none; }
</style>
<script type="module" src="slam-widget.js"></script>
<script type="module" src="slam-predict.js"></script>
<script type="module" src="slides.js"></script>
</head>
<body>
<main>
<section class="title"><div><h1>SLAM in two dimensions</h1>
<p>Arrow keys turn the slides. The links set the widget; the script of each slide is folded below it, and stands in the
<a href="?notes" target="_blank">speaker’s view</a>, which follows.</p></div></section>
${slides.join('\n')}
</main>
</body>
</html>
`;
}

/** The slide of a script: title, `w16.1 Basin explorer`, goal, misconception, numbered steps with links. */
function slide(text) {
  const [, name, title] = text.match(/^(w\S+) (.*)$/m);
  const [, misconception] = text.match(/^\*\*Misconception\.\*\* ([\s\S]*?)\n\n/m);
  const [, goal] = text.match(/^\*\*Goal\.\*\* ([\s\S]*?)\n\n/m);
  const links = [...text.matchAll(/\[([^\]]+)\]\([a-z-]+\.html(\?w=[^)]+)\)/g)];
  const steps = text.split(/^\d+\. /m).slice(1).map((step) => `<li>${inLine(step)}</li>`);
  const first = new URLSearchParams(links[0]?.[2] ?? '');
  const state = [...first].filter(([id]) => id !== 'w').map(([id, value]) => ` ${id}="${escapeHtml(value)}"`).join('');
  return `<section>
<header><h2>${escapeHtml(title)}</h2>
<nav aria-label="States of ${escapeHtml(title)}">${links.map(([, words, query]) => `<a class="slam-link" href="${escapeHtml(query)}">${inLine(words)}</a>`).join('')}</nav></header>
<slam-widget name="${name}"${state}></slam-widget>
<details><summary>Script</summary><p>${inLine(goal)}</p><p>${inLine(misconception)}</p><ol>${steps.join('')}</ol></details>
</section>`;
}

/** A slide for each question about a widget. The widget on the slide before shows the answer. */
function questions(widget, exercises) {
  return exercises.flatMap(({ title, intro, questions: asked }) => asked.filter((question) => question.widget === widget)
    .map(({ html }) => `<section>
<h2>${title}</h2>
${html}
<details><summary>The exercise</summary>${intro}</details>
</section>`));
}

/** Converts inline Markdown to HTML. */
function inLine(text) {
  return text.trim()
    .replace(/\[([^\]]+)\]\([^)]*\)/g, '$1')
    .replace(/\*\*([^*]+)\*\*/g, '<b>$1</b>')
    .replace(/`([^`]+)`/g, '<code>$1</code>');
}
