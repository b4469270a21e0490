// The Python wheel as users get it: packed from dist/, installed into a folder, tested from Python.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { skip } from '../skip.mjs';
import { PYTHON, install, without } from '../wheel.mjs';

const root = fileURLToPath(new URL('../../', import.meta.url));
const dist = join(root, 'dist');

test('the wheel has the module, and a class for each widget with its parameters', (context) => {
  const why = without('anywidget', 'hatchling');
  if (why !== undefined) {
    skip(context, why);
    return;
  }
  const folder = mkdtempSync(join(tmpdir(), 'slam-packages-'));
  try {
    const { files, site } = install(folder);
    assert.deepEqual(files, ['slam-widgets-0.1.0.tgz', 'slam_widgets-0.1.0-py3-none-any.whl']);
    const whole = readFileSync(join(site, 'slam_widgets', 'static', 'slam-widgets.js'), 'utf8');
    assert.doesNotMatch(whole, /import\s*["'{*]/, 'the module asks for files beside it');
    const said = execFileSync(PYTHON, ['-c', `
import json
import slam_widgets
from slam_widgets import Basin, WIDGETS
basin = Basin(heading=60)
basin.tau = 1.2
rejected = []
for wrong in (lambda: Basin(headin=60), lambda: slam_widgets.SlamWidget(name="w99"), lambda: Basin.from_link("?w=16.2")):
    try:
        wrong()
    except Exception as error:
        rejected.append(str(error))
print(json.dumps({
    "ids": list(WIDGETS), "value": basin.value, "default": basin.dx, "rejected": rejected,
    "link": Basin.from_link("?w=16.1&heading=25&variant=point-to-plane&other=1").value,
    "doc": Basin.__doc__, "names": [made.__name__ for made in WIDGETS.values()],
    "usable": [getattr(slam_widgets, made.__name__, None) is made and made.__name__.isidentifier() for made in WIDGETS.values()],
}))`], { env: { ...process.env, PYTHONPATH: site }, encoding: 'utf8' });
    const { ids, value, default: dx, rejected, link, doc, names, usable } = JSON.parse(said);
    const schema = JSON.parse(readFileSync(join(dist, 'schema.json'), 'utf8'));
    assert.deepEqual(ids, schema.map((widget) => widget.id));
    assert.ok(usable.every(Boolean), names.join(' '));
    assert.deepEqual(value, { heading: 60, tau: 1.2 });
    assert.equal(dx, schema[0].params.find((param) => param.id === 'dx').default);
    assert.deepEqual(link, { heading: 25, variant: 'point-to-plane' });
    assert.match(doc, /heading: -180 to 180 °\./);
    assert.match(rejected[0], /Basin has no parameter 'headin'; it has heading, /);
    assert.match(rejected[1], /there is no widget 'w99'; there are w16\.1, /);
    assert.match(rejected[2], /the link is for w16\.2, and Basin is w16\.1/);
  } finally {
    rmSync(folder, { recursive: true });
  }
});
