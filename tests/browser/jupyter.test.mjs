// The Python wheel in JupyterLab: the widget runs in its cell with only the notebook's server, and exchanges values, results
// and files with the kernel.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { cpSync, mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { test } from 'node:test';
import { skip } from '../skip.mjs';
import { PYTHON, install, without } from '../wheel.mjs';
import { LAST_RESORT_MS, launch } from './chromium.mjs';
import * as h from './harness.mjs';

const CELLS = [
  ['from slam_widgets import Basin, Robot', 'basin = Basin(heading=60)', 'basin'],
  ['print("kernel has", basin.value["heading"], basin.outcome["verdict"] != "")'],
  ['basin.heading = 120'],
  ['robot = Robot("ring.log", reference="ring-truth.tum", where="ring-another-day.log", colour="error")', 'robot'],
  ['robot.save("trajectory.tum")', 'robot.save("map.png", "kept.png")', 'robot.save("nothing.txt")'],
  ['print("came:", *(f"{path.name} {path.stat().st_size > 1000}" for path in robot.saved), "| rejected:", robot.rejected,',
    '      "| tables:", *sorted(robot.tables))'],
];

function notebook() {
  const cells = CELLS.map((lines, at) => ({
    cell_type: 'code', id: `cell-${at}`, metadata: {}, execution_count: null, outputs: [], source: lines.join('\n'),
  }));
  const kernelspec = { name: 'python3', display_name: 'Python 3', language: 'python' };
  return JSON.stringify({ cells, metadata: { kernelspec }, nbformat: 4, nbformat_minor: 5 });
}

/** Starts JupyterLab on `folder`; resolves with its process and its address. */
async function startLab(folder, site) {
  const own = (name) => join(folder, name);
  const env = {
    ...process.env, PYTHONPATH: site, JUPYTER_CONFIG_DIR: own('config'), JUPYTER_DATA_DIR: own('data'),
    JUPYTER_RUNTIME_DIR: own('runtime'), IPYTHONDIR: own('ipython'),
  };
  const lab = spawn(PYTHON, ['-m', 'jupyterlab', '--no-browser', '--allow-root', '--ip=127.0.0.1', '--port=8890',
    '--ServerApp.port_retries=100', '--IdentityProvider.token=', '--ServerApp.password=',
    '--LabApp.expose_app_in_browser=True', `--ServerApp.root_dir=${join(folder, 'work')}`], { env, stdio: ['ignore', 'ignore', 'pipe'] });
  const said = [];
  for await (const line of createInterface({ input: lab.stderr })) {
    said.push(line);
    const [address] = /http:\/\/127\.0\.0\.1:\d+\//.exec(line) ?? [];
    if (address !== undefined) {
      lab.stderr.resume();
      return { lab, address };
    }
  }
  throw new Error(`JupyterLab does not start:\n${said.join('\n')}`);
}

test('the wheel works in JupyterLab without a network: values and results in both directions, and logs to the page', async (context) => {
  const why = without('jupyterlab', 'anywidget', 'hatchling');
  if (why !== undefined) {
    skip(context, why);
    return;
  }
  const folder = mkdtempSync(join(tmpdir(), 'slam-jupyter-'));
  let lab;
  let browser;
  try {
    cpSync(join(h.DIST, 'samples'), join(folder, 'work'), { recursive: true });
    writeFileSync(join(folder, 'work', 'widgets.ipynb'), notebook());
    const started = await startLab(folder, install(folder).site);
    lab = started.lab;
    browser = await launch(['--window-size=1400,2400']);
    const tab = await (await browser.newContext({ viewport: { width: 1400, height: 2400 } })).newPage();
    tab.setDefaultTimeout(LAST_RESORT_MS);
    // Only the notebook's own server is reachable.
    await tab.route((url) => url.origin !== new URL(started.address).origin, (route) => route.abort());
    await tab.goto(`${started.address}lab/tree/widgets.ipynb?reset`);
    await tab.waitForSelector('.jp-Notebook .jp-Cell');
    const run = async (at) => {
      await tab.evaluate(async (cell) => {
        const { shell, commands } = window.jupyterapp;
        const { content, sessionContext } = shell.currentWidget;
        await sessionContext.ready;
        content.activeCellIndex = cell;
        await commands.execute('notebook:run-cell');
      }, at);
    };
    /** Repeats a cell until its output matches: messages of the page arrive asynchronously. */
    const asks = async (at, pattern) => {
      const cell = tab.locator(`.jp-Cell >> nth=${at}`);
      while (!pattern.test(await cell.innerText())) await run(at);
    };
    const widget = (at) => tab.locator(`.jp-Cell >> nth=${at} >> slam-widget`);
    const verdict = (at, pattern) => tab.waitForFunction(([cell, source]) => {
      const found = document.querySelectorAll('.jp-Cell')[cell]?.querySelector('slam-widget');
      const { verdict: said, sentence } = found?.outcome ?? {};
      return new RegExp(source).test(`${said}: ${sentence}`);
    }, [at, pattern.source]);

    await run(0);
    await verdict(0, /\w+: /);
    assert.equal(await widget(0).evaluate((it) => it.get('heading')), 60);
    // From the page to the kernel, and back.
    await widget(0).evaluate((it) => new Promise((done) => {
      it.addEventListener('slam-result', () => done(), { once: true });
      it.set('heading', 90);
    }));
    await asks(1, /kernel has 90 True/);
    await run(2);
    await tab.waitForFunction(() => document.querySelector('slam-widget').get('heading') === 120);

    await run(3);
    await verdict(3, /^(mapped|[^:]*in doubt): ring\.log.*from the truth.*The robot of ring-another-day\.log is found/);
    // Files arrive once the page has written them.
    await run(4);
    await asks(5, /came: trajectory\.tum True kept\.png True \| rejected: .*nothing\.txt.* \| tables: .*loops.*/);
    assert.ok(statSync(join(folder, 'work', 'kept.png')).size > 1000);
  } finally {
    await browser?.close();
    if (lab !== undefined) {
      lab.kill('SIGTERM');
      await new Promise((ended) => lab.once('exit', ended));
    }
    rmSync(folder, { recursive: true, force: true });
  }
});
