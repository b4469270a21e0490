// The questions of the chapter as data: what the page asks is what a frame shows and what `slam2d mark` marks.

/** Chapter, exercise and part, `16.5a`; or a name in place of the number, `16.flat-ground`. */
const ID = /^\d+\.(\d+[a-z]?|[a-z]+(-[a-z]+)*)$/;

/**
 * Reads every `<slam-predict>` of a page's source, in order.
 * @throws {Error} if an exercise has no id, a malformed one, or one that another exercise has.
 */
export function readExercises(html) {
  const exercises = [];
  for (const [, tag, content] of html.matchAll(/<slam-predict\b([^>]*)>([\s\S]*?)<\/slam-predict>/g)) {
    const given = attributes(tag);
    const { exercise } = given;
    if (exercise === undefined) {
      throw new Error(`the question <slam-predict${tag}> has no id: add exercise="16.5a", its chapter, number and part`);
    }
    if (!ID.test(exercise)) throw new Error(`exercise="${exercise}" is no id such as 16.5a or 16.flat-ground`);
    if (exercises.some((other) => other.exercise === exercise)) {
      throw new Error(`two questions have exercise="${exercise}": give each an id of its own`);
    }
    exercises.push({ ...given, choices: [...content.matchAll(/<li\b([^>]*\bdata-choice=[^>]*)>/g)].map(([, item]) => choiceOf(item)) });
  }
  return exercises;
}

function choiceOf(item) {
  const { 'data-choice': choice, 'data-from': from, 'data-to': to } = attributes(item);
  return { choice, from, to };
}

function attributes(tag) {
  const pairs = [...tag.matchAll(/([\w-]+)="([^"]*)"/g)];
  return Object.fromEntries(pairs.map(([, name, text]) => [name, text.replaceAll('&lt;', '<').replaceAll('&gt;', '>').replaceAll('&amp;', '&')]));
}
