// The types of the package: correct uses compile, incorrect ones do not.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as h from './harness.mjs';
import { installPackage } from './package.mjs';

const TSC = fileURLToPath(new URL('../../web/node_modules/typescript/bin/tsc', import.meta.url));

let project;
before(() => (project = installPackage()));
after(() => project.remove());

/** The compiler's errors for a program that uses the package. */
function compileErrors(program) {
  const file = join(project.folder, 'main.ts');
  writeFileSync(file, `import type { WidgetStates, WidgetButtons, SlamWidget } from 'slam-widgets';\n${program}\nexport {};`);
  try {
    execFileSync('node', [TSC, '--noEmit', '--strict', '--target', 'es2022', '--module', 'esnext',
      '--moduleResolution', 'bundler', '--types', '', file], { encoding: 'utf8', cwd: project.folder });
    return '';
  } catch (error) {
    return error.stdout;
  }
}

it('the types have every parameter and button of every widget', () => {
  const lines = h.schema.flatMap((widget) => [
    ...widget.params.map((param, i) => {
      const value = { choice: `'${param.options[param.default]?.id}'`, switch: 'true', text: "''" }[param.kind] ?? param.default;
      return `const p${widget.id.replace('.', '_')}_${i}: WidgetStates['${widget.id}']['${param.id}'] = ${value};`;
    }),
    ...[...widget.buttons, ...widget.presets].map((button, i) =>
      `const b${widget.id.replace('.', '_')}_${i}: WidgetButtons['${widget.id}'] = '${button.id}';`),
  ]);
  assert.equal(compileErrors(lines.join('\n')), '');
});

it('the types accept what the element accepts', () => {
  const program = `
    const widget: SlamWidget = document.createElement('slam-widget');
    widget.heading = 60;
    widget.value = { heading: 12 };
    widget.addEventListener('slam-change', (event) => console.log(event.detail.parameter, event.detail.value));
    void widget.press('play');`;
  assert.equal(compileErrors(program), '');
});

it('the types reject unknown parameters and options', () => {
  assert.match(compileErrors("const x: WidgetStates['w16.1']['headin'] = 1;"), /headin/);
  assert.match(compileErrors("document.createElement('slam-widget').variant = 'plane';"), /not assignable/);
});

it('the types have the prediction element and its event', () => {
  const ask = (field) => `
    import 'slam-widgets/predict';
    const question = document.createElement('slam-predict');
    question.addEventListener('slam-predict', ({ detail }) => { const told: boolean = detail.${field}; });`;
  assert.equal(compileErrors(ask('correct')), '');
  assert.match(compileErrors(ask('gap')), /not assignable/);
});

it('the types have the module for notebooks', () => {
  const render = (cell) => `
    import widget, { type Model } from 'slam-widgets/anywidget';
    export const show = (model: Model, el: HTMLElement): (() => void) => widget.render(${cell});`;
  assert.equal(compileErrors(render('{ model, el }')), '');
  assert.match(compileErrors(render('{ model }')), /'el' is missing/);
});
