// The questions of the chapter as data, for frames and for `ch16-mark`. Their source is the page.

/** Chapter, exercise and part: `16.5a`; or a name instead of the number: `16.flat-ground`. */
const ID = /^\d+\.(\d+[a-z]?|[a-z]+(-[a-z]+)*)$/;

/**
 * Reads every `<slam-predict>` of the pages, sorted by id.
 * @throws {Error} if an id is missing, malformed or used twice.
 */
export function readExercises(html) {
  const exercises = [];
  for (const [, tag, content] of html.matchAll(/<slam-predict\b([^>]*)>([\s\S]*?)<\/slam-predict>/g)) {
    const { exercise, widget, state, fact, tolerance, unit, varies } = attributes(tag);
    if (exercise === undefined) {
      throw new Error(`the question <slam-predict${tag}> has no id: add exercise="16.5a", its chapter, number and part`);
    }
    if (!ID.test(exercise)) throw new Error(`exercise="${exercise}" is no id such as 16.5a or 16.flat-ground`);
    if (exercises.some((other) => other.exercise === exercise)) {
      throw new Error(`two questions have exercise="${exercise}": give each an id of its own`);
    }
    const choices = [...content.matchAll(/<li\b([^>]*\bdata-choice=[^>]*)>/g)].map(([, item]) => choiceOf(item));
    exercises.push(withoutUndefined({ exercise, widget, state, fact, tolerance: numberOf(tolerance), unit, varies, choices }));
  }
  return exercises.sort(byId(({ exercise }) => exercise));
}

function byId(idOf) {
  return (one, other) => idOf(one).localeCompare(idOf(other), 'en', { numeric: true });
}

/**
 * Each exercise for a frame: its name without a part, `16.5`, its title, the text before its questions, and the questions.
 * Links within the page become text; `render` turns formulas into HTML.
 */
export function frameExercises(html, render) {
  return html.split('<article class="exercise"').slice(1).map((part) => {
    const inner = render(part).replace(/<a [^>]*href="#[^>]*>([\s\S]*?)<\/a>/g, '$1').replace(/<slam-widget\b[^>]*><\/slam-widget>/g, '');
    const title = inner.match(/<h3>([\s\S]*?)<\/h3>/)[1].replace(/<[^>]*>/g, '');
    const intro = inner.slice(inner.indexOf('</h3>') + '</h3>'.length, inner.indexOf('<slam-predict'));
    const questions = [...inner.matchAll(/<slam-predict exercise="([^"]*)" widget="([^"]*)"[\s\S]*?<\/slam-predict>/g)];
    const name = questions[0][1].replace(/(\d)[a-z]$/, '$1');
    return { name, title, intro, questions: questions.map(([text, exercise, widget]) => ({ exercise, widget, html: text })) };
  }).sort(byId(({ name }) => name));
}

/** Folds each exercise under its title, which a link in it would make ambiguous. */
export function foldExercises(html) {
  return html.replace(/(<article class="exercise"[^>]*>)\s*(<h3>[\s\S]*?)(?:<a class="anchor"[^>]*>#<\/a>)?<\/h3>([\s\S]*?)<\/article>/g,
    '$1<details><summary>$2</h3></summary><div class="exercise-body">$3</div></details></article>');
}

function choiceOf(item) {
  const { 'data-choice': choice, 'data-from': from, 'data-to': to } = attributes(item);
  return withoutUndefined({ choice, from: numberOf(from), to: numberOf(to) });
}

function numberOf(text) {
  return text === undefined ? undefined : Number(text);
}

/** Removes undefined properties. */
function withoutUndefined(object) {
  return Object.fromEntries(Object.entries(object).filter(([, value]) => value !== undefined));
}

function attributes(tag) {
  const pairs = [...tag.matchAll(/([\w-]+)="([^"]*)"/g)];
  return Object.fromEntries(pairs.map(([, name, text]) => [name, text.replaceAll('&lt;', '<').replaceAll('&gt;', '>').replaceAll('&amp;', '&')]));
}
