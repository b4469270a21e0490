// A robot's server of Foxglove's WebSocket protocol, as foxglove_bridge has one, and a drive for it in messages of ROS 2.

import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { WebSocketServer } from 'ws';
import { PYTHON } from '../wheel.mjs';

/** Little-endian CDR: numbers are aligned to their size after the four bytes of the header. */
class Cdr {
  #bytes = [0, 1, 0, 0];

  #number(size, write) {
    while ((this.#bytes.length - 4) % size !== 0) this.#bytes.push(0);
    const view = new DataView(new ArrayBuffer(size));
    write(view);
    this.#bytes.push(...new Uint8Array(view.buffer));
    return this;
  }

  u32(value) { return this.#number(4, (view) => view.setUint32(0, value, true)); }
  f32(...values) { for (const value of values) this.#number(4, (view) => view.setFloat32(0, value, true)); return this; }
  f64(...values) { for (const value of values) this.#number(8, (view) => view.setFloat64(0, value, true)); return this; }

  text(value) {
    this.u32(value.length + 1);
    this.#bytes.push(...Buffer.from(value), 0);
    return this;
  }

  header(seconds, frame) {
    return this.u32(Math.floor(seconds)).u32(Math.round((seconds % 1) * 1e9)).text(frame);
  }

  get bytes() { return Buffer.from(this.#bytes); }
}

const START_S = 1_700_000_000;
const heading = (rad) => [0, 0, Math.sin(rad / 2), Math.cos(rad / 2)];
const zeros = (count) => new Array(count).fill(0);

function transform(atS, parent, child, [x, y, turn]) {
  return new Cdr().u32(1).header(atS, parent).text(child).f64(x, y, 0).f64(...heading(turn)).bytes;
}

/** The messages of a CARMEN log of ROBOTLASER1, in order: the mounting of the laser, then odometry and scan of each line. */
export function driveOf(log, { laser = '/scan' } = {}) {
  const messages = [{ topic: '/tf_static', atS: START_S, bytes: transform(START_S, 'base_link', 'laser', [0, 0, 0]) }];
  for (const line of log.trim().split('\n')) {
    const words = line.split(' ');
    if (words[0] !== 'ROBOTLASER1') continue;
    const [first, fov, step, farthest] = words.slice(2, 6).map(Number);
    const count = Number(words[8]);
    const ranges = words.slice(9, 9 + count).map(Number);
    const rest = words.slice(9 + count + 1 + Number(words[9 + count]));
    const [x, y, turn] = rest.slice(3, 6).map(Number);
    const atS = START_S + Number(words.at(-1));
    messages.push({
      topic: '/odom', atS,
      bytes: new Cdr().header(atS, 'odom').text('base_link').f64(x, y, 0, ...heading(turn)).f64(...zeros(36)).f64(...zeros(6 + 36)).bytes,
    }, {
      topic: laser, atS,
      bytes: new Cdr().header(atS, 'laser').f32(first, first + fov, step, 0, 0, 0.05, farthest).u32(count).f32(...ranges).u32(0).bytes,
    });
  }
  return messages;
}

const SCHEMAS = { '/tf_static': 'tf2_msgs/msg/TFMessage', '/tf': 'tf2_msgs/msg/TFMessage', '/odom': 'nav_msgs/msg/Odometry' };

/**
 * Starts a server on the loopback that sends these messages to its client, those of topics that it subscribes to, once.
 * `lasers` are topics of scans, `others` further topics with their types. After `breaksAfter` messages the connection breaks,
 * and the next one gets the rest. If `protocol` is null it is a server of another kind. `first` is a binary message before all.
 */
export async function robotServer({ messages = [], lasers = ['/scan'], others = {}, breaksAfter, protocol = 'foxglove.sdk.v1', first } = {}) {
  const topics = Object.entries({ ...SCHEMAS, ...Object.fromEntries(lasers.map((laser) => [laser, 'sensor_msgs/msg/LaserScan'])), ...others });
  const channels = topics.map(([topic, schemaName], id) => ({ id, topic, encoding: 'cdr', schemaName, schema: '' }));
  const server = new WebSocketServer({
    host: '127.0.0.1', port: 0, handleProtocols: (offered) => (offered.has(protocol) ? protocol : false),
  });
  let sent = 0;
  let breaks = breaksAfter;
  server.on('connection', (socket) => {
    if (protocol === null) return;
    const subscriptions = new Map();
    socket.on('message', (text) => {
      const { op, subscriptions: asked } = JSON.parse(text);
      if (op !== 'subscribe') return;
      for (const { id, channelId } of asked) subscriptions.set(channels[channelId].topic, id);
      // All topics were advertised in one text, so all requests come before the next turn.
      clearTimeout(socket.starting);
      socket.starting = setTimeout(send, 50);
    });
    const send = () => {
      for (; sent < messages.length; sent += 1) {
        if (sent === breaks) {
          breaks = undefined;
          // What was sent still arrives.
          socket.close();
          return;
        }
        const { topic, atS, bytes } = messages[sent];
        const subscription = subscriptions.get(topic);
        if (subscription === undefined) continue;
        const head = Buffer.alloc(13);
        head.writeUInt8(1, 0);
        head.writeUInt32LE(subscription, 1);
        head.writeBigUInt64LE(BigInt(Math.round(atS * 1e6)) * 1000n, 5);
        socket.send(Buffer.concat([head, bytes]));
      }
    };
    socket.send(JSON.stringify({ op: 'serverInfo', name: 'a robot', capabilities: [] }));
    if (first !== undefined) socket.send(first);
    socket.send(JSON.stringify({ op: 'advertise', channels }));
  });
  await new Promise((resolve) => server.once('listening', resolve));
  return {
    url: `ws://127.0.0.1:${server.address().port}`,
    close: () => {
      for (const client of server.clients) client.terminate();
      return new Promise((resolve) => server.close(resolve));
    },
  };
}

/** Starts the official server of Foxglove's WebSocket protocol, which sends a recording; resolves with its address. */
export async function officialRobot(recording) {
  const script = fileURLToPath(new URL('../official_robot.py', import.meta.url));
  const robot = spawn(PYTHON, [script, recording], { stdio: ['pipe', 'pipe', 'inherit'] });
  const over = new Promise((resolve) => robot.once('close', resolve));
  // It ends with its input.
  const close = () => {
    robot.stdin.end();
    return over;
  };
  for await (const url of createInterface({ input: robot.stdout })) return { url, close };
  throw new Error(`tests/official_robot.py ended with ${await over}`);
}
