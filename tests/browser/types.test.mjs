// The generated types fit the element: right uses compile, wrong ones do not.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as h from './harness.mjs';

const TSC = fileURLToPath(new URL('../../web/node_modules/typescript/bin/tsc', import.meta.url));

/** The compiler's complaints about a program that uses the package's types. */
function complaints(program) {
  const folder = mkdtempSync(join(tmpdir(), 'slam-types-'));
  try {
    writeFileSync(join(folder, 'main.ts'), `import type { WidgetStates, WidgetButtons, SlamWidget } from '${h.DIST}slam-widget';\n${program}`);
    execFileSync('node', [TSC, '--noEmit', '--strict', '--target', 'es2022', '--module', 'esnext',
      '--moduleResolution', 'bundler', '--types', '', join(folder, 'main.ts')], { encoding: 'utf8' });
    return '';
  } catch (error) {
    return error.stdout;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

it('name every parameter and button of every widget', () => {
  const lines = h.schema.flatMap((widget) => [
    ...widget.params.map((param, i) => {
      const value = { choice: `'${param.options[param.default]?.id}'`, switch: 'true' }[param.kind] ?? param.default;
      return `const p${widget.id.replace('.', '_')}_${i}: WidgetStates['${widget.id}']['${param.id}'] = ${value};`;
    }),
    ...[...widget.buttons, ...widget.presets].map((button, i) =>
      `const b${widget.id.replace('.', '_')}_${i}: WidgetButtons['${widget.id}'] = '${button.id}';`),
  ]);
  assert.equal(complaints(`${lines.join('\n')}\nexport {};`), '');
});

it('take what the element takes', () => {
  const program = `
    const widget: SlamWidget = document.createElement('slam-widget');
    widget.heading = 60;
    widget.value = { heading: 12 };
    widget.addEventListener('slam-change', (event) => console.log(event.detail.parameter, event.detail.value));
    void widget.press('play');
    export {};`;
  assert.equal(complaints(program), '');
});

it('refuse a parameter that is not there and an option that does not exist', () => {
  assert.match(complaints("const x: WidgetStates['w16.1']['headin'] = 1; export {};"), /headin/);
  assert.match(complaints("document.createElement('slam-widget').variant = 'plane'; export {};"), /not assignable/);
});
