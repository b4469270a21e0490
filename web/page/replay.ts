// Starts a replay from data that the build computed.

/** The content of a file; undefined if it does not arrive as a whole, for instance because the reader leaves the page. */
async function readJson<T>(file: URL): Promise<T | undefined> {
  try {
    const response = await fetch(file);
    return response.ok ? ((await response.json()) as T) : undefined;
  } catch {
    return undefined;
  }
}

/** Starts a replay; if its data are unavailable, the still picture stays. */
export async function startReplay<T>(name: string, file: string, play: (figure: HTMLElement, story: T) => unknown): Promise<void> {
  const figure = document.querySelector<HTMLElement>(name);
  if (figure === null) return;
  const story = await readJson<T>(new URL(file, import.meta.url));
  if (story !== undefined) play(figure, story);
}
