// What the chapter does around its widgets: the choice of light and dark, and wide formulas and
// tables that the keyboard can scroll. The widgets and the numbers that set them are the custom
// element's business.

// @ts-expect-error: a file of its own beside this one, which has the module.
import { core, coreModule } from './slam-widget.js';
import type { Glue } from '../pkg/glue.js';
import { BuildingFigure } from './building/figure';
import type { Building } from './building/drawing';
import { addCopyButtons } from './copy';
import { DecideFigure } from './decide';
import { watchOwnFlat } from './gallery/own';
import { type Places, leadOn } from './places';
import { LapPlayer } from './lap/player';
import type { Story } from './lap/story';
import { LapsFigure } from './laps/laps';
import type { Answer } from './match/drawing';
import { MatchFigure } from './match/figure';
import type { SlamWidget } from '../ts/main';
import { SketchFigure, type SketchSchema } from './sketch';

/** Set by the build: the lap that the page calls canonical, as the core has driven it. */
declare const LAP_STORY_FILE: string;
/** Set by the build: the simulated office. */
declare const BUILDING_FILE: string;
/** Set by the build: where the sweep belongs that the reader moves. */
declare const MATCH_ANSWER: Answer;

/** What needs the program of the widgets. */
const NEEDS_CORE = 'slam-widget, [data-sketch], #decide, #laps';
/** The program is fetched so far before the first of these is seen. */
const FETCH_MARGIN = '200% 0px';

/** Set by the build: where anchors and widgets stand. */
declare const PLACES: Places;

type ThemeChoice = 'auto' | 'light' | 'dark';

leadOn(PLACES);
document.documentElement.dataset['script'] = 'on';
followReading();
listenToThemeButtons();
letKeyboardScroll(document.querySelectorAll<HTMLElement>('.math, .scroll'));
keepFromFiles();
addCopyButtons(document.querySelectorAll<HTMLElement>('figure.listing'));
letReaderMatch();
void replay('#lap', LAP_STORY_FILE, (figure, story: Story) => new LapPlayer(figure, story));
void replay('#building', BUILDING_FILE, (figure, story: Building) => new BuildingFigure(figure, story));
driveLaps();
shareOwnFlat();
whenNear(document.querySelectorAll(NEEDS_CORE), () => void useCore());

function letReaderMatch(): void {
  const figure = document.querySelector<HTMLElement>('#match');
  if (figure !== null) new MatchFigure(figure, MATCH_ANSWER, core as () => Promise<Glue>);
}

/** The still picture stays if the story cannot be had. */
async function replay<T>(name: string, file: string, play: (figure: HTMLElement, story: T) => unknown): Promise<void> {
  const figure = document.querySelector<HTMLElement>(name);
  if (figure === null) return;
  const response = await fetch(new URL(file, import.meta.url)).catch(() => undefined);
  if (response?.ok === true) play(figure, (await response.json()) as T);
}

/** Calls once, when the first of them comes near the screen. */
function whenNear(elements: Iterable<Element>, come: () => void): void {
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
    observer.disconnect();
    come();
  }, { rootMargin: FETCH_MARGIN });
  for (const element of elements) observer.observe(element);
}

/** What the page draws by itself shares one core. Where that cannot be had, the pictures stay, and the widgets say why. */
async function useCore(): Promise<void> {
  const glue = await (core as () => Promise<Glue>)().catch(() => undefined);
  if (glue === undefined) return;
  moveSketches(glue);
  askForLoops(glue);
}

/** The sliders of the small figures wait for the core. */
function moveSketches(glue: Glue): void {
  for (const schema of JSON.parse(glue.sketchSchemas()) as SketchSchema[]) {
    const figure = document.querySelector<HTMLElement>(`[data-sketch="${schema.name}"]`);
    if (figure !== null) new SketchFigure(figure, schema, glue);
  }
}

/** Ten loop candidates for the reader to judge. */
function askForLoops(glue: Glue): void {
  const figure = document.querySelector<HTMLElement>('#decide');
  if (figure !== null) new DecideFigure(figure, glue);
}

/** A thousand laps, once one comes to look at them. */
function driveLaps(): void {
  const figure = document.querySelector<HTMLElement>('#laps');
  if (figure === null) return;
  new LapsFigure(figure, {
    module: coreModule as () => Promise<WebAssembly.Module>,
    driver: async () => new (await (core as () => Promise<Glue>)()).Laps(),
  });
}

/** A flat that the reader has drawn gets a card of its own. */
function shareOwnFlat(): void {
  const lap = document.querySelector<SlamWidget>('slam-widget[name="w16.2"]');
  const gallery = document.querySelector<HTMLElement>('.gallery');
  if (lap !== null && gallery !== null) watchOwnFlat(lap, gallery);
}

/** How far one has read, as a thin bar, and the section as the name of the contents list. */
function followReading(): void {
  const list = document.querySelector<HTMLDetailsElement>('.contents details');
  const summary = list?.querySelector('summary');
  if (list === null || list === undefined || summary === null || summary === undefined) return;
  // At the side it stays open; the page's style knows the width, too.
  const side = matchMedia('(width >= 1280px)');
  const fold = (): void => { list.open = side.matches; };
  side.addEventListener('change', fold);
  fold();
  const bar = document.createElement('div');
  bar.className = 'reading';
  document.body.append(bar);
  const links = [...list.querySelectorAll<HTMLAnchorElement>('a')];
  const targets = links.map(({ hash }) => document.getElementById(hash.slice(1)));
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
    list.parentElement?.classList.toggle('away', !side.matches && scrollTop < clientHeight / 2);
  };
  const wake = (): void => { if (frame === 0) frame = requestAnimationFrame(show); };
  addEventListener('scroll', wake, { passive: true });
  addEventListener('resize', wake);
  show();
  // A sheet closes once one has chosen, pressed Escape or looked elsewhere.
  list.addEventListener('click', ({ target }) => { if (target instanceof HTMLAnchorElement) fold(); });
  document.addEventListener('pointerdown', ({ target }) => { if (!list.contains(target as Node)) fold(); });
  list.addEventListener('keydown', ({ key }) => {
    if (key !== 'Escape' || !list.open || side.matches) return;
    list.open = false;
    summary.focus();
  });
}

/** Scrolls a long list until the link stands in it. */
function keepInView(list: HTMLElement | null, link: HTMLElement | undefined): void {
  if (list === null || link === undefined) return;
  const [{ top, bottom }, room] = [link.getBoundingClientRect(), list.getBoundingClientRect()];
  if (top < room.top || bottom > room.bottom) list.scrollTop += top - room.top - room.height / 3;
}

/** The choice holds until the page is left: it is not worth storing anything on the reader's disk. */
function listenToThemeButtons(): void {
  const buttons = document.querySelectorAll<HTMLButtonElement>('[data-theme-choice]');
  for (const button of buttons) {
    button.addEventListener('click', () => {
      chooseTheme(button.dataset['themeChoice'] as ThemeChoice);
      for (const other of buttons) {
        other.setAttribute('aria-pressed', String(other === button));
      }
    });
  }
}

/** The style and the widgets both follow `data-theme`; without it, the system's choice. */
function chooseTheme(choice: ThemeChoice): void {
  if (choice === 'auto') {
    delete document.documentElement.dataset['theme'];
  } else {
    document.documentElement.dataset['theme'] = choice;
  }
}

/** A log that is dropped beside its widget must not take the place of the page, and of the map that stands there. */
function keepFromFiles(): void {
  for (const type of ['dragover', 'drop'] as const) {
    document.addEventListener(type, (event) => {
      const { dataTransfer } = event;
      if (event.defaultPrevented || dataTransfer?.types.includes('Files') !== true) return;
      event.preventDefault();
      dataTransfer.dropEffect = 'none';
    });
  }
}

/** What is wider than its box can be reached by Tab; what fits is no stop on the way. */
function letKeyboardScroll(boxes: Iterable<HTMLElement>): void {
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
