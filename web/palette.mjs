// The colours of crates/robots/robot_io/palette.json as CSS custom properties.

import { readFileSync } from 'node:fs';

const PALETTE = JSON.parse(readFileSync(new URL('../crates/robots/robot_io/palette.json', import.meta.url), 'utf8'));

/** The shade of each colour, by name, in the theme `light` or `dark`. */
export function shades(theme) {
  return Object.fromEntries(Object.entries(PALETTE).map(([name, pair]) => [name, pair[theme === 'dark' ? 1 : 0]]));
}

/** The style sheet: light, dark by the system's setting, and dark by the reader's choice. */
export function colorStyle() {
  const properties = (theme) => {
    const lines = Object.entries(shades(theme)).map(([name, shade]) => `  --${name}: ${shade};`);
    return [`  color-scheme: ${theme};`, ...lines].join('\n');
  };
  return `:root {
${properties('light')}
}
@media (prefers-color-scheme: dark) {
:root:not([data-theme="light"]) {
${properties('dark')}
}
}
:root[data-theme="dark"] {
${properties('dark')}
}
`;
}
