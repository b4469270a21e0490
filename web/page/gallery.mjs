// The laps that break, as cards: each a picture of the build, a sentence, and a link that sets w16.2 to it.

import { readFileSync } from 'node:fs';

import { escapeHtml } from '../html.mjs';

/** What breaks, and the state in which it does; tests/pinned/page/gallery.rs drives each. */
export const GALLERY = JSON.parse(readFileSync(new URL('./gallery.json', import.meta.url), 'utf8'));

/** Fills `<ul class="gallery"></ul>`. */
export function addGallery(html) {
  return html.replace('<ul class="gallery"></ul>', `<ul class="gallery">${GALLERY.map(card).join('')}
  </ul>`);
}

function card({ id, title, caption, state }) {
  const href = escapeHtml(`?w=16.2&${state}`);
  return `
    <li class="card">
      <img src="pictures/break-${id}.svg" width="320" height="240" alt="" loading="lazy">
      <p class="card-title"><a class="slam-link" href="${href}">${title}</a></p>
      <p>${caption}</p>
    </li>`;
}
