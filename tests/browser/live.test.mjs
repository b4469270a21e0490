// A robot that drives, mapped in the page: w16.10 of own-robot.html connects to its server.

import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { skip } from '../skip.mjs';
import { without } from '../wheel.mjs';
import { violations } from './axe.mjs';
import * as h from './harness.mjs';
import { giveBytes, isMapped, says as outcomeSays } from './recordings.mjs';
import { driveOf, officialRobot, robotServer } from './robot-server.mjs';

const LOG = readFileSync(join(h.DIST, 'samples', 'ring.log'), 'utf8');
const DRIVE = driveOf(LOG);
const SCANS = DRIVE.filter(({ topic }) => topic === '/scan').length;
const RECORDING = fileURLToPath(new URL('../../../shared/data/field/base/base.mcap', import.meta.url));

const visit = h.visitor();
/** The page with its panel open, and a robot's server. */
const beside = (robot, test, how = {}) => visit('', async (tab) => {
  const server = typeof robot === 'string' ? await officialRobot(robot) : await robotServer(robot);
  try {
    await h.ready(tab);
    await panel(tab).locator('summary').click();
    await test(tab, server);
  } finally {
    await server.close();
  }
}, { path: '/own-robot.html?w=16.10', ...how });

const panel = (tab) => tab.locator('slam-widget .connection');
const button = (tab, name) => panel(tab).getByRole('button', { name, exact: true });
const connect = async (tab, url) => {
  await panel(tab).getByLabel('Address').fill(url);
  await panel(tab).getByLabel('Address').press('Enter');
};
/** Waits until the panel says so. */
const says = (tab, pattern) => tab.waitForFunction((source) =>
  new RegExp(source).test(document.querySelector('slam-widget').shadowRoot.querySelector('.connection').textContent), pattern.source);
/** Opens a log and waits for its map. */
const open = async (tab, bytes, name) => {
  await giveBytes(tab, name, bytes);
  await outcomeSays(tab, new RegExp(`^(mapped|[^:]*in doubt): ${name}`));
};
const text = (tab, name) => tab.evaluate(async (file) => (await document.querySelector('slam-widget').savedFile(file)).text(), name);
const remarks = async (tab) => (await tab.evaluate(() => document.querySelector('slam-widget').tables())).find(({ id }) => id === 'remarks')?.csv ?? '';
const troubles = (tab) => tab.troubles.filter((one) => !/WebSocket connection to/.test(one));

describe('a robot that drives', () => {
  it('is mapped as its recording is, once that is opened like any other', async () => {
    await beside({ messages: DRIVE }, async (tab, robot) => {
      await connect(tab, robot.url);
      await says(tab, /Reads (?=.*\/scan)(?=.*\/odom)(?=.*\/tf_static).*\./);
      await says(tab, new RegExp(`${SCANS} scans arrived`));
      await outcomeSays(tab, /^reading: ws:/);
      assert.deepEqual(await violations(tab), []);
      await button(tab, 'Stop').click();
      await isMapped(tab);
      await says(tab, new RegExp(`${SCANS} scans arrived, ${SCANS} are mapped\\.`));
      const live = await text(tab, 'trajectory.tum');
      assert.equal(live.trim().split('\n').length, SCANS);
      const download = tab.waitForEvent('download');
      await button(tab, 'Save the recording').click();
      const recording = await h.bytesOf(await download);
      const session = tab.waitForEvent('download');
      await button(tab, 'Save the session').click();
      assert.equal((await session).suggestedFilename(), 'session.slam2d');
      await open(tab, recording, 'again.mcap');
      assert.equal(await text(tab, 'trajectory.tum'), live);
      assert.equal(await button(tab, 'Save the recording').isVisible(), false);
    });
  });

  it('is mapped from the official server as the file is', async (context) => {
    const why = existsSync(RECORDING) ? without('foxglove', 'mcap') : 'its recording is not in ../shared/data/field';
    if (why !== undefined) {
      skip(context, why);
      return;
    }
    await beside(RECORDING, async (tab, robot) => {
      const results = ['trajectory.tum', 'graph.g2o'];
      const read = async () => Promise.all(results.map((name) => text(tab, name)));
      await open(tab, readFileSync(RECORDING), 'base.mcap');
      const ofFile = await read();
      const scans = ofFile[0].trim().split('\n').length;
      assert.ok(scans > 50);
      await connect(tab, robot.url);
      await says(tab, new RegExp(`${scans} scans arrived`));
      await button(tab, 'Stop').click();
      await isMapped(tab);
      await says(tab, new RegExp(`${scans} scans arrived, ${scans} are mapped\\.`));
      assert.deepEqual(await read(), ofFile);
    });
  });

  it('is reached from the first picture by keyboard, on a telephone', async () => {
    await visit('', async (tab) => {
      await tab.getByRole('button', { name: 'Connect to a robot' }).press('Enter');
      await h.ready(tab);
      const focused = () => tab.evaluate(() => document.activeElement.shadowRoot?.activeElement?.placeholder);
      assert.equal(await focused(), 'ws://robot:8765');
      await tab.keyboard.type('robot:8765');
      await tab.keyboard.press('Enter');
      await says(tab, /robot:8765 is not the address of a robot; type one such as/);
      const width = await tab.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(width <= 390, `${width} px wide`);
    }, { path: '/own-robot.html', options: { viewport: { width: 390, height: 844 } } });
  });

  it('is found again after a lost connection, and the gap is named', async () => {
    await beside({ messages: DRIVE, breaksAfter: 200 }, async (tab, robot) => {
      // On a busy machine the connection is back before a look at the panel.
      await tab.evaluate(() => {
        const panel = document.querySelector('slam-widget').shadowRoot.querySelector('.connection');
        window.said = [];
        new MutationObserver(() => window.said.push(panel.textContent)).observe(panel, { subtree: true, childList: true, characterData: true });
      });
      await connect(tab, robot.url);
      await says(tab, new RegExp(`${SCANS} scans arrived`));
      const said = await tab.evaluate(() => window.said.join('\n'));
      assert.match(said, /the connection is lost \(the server closed it\); connecting again for 30 s/);
      assert.match(said, /connected again/);
      await button(tab, 'Stop').click();
      await isMapped(tab);
      assert.match(await remarks(tab), /the connection was lost for \d+\.\d s; what the robot saw meanwhile is missing/);
    });
  });

  it('keeps what it has if the connection does not come back', async () => {
    await beside({ messages: DRIVE }, async (tab, robot) => {
      await connect(tab, robot.url);
      await says(tab, new RegExp(`${SCANS} scans arrived`));
      await robot.close();
      await says(tab, /connecting again/);
      await tab.evaluate(() => frameClock.skip(31_000));
      await says(tab, /the connection was lost \(the server closed it\) and did not come back; the drive ends there/);
      await isMapped(tab);
      assert.match(await text(tab, 'trajectory.tum'), /\n/);
      tab.troubles = troubles(tab);
    });
  });

  it('is named if it is not there, or another server is', async () => {
    await beside({ protocol: null }, async (tab, robot) => {
      await connect(tab, robot.url);
      await says(tab, /is not a server of Foxglove's WebSocket protocol: it has another subprotocol, as rosbridge does; start foxglove_bridge/);
      await outcomeSays(tab, /^no map: .*another subprotocol/);
      await robot.close();
      await button(tab, 'Connect').click();
      await says(tab, /no connection: nobody answers there; start foxglove_bridge on the robot, and check address and port/);
      assert.deepEqual(troubles(tab), []);
      tab.troubles = [];
    });
  });

  it('is named with its topics if it has no scan', async () => {
    await beside({ lasers: [], others: { '/camera': 'sensor_msgs/msg/Image' } }, async (tab, robot) => {
      await connect(tab, robot.url);
      await says(tab, /Reads/);
      await tab.evaluate(() => frameClock.skip(31_000));
      await says(tab, /no scan came; it has \/camera \(sensor_msgs\/msg\/Image\), \/odom .* Start the driver of the laser and connect again/);
    });
  });

  it('is read by the laser that is chosen of two', async () => {
    const rear = driveOf(LOG, { laser: '/rear' }).filter(({ topic }) => topic === '/rear');
    const messages = [...DRIVE, ...rear].sort((a, b) => a.atS - b.atS);
    await beside({ messages, lasers: ['/scan', '/rear'] }, async (tab, robot) => {
      await connect(tab, robot.url);
      await says(tab, /Reads .*\/rear/);
      await panel(tab).getByLabel('Scans from').selectOption('/rear');
      await tab.waitForFunction(() => {
        const said = document.querySelector('slam-widget').shadowRoot.querySelector('.connection [role=status]').textContent;
        return said.includes('/rear') && !said.includes('/scan');
      });
    });
  });

  it('ends with a sentence at a message that is too long', async () => {
    await beside({ first: Buffer.alloc((1 << 25) + 1) }, async (tab, robot) => {
      await connect(tab, robot.url);
      await says(tab, /the server sent a message of 33554433 bytes, and 33554432 are the most that is taken/);
    });
  });

  it('is out of reach for a page that came by https, which says the ways out', async () => {
    await beside({}, async (tab, robot) => {
      await tab.route('https://slam.test/**', (route) => {
        const { pathname } = new URL(route.request().url());
        return route.fulfill({ path: join(h.DIST, pathname), contentType: h.TYPES[extname(pathname)] ?? 'application/octet-stream' });
      });
      tab.home = 'https://slam.test';
      await tab.context().grantPermissions(['local-network-access'], { origin: tab.home });
      await tab.goto('https://slam.test/own-robot.html?w=16.10');
      await h.ready(tab);
      await panel(tab).locator('summary').click();
      await connect(tab, 'ws://robot:8765');
      await says(tab, /lets a page loaded over https reach only wss:\/\/ addresses.*offline zip.*http:\/\/localhost/);
      await connect(tab, robot.url);
      await says(tab, /Reads/);
      // Requests are still answered.
      await tab.unrouteAll({ behavior: 'wait' });
    }, { fresh: true });
  });

  it('is the only page whose policy opens WebSockets', () => {
    const opens = h.PAGES.filter((page) => /connect-src 'self' ws: wss:;/.test(readFileSync(join(h.DIST, page), 'utf8')));
    assert.deepEqual(opens, ['own-robot.html']);
  });
});
