// The style of the shadow tree. The page sets width and margins of the element.

import { accent, bad, fair, faint, good, ink, measurement, paper, prior, soft, wash } from '../../crates/robots/robot_io/palette.json';

/** The filled part ends at the middle of the thumb, which is 18 px wide. */
const RAIL = 'background: linear-gradient(to right, var(--accent) calc(9px + var(--fill, 0) * (100% - 18px)), var(--line) 0);';
const THUMB = 'box-sizing: border-box; width: 18px; height: 18px; border: 3px solid var(--paper); border-radius: 50%; background: var(--accent); '
  + 'box-shadow: 0 0 0 2px var(--accent);';

export const STYLE = `
:host { display: block; position: relative; color-scheme: light; }
:host([hidden]) { display: none; }
.frame { --paper: ${paper[0]}; --ink: ${ink[0]}; --soft: ${soft[0]}; --line: ${faint[0]}; --accent: ${accent[0]}; --wash: ${wash[0]};
  --good: ${good[0]}; --fair: ${fair[0]}; --bad: ${bad[0]}; --older: ${prior[0]}; --newer: ${measurement[0]};
  background: var(--paper); color: var(--ink); font: 0.9375rem/1.4 var(--label-font, system-ui), sans-serif;
  outline: none; }
.frame.dark { --paper: ${paper[1]}; --ink: ${ink[1]}; --soft: ${soft[1]}; --line: ${faint[1]}; --accent: ${accent[1]}; --wash: ${wash[1]};
  --good: ${good[1]}; --fair: ${fair[1]}; --bad: ${bad[1]}; --older: ${prior[1]}; --newer: ${measurement[1]};
  color-scheme: dark; }
.title { margin: 0; padding: 0.3rem 0.75rem 0.25rem; font: 600 1.375rem/1.2 var(--text-font, inherit); text-wrap: balance; }
.title span { margin-inline-end: 0.6rem; color: var(--soft); font: 0.9375rem/1 var(--label-font, system-ui); }
.view { position: relative; }
.whole { position: absolute; top: 0.5rem; right: 0.75rem; }
.drop { display: none; }
.without-file .drop { display: grid; place-content: center; position: absolute; inset: 0; padding: 0.75rem; border: 0; border-radius: 0; background: none; }
.drop span { max-width: 13rem; padding: 0.6rem 1rem; border: 2px dashed var(--accent); border-radius: 8px; background: var(--paper); }
.drop b { display: block; font-size: 1.25em; }
.stage { position: relative; overflow: hidden; min-height: 12rem; height: var(--reserved-height); }
.stage.live { min-height: 0; height: auto; }
.picture { display: block; width: 100%; height: auto; }
.stage[style*='--reserved-height'] .picture { height: 100%; object-fit: contain; object-position: top; }
canvas { display: block; width: 100%; touch-action: pan-y pinch-zoom; outline: none;
  -webkit-user-select: none; user-select: none; -webkit-touch-callout: none; }
.frame.takes-files canvas { touch-action: pan-y; }
.frame.dropping { box-shadow: 0 0 0 3px var(--accent); }
.pinned { position: fixed; top: 0; z-index: 3; pointer-events: none; background: var(--paper);
  border-bottom: 2px solid var(--accent); border-radius: 0 0 8px 8px; box-shadow: 0 3px 10px #0005; touch-action: auto; }
.stage.waiting canvas { position: absolute; inset: 0; visibility: hidden; }
.stage.live .picture { display: none; }
progress { position: absolute; inset: auto 0 0 0; width: 100%; height: 4px; accent-color: var(--accent); }
.note { margin: 0; padding: 0.5rem 0.75rem; border-top: 1px solid var(--line); overflow-wrap: anywhere; }
.note pre { max-height: 10rem; overflow: auto; white-space: pre-wrap; font-size: 0.875rem; }
.note:empty { display: none; }
.doctor { padding: 0.5rem 0.75rem; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
.doctor summary { cursor: pointer; font-weight: 600; }
.doctor ul { list-style: none; margin: 0.4rem 0; padding: 0; display: grid; gap: 0.35rem; }
.doctor li { display: grid; grid-template-columns: 1.25rem 1fr; }
.doctor li button { margin: 0.15rem 0; }
.doctor .sign { font-weight: 700; color: var(--good); }
.doctor .mended .sign { color: var(--fair); }
.doctor .wrong .sign { color: var(--bad); }
.connection { padding: 0 0.75rem; overflow-wrap: anywhere; }
.connection summary { cursor: pointer; font-weight: 600; font-size: 0.875rem; line-height: 1.5rem; }
.connection form, .connection label { display: flex; flex-wrap: wrap; gap: 0.35rem 0.75rem; align-items: center; }
.connection [hidden] { display: none; }
.connection input { flex: 1 1 12rem; min-width: 0; max-width: 24rem; }
.connection form, .connection p { margin: 0.35rem 0; }
.connection p:empty { display: none; }
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
.loops span { flex: 1 0 100%; color: var(--soft); font-size: 0.875rem; }
.bar { container-type: inline-size; }
.controls { position: relative; z-index: 1; background: var(--paper); display: grid; grid-template: "transport transport" "first tools" "verdict verdict" / minmax(0, 1fr) auto;
  gap: 0.25rem 0.75rem; padding: 0.4rem 0.75rem; }
.transport { grid-area: transport; }
.first { grid-area: first; }
.tools { grid-area: tools; }
.verdict { grid-area: verdict; min-height: 4.2em; }
@container (width >= 30rem) {
  /* Two rows: no two of these have room beside each other. */
  .controls { display: flex; flex-wrap: wrap; gap: 0.4rem 1.25rem; }
  :is(.transport, .verdict) { flex: 1 1 55%; min-width: 0; }
  .tools { order: 1; }
  .first { align-self: center; }
  .first .control { flex-wrap: nowrap; }
}
@container (width < 30rem) {
  .controls { row-gap: 0.15rem; padding-block: 0.1rem 0.25rem; }
  .transport:not(:has(.do ~ .do)) .name { position: absolute; clip-path: inset(50%); }
}
@container (20rem <= width < 30rem) {
  .controls:not(:has(.first > :not([hidden]))) { grid-template: "transport transport" "verdict tools" / minmax(0, 1fr) auto; }
  .controls:not(:has(.first > :not([hidden]))) .tools { flex-direction: column; align-items: stretch; }
  .tools .control button, .menu summary { width: 100%; }
}
@media (width < 30rem) { .title { padding: 0.35rem 0.75rem 0.1rem; font-size: 1rem; } .verdict { min-height: 3em; } .title span { display: none; } }
.first .name { flex: none; }
.transport, .presets, .actions, .zoom { display: flex; flex-wrap: wrap; gap: 0.25rem 0.5rem; align-items: center; }
[data-control='play'] { min-width: 5.5rem; min-height: 2.5rem; background: var(--accent); color: var(--paper); font-weight: 600; }
.tools { display: flex; gap: 0.4rem; align-items: start; }
.verdict p { margin: 0; text-wrap: pretty; display: -webkit-box; -webkit-box-orient: vertical; -webkit-line-clamp: 3; overflow: hidden; }
@container (width < 30rem) { .verdict p { -webkit-line-clamp: 5; } }
.bar:has(.rest:not([hidden])) .verdict p { display: block; }
.bar:not(:has(.rest:not([hidden]))) .further { display: none; }
.gesture, .verdict .claim { font-weight: 600; }
.gesture { font-size: 1.0625rem; }
.good { color: var(--good); }
.doubtful { color: var(--fair); }
.bad { color: var(--bad); }
button, .menu summary, select, input[type='number'], input[type='text'] { box-sizing: border-box; font: inherit; font-weight: 500; color: inherit;
  background: var(--wash); border: 1px solid transparent; border-radius: 8px; min-height: 2rem; padding: 0.15rem 0.75rem; }
input[type='number'], input[type='text'] { background: var(--paper); }
button, .menu summary { cursor: pointer; text-align: center; }
button[aria-pressed='true'] { background: var(--ink); color: var(--paper); }
:is(button, .menu summary, select, input):hover { border-color: var(--accent); }
button[aria-disabled='true'] { color: var(--soft); border-color: var(--line); cursor: default; }
:focus-visible:not(.frame) { outline: 3px solid var(--accent); outline-offset: 2px; }
.menu { position: relative; }
.menu summary { list-style: none; padding-block: 0.2rem; }
.menu > div { position: absolute; right: 0; bottom: calc(100% + 0.4rem); z-index: 2; display: grid; gap: 0.4rem; width: max-content;
  max-width: 16rem; padding: 0.6rem; background: var(--paper); border: 1px solid var(--line); border-radius: 8px; box-shadow: 0 3px 10px #0004; }
.status { color: var(--soft); overflow-wrap: anywhere; }
.status:empty { display: none; }
.control { position: relative; display: flex; flex-wrap: wrap; gap: 0 0.5rem; align-items: center; min-width: 0; }
.name { flex: 1 1 5rem; line-height: 1.2; }
.value { display: flex; flex: 0 1 auto; gap: 0.1rem; align-items: center; min-width: 0; }
.text .value { flex: 1 1 8rem; }
.slider .rail { order: 1; flex: 1 0 100%; }
.rail { position: relative; display: flex; flex: 1 1 6rem; }
.timeline .rail { min-width: 5rem; }
.unit { white-space: nowrap; }
.timeline { flex: 1 1 13rem; flex-wrap: nowrap; min-width: min-content; }
.timeline > :not(.rail) { flex: none; order: 1; }
.timeline > :is(.name, .value) { min-width: max-content; }
.timeline .name { color: var(--soft); }
.empty :is(.unit, input[type='number']) { visibility: hidden; }
@container (width < 20rem) {
  .timeline { flex-wrap: wrap; min-width: 0; }
  .timeline .rail { flex: 1 0 100%; }
  .verdict p { display: block; }
}
/* The same in every browser: a rail filled up to a thumb. */
input[type='range'] { flex: 1; width: 0; min-width: 3rem; height: 1.625rem; margin: 0; background: none; appearance: none; cursor: pointer; }
input[type='range']::-webkit-slider-runnable-track { height: 6px; border-radius: 3px; ${RAIL} }
input[type='range']::-moz-range-track { height: 6px; border-radius: 3px; ${RAIL} }
input[type='range']::-webkit-slider-thumb { appearance: none; margin-top: -6px; ${THUMB} }
input[type='range']::-moz-range-thumb { ${THUMB} }
@media (forced-colors: active) { input[type='range'] { appearance: auto; } }
.marks { position: absolute; inset: 0 9px; pointer-events: none; }
.marks i { position: absolute; left: calc(var(--at) * 100%); width: 2px; height: 0.5rem; top: calc(50% - 0.25rem); background: var(--soft); }
.marks .good { top: 0; background: var(--good); }
.marks :is(.bad, .doubtful) { top: auto; bottom: 0; background: var(--bad); }
.marks .doubtful { background: var(--fair); }
input[type='number'] { width: 3.5em; min-height: 1.5rem; padding: 0 0.3rem; border-color: transparent; border-radius: 4px; text-align: right;
  appearance: textfield; font-variant-numeric: tabular-nums; }
/* Chromium keeps the room of its arrows. */
input::-webkit-inner-spin-button { display: none; }
:is(.seed, .settings) input[type='number'] { width: 5em; border-color: var(--line); }
.seed input[type='number'] { width: 7em; }
input[type='text'] { width: 100%; min-width: 0; border-radius: 4px; }
select { min-width: 0; max-width: 100%; }
input[type='checkbox'] { width: 1.5rem; height: 1.5rem; margin: 0.1rem 0; accent-color: var(--accent); }
.rest { display: grid; gap: 0.9rem; padding: 0.6rem 0.75rem 0.75rem; }
.rest > :not(.details):not(:has(:not([hidden]))) { display: none; }
.presets::before { content: attr(aria-label); flex: 1 0 100%; font-weight: 600; }
.settings, .facts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(15rem, 100%), 1fr)); gap: 0.4rem 2rem; align-items: start; }
.details > * { margin: 0 0 0.6rem; }
.facts div { display: flex; justify-content: space-between; gap: 0.5rem; }
.facts dt { color: var(--soft); }
.facts dd { margin: 0; font-variant-numeric: tabular-nums; }
.details ul { padding-left: 1.2rem; }
.head { font-weight: 600; }
table { width: 100%; border-collapse: collapse; margin-top: 0.6rem; font-size: 0.875rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; }
:is(th, td) { padding: 0.15rem 0.75rem 0.15rem 0; text-align: left; font-weight: 400; vertical-align: top; overflow-wrap: anywhere; }
thead tr { border-bottom: 1px solid var(--line); }
.hidden { position: absolute; width: 1px; height: 1px; margin: -1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
[hidden] { display: none !important; }
@media print {
  .transport, .first, .tools, .rest, .whole, .drop, progress, .note, .loops, .connection { display: none; }
  .controls { top: 0 !important; margin-bottom: 0 !important; }
  .verdict p { display: block; }
  .stage, .stage .picture { height: auto !important; min-height: 0; }
  .stage .picture { max-height: 15cm; object-fit: contain; object-position: top left; }
  .stage canvas { display: none; }
  /* Without a log the picture is an empty grid: print the text instead. */
  .without-file .stage { display: none; }
  .without-file .summary { display: block !important; margin: 0; padding: 0.5rem 0.75rem; }
  .stage .picture, .stage.live .picture { display: block; }
  .frame { --paper: ${paper[0]}; --ink: ${ink[0]}; break-inside: avoid; }
}
`;
