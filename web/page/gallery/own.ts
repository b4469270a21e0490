// The reader's own flat as a card: shown once its lap is over, to be copied as a link or saved as a picture.

import type { SlamWidget } from '../../ts/main';
import { copyText, pngOfSvg, saveBlob, send } from '../../ts/export';
import { drawing, HEIGHT, isOffOnTheWay, isUnnoticed, metresOff, numbers, WIDTH, type Facts } from './drawing';

/** Scale of a saved picture. */
const SAVED_SCALE = 3;
/** Side of a square of the map, which is no file to fetch. */
const CELL_PX = 1;
/** A robot that ends nearer than this has come home, m. */
const HOME_M = 0.5;

/** What `slam-result` tells. */
interface Result {
  readonly name: string;
  readonly outcome: { readonly verdict: string; readonly sentence: string; readonly facts: Facts };
}

/** What `slam-change` tells. */
interface Change {
  readonly parameter: string;
  readonly outcome?: Result['outcome'];
}

/** The verdict on a flat with a goal out of reach, or a start in a wall. */
const UNDRIVEABLE = 'cannot be driven';

/** Counts the error while a lap runs, shows the score at its end, and for a drawn flat a card before the gallery. */
export function watchOwnFlat(widget: SlamWidget, gallery: HTMLElement, says: HTMLElement, off: HTMLElement): void {
  const card = document.createElement('aside');
  card.className = 'card own-card';
  card.setAttribute('aria-label', 'Your flat');
  card.hidden = true;
  gallery.before(card);
  let asked = 0;
  let record = 0;
  const count = ({ verdict, facts }: Result['outcome']): void => {
    const [now, end] = [Number(widget.value['t']), widget.timeline?.last ?? 0];
    off.hidden = verdict === UNDRIVEABLE || now === 0;
    const score = `${isOffOnTheWay(facts) ? 'typically ' : ''}${metresOff(facts).toFixed(1)} m off`;
    off.textContent = now < end ? `${(facts['graph_error_m'] ?? 0).toFixed(1)} m off now` : score;
  };
  const show = async (outcome: Result['outcome']): Promise<void> => {
    const { facts } = outcome;
    const { value, timeline } = widget;
    const isDriveable = outcome.verdict !== UNDRIVEABLE;
    const isOver = isDriveable && timeline !== null && Number(value['t']) >= timeline.last;
    asked += 1;
    const ask = asked;
    const isShown = value['world'] === 'own' && value['flat'] !== '' && isOver;
    count(outcome);
    const svg = isShown ? drawing(await widget.tables(), facts, CELL_PX) : '';
    // Another result may have come meanwhile.
    if (ask !== asked) return;
    card.hidden = !isShown;
    says.textContent = isDriveable ? '' : withCapital(outcome.sentence);
    says.classList.toggle('undriveable', !isDriveable);
    if (!isOver) return;
    const points = score(facts);
    record = Math.max(record, points);
    const [title, words] = [`Score ${points.toFixed(1)}, best ${record.toFixed(1)}`, sentence(facts)];
    const { notice, hint } = remark(facts);
    says.textContent = `${notice} Your record: ${record.toFixed(1)} m. ${hint}`;
    if (isShown) fill(card, widget, svg, title, words);
  };
  widget.addEventListener('slam-change', (event) => {
    const { parameter, outcome } = (event as CustomEvent<Change>).detail;
    if (parameter === 't' && outcome !== undefined) count(outcome);
  });
  widget.addEventListener('slam-result', (event) => void show((event as CustomEvent<Result>).detail.outcome));
}

/** The metres that the robot is off while its map agrees with itself; nothing for an error that the map shows. */
function score(facts: Facts): number {
  return isUnnoticed(facts) ? metresOff(facts) : 0;
}

function sentence(facts: Facts): string {
  const { off, agrees } = numbers(facts);
  const isHome = metresOff(facts) < HOME_M;
  const lead = isHome ? 'Not broken yet: the robot' : 'The robot';
  return `${lead} ${off.startsWith('ends') ? '' : 'is '}${off}${agrees === '' ? '' : `, and its ${agrees}`}.`;
}

/** Whether anything warns the robot of the error, which is in large figures, and how to make it worse. */
function remark(facts: Facts): { notice: string; hint: string } {
  const { agrees } = numbers(facts);
  if (agrees === '') return { notice: 'Nothing is seen twice, which scores nothing.', hint: 'Let the robot come back.' };
  if (!isUnnoticed(facts)) return { notice: `Noticed: the ${agrees}, which scores nothing.`, hint: 'Let the robot see no room twice.' };
  const isHome = metresOff(facts) < HOME_M;
  const change = isHome ? 'rub out doors and corners, so that the walls look the same everywhere' : 'draw longer walls without doors or corners';
  return { notice: `The map does not warn the robot: its ${agrees}, wrong on both passes.`, hint: `Make it worse: ${change}.` };
}

function withCapital(words: string): string {
  return `${words.charAt(0).toUpperCase()}${words.slice(1)}`;
}

function fill(card: HTMLElement, widget: SlamWidget, svg: string, points: string, words: string): void {
  const source = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  const png = (): Promise<File> => pngOfSvg(svg, { width: SAVED_SCALE * WIDTH, height: SAVED_SCALE * HEIGHT }, 'my-flat');
  const picture = document.createElement('img');
  Object.assign(picture, { src: source, width: WIDTH, height: HEIGHT, alt: '' });
  const title = document.createElement('p');
  title.className = 'card-title';
  title.textContent = points;
  const says = document.createElement('p');
  says.textContent = words;
  const status = document.createElement('p');
  status.setAttribute('role', 'status');
  const button = (label: string, press: () => Promise<string>): HTMLElement => {
    const made = document.createElement('button');
    made.type = 'button';
    made.textContent = label;
    made.addEventListener('click', () => {
      press().then((said) => (status.textContent = said), (error: Error) => (status.textContent = `${label} failed: ${error.message}.`));
    });
    return made;
  };
  const buttons = document.createElement('div');
  buttons.className = 'decide-buttons';
  buttons.append(
    button('Send', async () => send(await png(), widget.link)),
    button('Copy link', async () => ((await copyText(widget.link)) ? 'The link is copied.' : widget.link)),
    button('Save picture', async () => {
      const file = await png();
      saveBlob(file, file.name);
      return 'The picture is saved.';
    }),
  );
  card.replaceChildren(picture, title, says, buttons, status);
}
