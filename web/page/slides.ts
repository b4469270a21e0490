// Turns the slides of slides.html, and keeps the window of the speaker's notes on the same slide.

/** The messages between the windows: the number of the slide. Without them each window turns by itself. */
const channel = 'BroadcastChannel' in window ? new BroadcastChannel('slides') : undefined;
const slides = [...document.querySelectorAll<HTMLElement>('main > section')];
const hasNotes = new URLSearchParams(location.search).has('notes');
const count = document.querySelector<HTMLElement>('.turn output');
let at = 0;

/** The heading of a slide, as text. */
function titleOf(slide: HTMLElement | undefined): string {
  return slide?.querySelector('h1')?.textContent ?? 'the end';
}

function show(number: number): void {
  // An address may hold anything.
  at = Math.max(0, Math.min(Math.trunc(number) || 0, slides.length - 1));
  for (const [k, slide] of slides.entries()) slide.classList.toggle('shown', k === at);
  if (count !== null) count.textContent = `${at + 1} of ${slides.length}`;
  history.replaceState(null, '', `${location.search}#${at + 1}`);
  if (hasNotes) showNotes();
  else {
    scrollTo(0, 0);
    fitWidget();
  }
}

/** What a picture leaves free: its rows end at whole pixels, and the text above may still grow, px. */
const SLACK_PX = 24;

/** Leaves a widget the height below the text of its slide. */
function fitWidget(): void {
  const widget = slides[at]?.querySelector<HTMLElement>(':scope > slam-widget');
  widget?.style.setProperty('--room', `${innerHeight - widget.getBoundingClientRect().top - SLACK_PX}px`);
}

/** Gives the pictures what the controls leave, which are higher once they are filled. */
async function watchControls(): Promise<void> {
  await customElements.whenDefined('slam-widget');
  // Not within the observer's call: what it causes is another change of size.
  const bars = new ResizeObserver(() => requestAnimationFrame(() => dispatchEvent(new Event('resize'))));
  for (const { shadowRoot } of document.querySelectorAll('slam-widget')) {
    const bar = shadowRoot?.querySelector('[part="bar"]');
    if (bar) bars.observe(bar);
  }
}

/** The note of the slide, and what follows. */
function showNotes(): void {
  const put = (css: string, ...parts: (Node | string)[]): void => document.querySelector(css)?.replaceChildren(...parts);
  const slide = slides[at];
  const note = slide?.querySelector<HTMLTemplateElement>('template.note');
  put('.speaker .now', `${at + 1} of ${slides.length}: ${titleOf(slide)}`);
  put('.speaker .note', note?.content.cloneNode(true) ?? 'No note.');
  put('.speaker .then', `Next: ${titleOf(slides[at + 1])}`);
}

/** Turns to a slide in all windows. */
function turn(number: number): void {
  show(number);
  channel?.postMessage(at);
  if (hasNotes) return;
  // A screen reader reads the new slide from its heading.
  const heading = slides[at]?.querySelector<HTMLElement>('h1');
  heading?.setAttribute('tabindex', '-1');
  heading?.focus({ preventScroll: true });
}

function openNotes(): void {
  open(`?notes#${at + 1}`, 'notes', 'popup,width=700,height=600');
}

/** What a key does; widgets and fields keep the arrow keys. */
function press(event: KeyboardEvent): void {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const isHeld = (event.target as Element).closest('slam-widget, slam-predict, input, button, a') !== null;
  const acts: Record<string, () => void> = {
    PageDown: () => turn(at + 1),
    PageUp: () => turn(at - 1),
    ...(isHeld
      ? {}
      : {
          ArrowRight: () => turn(at + 1),
          ArrowLeft: () => turn(at - 1),
          ' ': () => turn(at + (event.shiftKey ? -1 : 1)),
          Home: () => turn(0),
          End: () => turn(slides.length - 1),
          n: openNotes,
        }),
  };
  const act = acts[event.key];
  if (act === undefined) return;
  event.preventDefault();
  act();
}

document.body.classList.add('deck');
if (hasNotes) {
  document.body.classList.add('notes');
  document.querySelector<HTMLElement>('.speaker')?.removeAttribute('hidden');
  document.title = `Notes: ${document.title}`;
}
for (const button of document.querySelectorAll<HTMLElement>('[data-turn]')) {
  button.addEventListener('click', () => turn(at + Number(button.dataset['turn'])));
}
document.querySelector('[data-notes]')?.addEventListener('click', openNotes);
// Before the widgets: a presenter's remote control sends Page Down, wherever the focus is.
addEventListener('keydown', press, { capture: true });
const showAddress = (): void => show(Number(location.hash.slice(1)) - 1);
addEventListener('hashchange', showAddress);
// Before the widgets, which read the height that they have: this script stands before theirs.
addEventListener('resize', fitWidget);
void watchControls();
channel?.addEventListener('message', ({ data }) => show(Number(data)));
showAddress();
