// A single exercise of the chapter: its questions and their widgets.

import { connect, type Counts } from './scorm';

/** An entry of exercises.json, which web/page/build.mjs writes. */
interface Exercise {
  /** The id without a part: `16.5`. */
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
 * @throws {Error} with a sentence, if there is no such exercise or exercises.json does not arrive.
 */
export async function showExercise(main: HTMLElement, id: string): Promise<string> {
  const { exercise, questions } = find(await loadExercises(), id);
  const counts = countsOf(location.search);
  const reports = connect(window, questions.map((question) => question.exercise), counts);
  // @ts-expect-error: a separate bundle.
  await import('./slam-predict.js');
  const article = document.createElement('article');
  article.className = 'exercise';
  // Safe: the HTML is from our build, and the address only selects one exercise.
  article.innerHTML = `${exercise.intro}${questions.map(({ html }) => html).join('')}`;
  const title = document.createElement('h1');
  title.textContent = exercise.title;
  article.prepend(title);
  if (reports !== undefined) {
    for (const question of article.querySelectorAll('slam-predict')) {
      question.setAttribute('student', reports.student);
      const cameTrue = reports.results.get(question.getAttribute('exercise') ?? '');
      const note = document.createElement('p');
      note.textContent = cameTrue === undefined
        ? `${COUNTED[counts]} counts.`
        : `You have answered this question, and your prediction ${cameTrue ? 'came true' : 'did not come true'}. ${COUNTED[counts]} counts.`;
      question.before(note);
    }
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
  // A learning management system takes the answers itself.
  if (reports === undefined) main.append(document.createElement('slam-answers'));
  return exercise.title;
}

async function loadExercises(): Promise<Exercise[]> {
  const response = await fetch(new URL('./exercises.json', import.meta.url)).catch(() => undefined);
  if (response?.ok !== true) throw new Error('The exercises could not be loaded: exercises.json is missing beside embed.html.');
  try {
    return (await response.json()) as Exercise[];
  } catch {
    throw new Error('The exercises could not be loaded: exercises.json arrived incomplete. Reload the page.');
  }
}

const COUNTED: Record<Counts, string> = { best: 'Your best answer', first: 'Your first answer', last: 'Your last answer' };

/** Which of several answers counts: `&counts=best`, `last`, or the first. */
function countsOf(query: string): Counts {
  const counts = new URLSearchParams(query).get('counts');
  return counts === 'best' || counts === 'last' ? counts : 'first';
}

/** Finds the questions for an id, with or without chapter and part. */
function find(exercises: Exercise[], id: string): { exercise: Exercise; questions: Question[] } {
  const matches = (name: string): boolean => name === id || name.replace(/^\d+\./, '') === id;
  for (const exercise of exercises) {
    const questions = exercise.questions.filter((question) => matches(exercise.name) || matches(question.exercise));
    if (questions.length > 0) return { exercise, questions };
  }
  const known = exercises.flatMap(({ questions }) => questions.map(({ exercise }) => exercise)).join(', ');
  throw new Error(`There is no exercise \`${id.slice(0, 60)}\`; there are ${known}.`);
}
