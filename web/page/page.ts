// The page outside of its widgets: figures, contents list, theme buttons, and scrolling by keyboard. The custom element
// handles the widgets and the links that set them.

// @ts-expect-error: a separate bundle, which contains the module.
import { core, coreModule } from './slam-widget.js';
import type { Glue } from '../pkg/glue.js';
import { BuildingFigure } from './building/figure';
import type { Building } from './building/drawing';
import { watchChallenges } from './challenges';
import { addCopyButtons } from './copy';
import { DecideFigure } from './decide';
import { startGame } from './gallery/game';
import { watchOwnFlat } from './gallery/own';
import { type Places, redirectOldAddress } from './redirects';
import { LapsFigure } from './laps/laps';
import { LEVELS_PLAN } from './laps/levels';
import { MatchersFigure } from './laps/matchers';
import { lightLines } from './lap/lines';
import type { Answer } from './match/drawing';
import { MatchFigure } from './match/figure';
import type { SlamWidget } from '../ts/main';
import { reveal } from '../ts/reveal';
import { replaceMissingPopovers } from './popovers';
import { startReplay } from './replay';
import { SketchFigure, type SketchSchema } from './sketch';
import { chosenTheme, keepTheme, showTheme, type ThemeChoice } from './theme-choice';

/** Set by the build: the simulated office. */
declare const BUILDING_FILE: string;
/** Set by the build: the true pose of the sweep that the reader moves. */
declare const MATCH_ANSWER: Answer;

const loadCore = core as () => Promise<Glue>;
const loadModule = coreModule as () => Promise<WebAssembly.Module>;

/** Elements that need the module of the widgets. */
const NEEDS_CORE = 'slam-widget, [data-sketch], #decide, .laps';
/** Distance from the viewport at which the module is prefetched. */
const PREFETCH_MARGIN = '100% 0px';

/** Set by the build: the page of each anchor and widget. */
declare const PLACES: Places;

redirectOldAddress(PLACES);
replaceMissingPopovers();
openAddressedExercise();
addEventListener('hashchange', openAddressedExercise);
trackReading();
listenToThemeButtons();
makeScrollableFocusable(document.querySelectorAll<HTMLElement>('.math, .scroll'));
ignoreStrayDrops();
listenToEditors();
addCopyButtons(document.querySelectorAll<HTMLElement>('figure.listing'));
startMatchFigure();
void startReplay('#building', BUILDING_FILE, (figure, story: Building) => new BuildingFigure(figure, story));
startLapsFigures();
lightLines();
startFlatGame();
watchChallenges();
letOpenWidgetsScroll();
// The widgets report why it is unavailable.
onceNear(document.querySelectorAll(NEEDS_CORE), () => void loadModule().catch(() => {}));
startCoreFigures();

/** Opens the exercise that the address names. */
function openAddressedExercise(): void {
  const fold = document.getElementById(location.hash.slice(1))?.querySelector(':scope.exercise > details');
  if (fold) reveal(fold);
}

/** Loads the editor when the first place to write is opened. */
function listenToEditors(): void {
  for (const details of document.querySelectorAll<HTMLDetailsElement>('details[data-write]')) {
    details.addEventListener('toggle', () => {
      // @ts-expect-error: a separate bundle.
      if (details.open) void import('./write-yourself.js').then(({ open }: { open(place: HTMLElement): void }) => open(details), () => sayNoEditor(details));
    });
  }
}

/** Says that the editor did not load, once. */
function sayNoEditor(details: HTMLDetailsElement): void {
  if (details.querySelector('.no-editor') !== null) return;
  const line = document.createElement('p');
  line.className = 'no-editor';
  line.textContent = 'The editor could not be loaded. Check your connection, and reload the page.';
  details.append(line);
}

function startMatchFigure(): void {
  const figure = document.querySelector<HTMLElement>('#match');
  if (figure !== null) new MatchFigure(figure, MATCH_ANSWER, loadCore);
}

/** Calls back once, when the first of the elements comes near the viewport. */
function onceNear(elements: Iterable<Element>, callback: () => void): void {
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
    observer.disconnect();
    callback();
  }, { rootMargin: PREFETCH_MARGIN });
  for (const element of elements) observer.observe(element);
}

/** Starts the figures that share one core, each once it is near. If it is unavailable, the still pictures stay. */
function startCoreFigures(): void {
  const load = async () => {
    const glue = await loadCore();
    return { glue, schemas: JSON.parse(glue.sketchSchemas()) as SketchSchema[] };
  };
  let shared: ReturnType<typeof load> | undefined;
  for (const figure of document.querySelectorAll<HTMLElement>('[data-sketch], #decide')) {
    onceNear([figure], () => void (shared ??= load()).then(({ glue, schemas }) => {
      const schema = schemas.find(({ name }) => name === figure.dataset['sketch']);
      if (schema !== undefined) new SketchFigure(figure, schema, glue);
      else if (figure.id === 'decide') new DecideFigure(figure, glue);
    }, () => {}));
  }
}

function startLapsFigures(): void {
  const lapCore = {
    module: loadModule,
    runner: async () => new (await loadCore()).LapOutcomes(),
  };
  const [levels, matchers] = ['#laps', '#matcher-laps'].map((id) => document.querySelector<HTMLElement>(id));
  if (levels) new LapsFigure(levels, lapCore, LEVELS_PLAN);
  if (matchers) new MatchersFigure(matchers, lapCore);
}

/** A widget beside its text stays in view. With More it is higher than the screen, and scrolls with the page. */
function letOpenWidgetsScroll(): void {
  const show = (widget: SlamWidget): void => {
    const { top } = widget.getBoundingClientRect();
    widget.style.removeProperty('--moved');
    widget.classList.toggle('open', widget.get('more') === true);
    const moved = top - widget.getBoundingClientRect().top;
    if (widget.classList.contains('open')) widget.style.setProperty('--moved', `${Math.max(moved, 0)}px`);
  };
  for (const widget of document.querySelectorAll<SlamWidget>('.beside > slam-widget')) {
    if (widget.get('more') === true) show(widget);
    widget.addEventListener('slam-change', (event) => {
      if ((event as CustomEvent<{ parameter: string }>).detail.parameter === 'more') show(widget);
    });
  }
}

/** The game: tools, and a card for a flat that the reader has drawn. */
function startFlatGame(): void {
  const lap = document.querySelector<SlamWidget>('slam-widget[name="w16.2"]');
  const [game, gallery, says, off] = ['.game', '.gallery', '.game-says', '.game-off'].map((css) => document.querySelector<HTMLElement>(css));
  if (lap === null || !game || !gallery || !says || !off) return;
  startGame(game, lap);
  watchOwnFlat(lap, gallery, says, off);
}

/** Shows the reading progress as a thin bar, and the current section in the contents list. */
function trackReading(): void {
  const list = document.querySelector<HTMLDetailsElement>('.contents details');
  const summary = list?.querySelector('summary');
  if (list === null || list === undefined || summary === null || summary === undefined) return;
  // The side bar stays open. style/navigation.css has the same width.
  const side = matchMedia('(width >= 80rem)');
  const fold = (): void => { list.open = side.matches; };
  side.addEventListener('change', fold);
  fold();
  const bar = document.createElement('div');
  bar.className = 'reading';
  document.body.append(bar);
  const links = [...list.querySelectorAll<HTMLAnchorElement>('a')];
  const targets = links.map(({ hash }) => document.getElementById(hash.slice(1)));
  /** The widgets at the bottom of the screen. */
  const low = new Set<Element>();
  let frame = 0;
  const show = (): void => {
    frame = 0;
    const { scrollHeight, scrollTop, clientHeight } = document.documentElement;
    bar.style.setProperty('--read', String(scrollTop / Math.max(scrollHeight - clientHeight, 1)));
    const here = links[targets.findLastIndex((target) => (target?.getBoundingClientRect().top ?? Infinity) < clientHeight / 3)];
    for (const link of links) {
      if (link === here) link.setAttribute('aria-current', 'location');
      else link.removeAttribute('aria-current');
    }
    if (side.matches) keepInView(list.parentElement, here);
    summary.textContent = here?.textContent ?? 'Contents';
    const isFirstScreen = scrollTop < clientHeight / 2;
    list.parentElement?.classList.toggle('away', !side.matches && !list.open && (isFirstScreen || low.size > 0));
  };
  const wake = (): void => { if (frame === 0) frame = requestAnimationFrame(show); };
  // As high as the bar.
  const bottom = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) low.add(target);
      else low.delete(target);
    }
    wake();
  }, { rootMargin: '-95% 0px 0px' });
  for (const widget of document.querySelectorAll('slam-widget')) bottom.observe(widget);
  addEventListener('scroll', wake, { passive: true });
  addEventListener('resize', wake);
  show();
  // On narrow screens the list is a sheet: a choice, Escape or a press outside closes it.
  list.addEventListener('click', ({ target }) => { if (target instanceof HTMLAnchorElement) fold(); });
  document.addEventListener('pointerdown', ({ target }) => { if (!list.contains(target as Node)) fold(); });
  list.addEventListener('keydown', ({ key }) => {
    if (key !== 'Escape' || !list.open || side.matches) return;
    list.open = false;
    summary.focus();
  });
}

/** Scrolls a long list until the link is visible. */
function keepInView(list: HTMLElement | null, link: HTMLElement | undefined): void {
  if (list === null || link === undefined) return;
  const [{ top, bottom }, room] = [link.getBoundingClientRect(), list.getBoundingClientRect()];
  if (top < room.top || bottom > room.bottom) list.scrollTop += top - room.top - room.height / 3;
}

function listenToThemeButtons(): void {
  const buttons = document.querySelectorAll<HTMLButtonElement>('[data-theme-choice]');
  const show = (choice: ThemeChoice): void => {
    showTheme(choice);
    for (const button of buttons) button.setAttribute('aria-pressed', String(button.dataset['themeChoice'] === choice));
  };
  show(chosenTheme());
  for (const button of buttons) {
    button.addEventListener('click', () => {
      const choice = button.dataset['themeChoice'] as ThemeChoice;
      keepTheme(choice);
      show(choice);
    });
  }
}

/** Ignores a file that is dropped outside of a widget: the browser would navigate to it, and the reader's map be lost. */
function ignoreStrayDrops(): void {
  for (const type of ['dragover', 'drop'] as const) {
    document.addEventListener(type, (event) => {
      const { dataTransfer } = event;
      if (event.defaultPrevented || dataTransfer?.types.includes('Files') !== true) return;
      event.preventDefault();
      dataTransfer.dropEffect = 'none';
    });
  }
}

/** Makes a box focusable while its content overflows: arrow keys then scroll it. */
function makeScrollableFocusable(boxes: Iterable<HTMLElement>): void {
  const observer = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      const box = target as HTMLElement;
      if (box.scrollWidth > box.clientWidth) {
        box.tabIndex = 0;
      } else {
        box.removeAttribute('tabindex');
      }
    }
  });
  for (const box of boxes) observer.observe(box);
}
