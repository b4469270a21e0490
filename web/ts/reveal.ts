// Folded text that a link leads to.

/** Opens every fold around an element, itself included. */
export function reveal(element: Element): void {
  for (let fold = element.closest('details'); fold; fold = fold.parentElement?.closest('details') ?? null) fold.open = true;
}
