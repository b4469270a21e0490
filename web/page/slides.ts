// slides.html: keys that turn the slides, and the speaker's view, `?notes`, which shows the script of the present slide in
// a second window. The windows tell each other the slide over a channel; whichever turns, the other follows.

const slides = [...document.querySelectorAll<HTMLElement>('main > section')];
const isNotes = new URLSearchParams(location.search).has('notes');
const channel = new BroadcastChannel('slam-slides');
let present = 0;

document.documentElement.classList.toggle('notes', isNotes);
channel.addEventListener('message', ({ data }: MessageEvent<unknown>) => show(Number(data)));
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const step = { ArrowRight: 1, PageDown: 1, ArrowLeft: -1, PageUp: -1 }[event.key];
  // In a widget or a question the keys are theirs.
  const isFree = document.activeElement === document.body || document.activeElement?.matches('main > section') === true;
  if (step === undefined || !isFree) return;
  event.preventDefault();
  turn(present + step);
});

if (isNotes) {
  show(0);
} else {
  // A reader may scroll, too: the slide that fills most of the screen is the present one.
  const observer = new IntersectionObserver((entries) => {
    const seen = entries.find(({ isIntersecting }) => isIntersecting);
    if (seen === undefined) return;
    present = slides.indexOf(seen.target as HTMLElement);
    channel.postMessage(present);
  }, { threshold: 0.6 });
  for (const slide of slides) observer.observe(slide);
}

function turn(to: number): void {
  show(to);
  channel.postMessage(present);
}

/** Scrolls to a slide, or shows its script alone. */
function show(to: number): void {
  present = Math.min(Math.max(Math.trunc(to) || 0, 0), slides.length - 1);
  if (!isNotes) {
    slides[present]?.scrollIntoView({ behavior: 'instant' });
    return;
  }
  for (const [at, slide] of slides.entries()) {
    slide.hidden = at !== present;
    for (const script of slide.querySelectorAll('details')) script.open = true;
  }
}
