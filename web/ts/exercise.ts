// An exercise of the chapter by itself: its questions and the widgets that answer them.

import { connect } from './scorm';

/** What web/page/build.mjs writes into exercises.json, from the source of the page. */
interface Exercise {
  /** Without a part: `16.5`. */
  name: string;
  title: string;
  intro: string;
  questions: Question[];
}

interface Question {
  exercise: string;
  widget: string;
  html: string;
}

/**
 * Shows an exercise, `16.5` or `5`, or one part of it, `16.5a`. Returns its title.
 * @throws {Error} with a sentence, if there is none or the list of exercises does not arrive.
 */
export async function showExercise(main: HTMLElement, id: string): Promise<string> {
  const response = await fetch(new URL('./exercises.json', import.meta.url)).catch(() => undefined);
  if (response?.ok !== true) throw new Error('The exercises could not be loaded: exercises.json is missing beside embed.html.');
  const { exercise, questions } = find((await response.json()) as Exercise[], id);
  const reports = connect(window, questions.map((question) => question.exercise));
  // @ts-expect-error: stays a file of its own beside this one.
  await import('./slam-predict.js');
  const article = document.createElement('article');
  article.className = 'exercise';
  // Of our own build; what the address names only chooses one of them.
  article.innerHTML = `${exercise.intro}${questions.map(({ html }) => html).join('')}`;
  const title = document.createElement('h1');
  title.textContent = exercise.title;
  article.prepend(title);
  if (reports !== undefined) {
    for (const question of article.querySelectorAll('slam-predict')) question.setAttribute('student', reports.student);
    document.addEventListener('slam-predict', ({ detail, target }) => {
      const choices = [...(target as HTMLElement).querySelectorAll<HTMLElement>('[data-choice]')];
      reports.answered(detail, choices.map((choice) => choice.dataset['choice'] ?? ''));
    });
    addEventListener('pagehide', () => reports.end());
  }
  main.querySelector('h1')?.remove();
  main.append(article);
  for (const name of new Set(questions.map(({ widget }) => widget))) {
    const widget = document.createElement('slam-widget');
    widget.setAttribute('name', name);
    main.append(widget);
  }
  return exercise.title;
}

/** The questions whose id is the one asked for, with or without chapter and part. */
function find(exercises: Exercise[], id: string): { exercise: Exercise; questions: Question[] } {
  const isAsked = (name: string): boolean => name === id || name.replace(/^\d+\./, '') === id;
  for (const exercise of exercises) {
    const questions = exercise.questions.filter((question) => isAsked(exercise.name) || isAsked(question.exercise));
    if (questions.length > 0) return { exercise, questions };
  }
  const known = exercises.flatMap(({ questions }) => questions.map(({ exercise }) => exercise)).join(', ');
  throw new Error(`There is no exercise \`${id.slice(0, 60)}\`; there are ${known}.`);
}
