// What the chapter does around its widgets: the choice of light and dark, and wide formulas and
// tables that the keyboard can scroll. The widgets and the numbers that set them are the custom
// element's business.

// @ts-expect-error: a file of its own beside this one, which has the module.
import { core, coreModule } from './slam-widget.js';
import type { Glue } from '../pkg/glue.js';
import { addCopyButtons } from './copy';
import { DecideFigure } from './decide';
import { LapPlayer } from './lap/player';
import type { Story } from './lap/story';
import { LapsFigure } from './laps/laps';
import { SketchFigure, type SketchSchema } from './sketch';

/** The run that the page calls canonical. */
const CANONICAL = { seed: 12648430, noise: 1 };

type ThemeChoice = 'auto' | 'light' | 'dark';

document.documentElement.dataset['script'] = 'on';
listenToThemeButtons();
letKeyboardScroll(document.querySelectorAll<HTMLElement>('.math, .scroll'));
keepFromFiles();
addCopyButtons(document.querySelectorAll<HTMLElement>('figure.listing'));
void replayLap();
driveLaps();
void moveSketches();
void askForLoops();

/** The core, which every picture of the page shares; undefined where it cannot be had. */
function coreIfAny(): Promise<Glue | undefined> {
  return (core as () => Promise<Glue>)().catch(() => undefined);
}

/** The still picture stays where the core cannot be had; the widgets say why. */
async function replayLap(): Promise<void> {
  const figure = document.querySelector<HTMLElement>('#lap');
  const glue = await coreIfAny();
  if (figure === null || glue === undefined) return;
  const { seed, noise } = CANONICAL;
  new LapPlayer(figure, JSON.parse(glue.lapStory(seed, noise)) as Story);
}

/** The sliders of the small figures wait for the core. */
async function moveSketches(): Promise<void> {
  const glue = await coreIfAny();
  if (glue === undefined) return;
  for (const schema of JSON.parse(glue.sketchSchemas()) as SketchSchema[]) {
    const figure = document.querySelector<HTMLElement>(`[data-sketch="${schema.name}"]`);
    if (figure !== null) new SketchFigure(figure, schema, glue);
  }
}

/** Ten loop candidates for the reader to judge. */
async function askForLoops(): Promise<void> {
  const figure = document.querySelector<HTMLElement>('#decide');
  const glue = await coreIfAny();
  if (figure !== null && glue !== undefined) new DecideFigure(figure, glue);
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
