// The style of the shadow tree. The page sets width and margins of the element.

import { accent, bad, fair, faint, good, ink, measurement, paper, prior, soft } from '../../widgets/palette.json';

export const STYLE = `
:host { display: block; position: relative; color-scheme: light; }
:host([hidden]) { display: none; }
.frame { --paper: ${paper[0]}; --ink: ${ink[0]}; --soft: ${soft[0]}; --line: ${faint[0]}; --accent: ${accent[0]};
  --good: ${good[0]}; --fair: ${fair[0]}; --bad: ${bad[0]}; --older: ${prior[0]}; --newer: ${measurement[0]};
  background: var(--paper); color: var(--ink); font: 0.875rem/1.4 system-ui, sans-serif;
  border: 1px solid var(--line); border-radius: 6px; outline: none; }
.frame.dark { --paper: ${paper[1]}; --ink: ${ink[1]}; --soft: ${soft[1]}; --line: ${faint[1]}; --accent: ${accent[1]};
  --good: ${good[1]}; --fair: ${fair[1]}; --bad: ${bad[1]}; --older: ${prior[1]}; --newer: ${measurement[1]};
  color-scheme: dark; }
.stage { position: relative; overflow: hidden; border-radius: 6px 6px 0 0; min-height: 12rem; height: var(--reserved-height); }
.stage.live { min-height: 0; height: auto; }
.picture { display: block; width: 100%; height: auto; }
.stage[style*='--reserved-height'] .picture { height: 100%; object-fit: contain; object-position: top; }
canvas { display: block; width: 100%; touch-action: pan-y pinch-zoom; outline: none; }
.frame.takes-files canvas { touch-action: pan-y; }
.frame.dropping { border-color: var(--accent); box-shadow: 0 0 0 3px var(--accent); }
.pinned { position: fixed; top: 0; z-index: 3; pointer-events: none; background: var(--paper);
  border-bottom: 2px solid var(--accent); border-radius: 0 0 8px 8px; box-shadow: 0 3px 10px #0005; touch-action: auto; }
.stage.waiting canvas { position: absolute; inset: 0; visibility: hidden; }
.stage.live .picture { display: none; }
progress { position: absolute; inset: auto 0 0 0; width: 100%; height: 4px; accent-color: var(--accent); }
.note { margin: 0; padding: 0.5rem 0.75rem; border-top: 1px solid var(--line); overflow-wrap: anywhere; }
.note pre { max-height: 10rem; overflow: auto; white-space: pre-wrap; font-size: 0.75rem; }
.note:empty { display: none; }
.doctor { padding: 0.5rem 0.75rem; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
.doctor summary { cursor: pointer; font-weight: 600; }
.doctor ul { list-style: none; margin: 0.4rem 0; padding: 0; display: grid; gap: 0.35rem; }
.doctor li { display: grid; grid-template-columns: 1.25rem 1fr; }
.doctor li button { margin: 0.15rem 0; }
.doctor .sign { font-weight: 700; color: var(--good); }
.doctor .mended .sign { color: var(--fair); }
.doctor .wrong .sign { color: var(--bad); }
.doctor p { margin: 0.4rem 0; }
.doctor p:empty { display: none; }
.doctor form { display: flex; flex-wrap: wrap; gap: 0.35rem 0.75rem; align-items: center; }
.doctor label { display: inline-flex; gap: 0.35rem; align-items: center; }
.doctor input[type='number'] { width: 5.5rem; }
.loops { padding: 0.5rem 0.75rem; border-top: 1px solid var(--line); }
.loops p { margin: 0; }
.loops .question { font-weight: 600; color: var(--fair); }
.loops ul { list-style: none; margin: 0.5rem 0; padding: 0; display: grid; gap: 0.75rem;
  grid-template-columns: repeat(auto-fill, minmax(9rem, 1fr)); }
.loops li { display: flex; flex-wrap: wrap; gap: 0.35rem; align-content: start; max-width: 12rem; }
.loops li[aria-busy] { opacity: 0.5; }
.loops button:has(svg) { flex: 1 0 100%; padding: 0; }
.loops svg { display: block; width: 100%; aspect-ratio: 1; }
.loops path { fill: none; stroke-width: 2; stroke-linecap: round; vector-effect: non-scaling-stroke; }
.loops .older { stroke: var(--older); }
.loops .newer { stroke: var(--newer); }
.loops span { flex: 1 0 100%; color: var(--soft); font-size: 0.8125rem; }
.bar { position: relative; background: var(--paper);
  border-top: 1px solid var(--line); border-radius: 0 0 6px 6px; min-height: 2.75rem; }
/* The line of the focused control stays in view at any scroll position. */
.bar:has(.control:focus-within) { position: sticky; bottom: 0; z-index: 1; }
.tools, .tools :is([open], div) { display: flex; flex-wrap: wrap; gap: 0.5rem; align-items: center; }
.tools { padding: 0.4rem 0.75rem; }
.tools summary { box-sizing: border-box; list-style: none; cursor: pointer; }
button, .tools summary, select, input[type='number'] { font: inherit; color: inherit; background: var(--paper);
  border: 1px solid var(--soft); border-radius: 4px; min-height: 1.75rem; padding: 0.1rem 0.6rem; }
button { cursor: pointer; }
:is(button, .tools summary):hover { border-color: var(--accent); }
button[aria-disabled='true'] { color: var(--soft); border-color: var(--line); cursor: default; }
:focus-visible:not(.frame) { outline: 3px solid var(--accent); outline-offset: 2px; }
input[type='number'] { width: 8rem; }
input[type='range'] { flex: 1 1 8rem; min-width: 3rem; min-height: 1.75rem; accent-color: var(--accent); }
input[type='checkbox'] { width: 1.5rem; height: 1.5rem; accent-color: var(--accent); }
.control:not(:focus-within), .hidden { position: absolute; width: 1px; height: 1px; margin: -1px;
  overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
/* Covers the tools to avoid a layout shift under the reader's finger. */
.control:focus-within { position: absolute; inset: 0; z-index: 1; display: flex; flex-direction: column;
  justify-content: center; line-height: 1.15; padding: 0 0.75rem; background: var(--paper); border-radius: 0 0 6px 6px; }
[hidden] { display: none !important; }
.line { display: flex; gap: 0.5rem; align-items: center; min-width: 0; }
.name, .help { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.name { flex: 0 1 auto; min-width: 4rem; font-weight: 600; }
.line select, .line input[type='text'] { min-width: 4rem; flex: 0 1 16rem; }
.line input[type='number'] { width: 7rem; min-width: 4.5rem; flex: 0 1 7rem; }
.help { color: var(--soft); font-size: 0.8125rem; }
.status { color: var(--soft); }
@media print {
  .bar, progress, .note, .loops { display: none; }
  .stage, .stage .picture { height: auto !important; min-height: 0; }
  .stage .picture { max-height: 15cm; object-fit: contain; object-position: top left; }
  .stage canvas { display: none; }
  /* Without a log the picture is an empty grid: print the text instead. */
  .without-file .stage { display: none; }
  .without-file .summary { display: block !important; margin: 0; padding: 0.5rem 0.75rem; }
  .stage .picture, .stage.live .picture { display: block; }
  .frame { --paper: ${paper[0]}; --ink: ${ink[0]}; border-color: #999; break-inside: avoid; }
}
`;
