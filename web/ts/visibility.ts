// Whether a widget is near the viewport, in view, or far away.

export interface Visibility {
  near(isNear: boolean): void;
  inView(isInView: boolean): void;
  far(isFar: boolean): void;
}

/** A widget starts within a third of a screen, and releases its context beyond four screens. */
const NEAR_MARGIN = '33% 0px';
const FAR_MARGIN = '400% 0px';

const watched = new WeakMap<Element, Visibility>();

function observer(
  rootMargin: string,
  report: (visibility: Visibility, isInside: boolean) => void,
): () => IntersectionObserver {
  let made: IntersectionObserver | undefined;
  return () =>
    (made ??= new IntersectionObserver(
      (entries) => {
        for (const entry of entries) {
          const visibility = watched.get(entry.target);
          if (visibility !== undefined) report(visibility, entry.isIntersecting);
        }
      },
      { rootMargin },
    ));
}

const observers = [
  observer(FAR_MARGIN, (visibility, isInside) => visibility.far(!isInside)),
  observer(NEAR_MARGIN, (visibility, isInside) => visibility.near(isInside)),
  observer('0px', (visibility, isInside) => visibility.inView(isInside)),
];

export function watchVisibility(element: Element, visibility: Visibility): void {
  watched.set(element, visibility);
  for (const get of observers) get().observe(element);
}

export function unwatchVisibility(element: Element): void {
  watched.delete(element);
  for (const get of observers) get().unobserve(element);
}
