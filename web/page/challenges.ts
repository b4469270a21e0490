// The challenges: each sees when the reader meets it, ticks itself, and stays ticked. The number met stands in the
// contents list, and is kept in the browser if the reader asks for it.

// @ts-expect-error: a separate bundle, which contains the module.
import { core } from './slam-widget.js';
import type { Glue } from '../pkg/glue.js';
import { holds } from './holds';
import type { SlamWidget } from '../ts/main';
import type { Outcome } from '../ts/instance';
import type { Value } from '../ts/values';

const STORAGE_KEY = 'slam-challenges';

interface Result {
  value: Record<string, Value>;
  outcome: Outcome;
}

/** Names of the met challenges, each with the state that met it, or an empty text. */
const met = new Map<string, string>(kept());

/** Lets the challenges of this page watch their widgets. */
export function watchChallenges(): void {
  for (const challenge of document.querySelectorAll<HTMLElement>('.challenge')) {
    const state = met.get(nameOf(challenge));
    if (state !== undefined) tick(challenge, 'Met before.', state);
    watch(challenge);
  }
  showScore();
  const box = scoreBox()?.querySelector('input');
  if (box === null || box === undefined) return;
  box.checked = isKept();
  box.addEventListener('change', () => {
    if (box.checked) store();
    else forget();
  });
}

function watch(challenge: HTMLElement): void {
  const { widget: id, holds: condition } = challenge.dataset;
  if (id === undefined || condition === undefined) {
    document.addEventListener('slam-decided', () => meet(challenge, 'All judged correctly.', ''));
    return;
  }
  const widget = document.querySelector<SlamWidget>(`slam-widget[name="${id}"]`);
  widget?.addEventListener('slam-result', (event) => {
    const { value, outcome } = (event as CustomEvent<Result>).detail;
    if (met.has(nameOf(challenge)) || isShown(id, value) || !holds(condition, outcome, value)) return;
    const sentence = outcome.sentence;
    const { query } = widget;
    void alsoHolds(challenge, id, value).then((also) => {
      if (also) meet(challenge, sentence, query);
    });
  });
}

/** Whether a link in the text shows this state: a reader who follows it has met nothing. */
function isShown(id: string, value: Record<string, Value>): boolean {
  const links = document.querySelectorAll<HTMLAnchorElement>('a.slam-link:not(.challenge a)');
  return [...links].some(({ search }) => {
    const query = new URLSearchParams(search);
    if (`w${query.get('w')}` !== id) return false;
    query.delete('w');
    query.delete('more');
    return [...query].every(([name, text]) => String(value[name]) === text || (value[name] === true && text === 'on'));
  });
}

/** Whether the same state with other parameters ends as the challenge wants: `data-unlike="variant=point-to-point"`. */
async function alsoHolds({ dataset }: HTMLElement, id: string, value: Record<string, Value>): Promise<boolean> {
  const { unlike, unlikeHolds } = dataset;
  if (unlike === undefined || unlikeHolds === undefined) return true;
  const glue = await (core as () => Promise<Glue>)();
  const other = new glue.Widget(id);
  try {
    const texts = Object.entries(value).map(([name, it]): [string, string] => [name, it === true ? 'on' : it === false ? 'off' : String(it)]);
    for (const [name, text] of [...texts, ...new URLSearchParams(unlike)]) other.set(name, text);
    other.finish_work();
    return holds(unlikeHolds, JSON.parse(other.outcome()) as Outcome, value);
  } finally {
    other.free();
  }
}

function meet(challenge: HTMLElement, sentence: string, state: string): void {
  const name = nameOf(challenge);
  if (met.has(name)) return;
  met.set(name, state);
  tick(challenge, sentence, state);
  if (isKept()) store();
  showScore();
}

/** Shows that a challenge is met, with a sentence and a link to how. */
function tick(challenge: HTMLElement, sentence: string, state: string): void {
  if (challenge.classList.contains('met')) return;
  challenge.classList.add('met');
  const says = document.createElement('span');
  says.className = 'challenge-says';
  says.setAttribute('role', 'status');
  challenge.append(says);
  // A live region announces what changes in it.
  says.append(` ${sentence.split('. ')[0]?.replace(/[.]?$/, '.') ?? ''} `);
  if (state === '') return;
  const link = document.createElement('a');
  link.className = 'slam-link';
  link.href = state;
  link.textContent = 'Show it again';
  says.append(link);
}

/** A name that stays if challenges before it come and go. */
function nameOf({ dataset }: HTMLElement): string {
  return `${dataset['widget'] ?? 'decide'} ${dataset['holds'] ?? ''}`.trim();
}

function scoreBox(): HTMLElement | null {
  return document.querySelector<HTMLElement>('.score');
}

function showScore(): void {
  const box = scoreBox();
  const count = box?.querySelector('output');
  if (box === null || count === null || count === undefined) return;
  box.hidden = met.size === 0;
  count.textContent = `${met.size} of ${box.dataset['all']}`;
}

function kept(): [string, string][] {
  try {
    const read: unknown = JSON.parse(localStorage.getItem(STORAGE_KEY) ?? '[]');
    const isPair = (one: unknown): one is [string, string] => Array.isArray(one) && one.length === 2 && one.every((text) => typeof text === 'string');
    // A state is only ever a query of this page.
    return Array.isArray(read) ? read.filter(isPair).filter(([, state]) => state === '' || state.startsWith('?')) : [];
  } catch {
    return [];
  }
}

function isKept(): boolean {
  try {
    return localStorage.getItem(STORAGE_KEY) !== null;
  } catch {
    return false;
  }
}

function store(): void {
  try {
    localStorage.setItem(STORAGE_KEY, JSON.stringify([...met]));
  } catch {
    // They last until the page is left.
  }
}

function forget(): void {
  try {
    localStorage.removeItem(STORAGE_KEY);
  } catch {
    // Nothing was stored.
  }
}
