// The picture that a link to the site is shown with, as a PNG: services that show links read no SVG.

import { deflateSync } from 'node:zlib';

const WIDTH = 1200;
const HEIGHT = 630;
/** The lap is a strip in the middle of the card. */
const TOP = 65;

/** Draws by `draw(surface)`, a surface of `world/surfaces.ts` without words; returns the file. */
export function card(draw, inks) {
  const pixels = new Uint8Array(3 * WIDTH * HEIGHT);
  const channels = (color) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
  const span = (y, from, to, rgb, alpha) => {
    if (y < 0 || y >= HEIGHT) return;
    for (let x = Math.max(Math.round(from), 0); x < Math.min(Math.round(to), WIDTH); x += 1) {
      rgb.forEach((value, i) => {
        const at = 3 * (y * WIDTH + x) + i;
        pixels[at] += alpha * (value - pixels[at]);
      });
    }
  };
  /** Fills a polygon row by row. */
  const fill = (points, color, alpha = 1) => {
    const rgb = channels(color);
    const ys = points.map(([, y]) => y);
    for (let y = Math.floor(Math.min(...ys)); y <= Math.max(...ys); y += 1) {
      const cuts = points.flatMap(([x0, y0], k) => {
        const [x1, y1] = points[(k + 1) % points.length];
        return y0 <= y + 0.5 !== y1 <= y + 0.5 ? [x0 + ((y + 0.5 - y0) / (y1 - y0)) * (x1 - x0)] : [];
      }).sort((a, b) => a - b);
      for (let k = 0; k + 1 < cuts.length; k += 2) span(y, cuts[k], cuts[k + 1], rgb, alpha);
    }
  };
  const circle = (x, y, radius) => Array.from({ length: 16 }, (_, k) => [x + radius * Math.cos((k * Math.PI) / 8), y + radius * Math.sin((k * Math.PI) / 8)]);
  const box = (x0, y0, x1, y1) => [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
  fill(box(0, 0, WIDTH, HEIGHT), inks.paper);
  const lower = (points) => points.map(([x, y]) => [x, y + TOP]);
  const line = (points, color, width, alpha, isSquare) => {
    points.slice(1).forEach(([x1, y1], k) => {
      const [x0, y0] = points[k];
      const by = (0.5 * width) / (Math.hypot(x1 - x0, y1 - y0) || 1);
      const [dx, dy] = [by * (x1 - x0), by * (y1 - y0)];
      const [ex, ey] = isSquare ? [dx, dy] : [0, 0];
      fill([[x0 - dy - ex, y0 + dx - ey], [x1 - dy + ex, y1 + dx + ey], [x1 + dy + ex, y1 - dx + ey], [x0 + dy - ex, y0 - dx - ey]], color, alpha);
    });
  };
  let isDrawn = false;
  draw({
    lines(lines, ink, width, { alpha = 1, isSquare = false } = {}) {
      // A bar of a metre says nothing without its words.
      if (isDrawn) return;
      for (const points of lines) line(lower(points), inks[ink], width, alpha, isSquare);
    },
    area: (points, ink, alpha) => fill(lower(points), inks[ink], alpha),
    fan: (center, rim, ink, [inner, outer]) => fill(lower([center, ...rim]), inks[ink], (inner + outer) / 2),
    discs(points, ink, radius) {
      for (const [x, y] of lower(points)) fill(circle(x, y, radius), inks[ink]);
    },
    mist(points, ink, side) {
      for (const [x, y] of lower(points)) fill(circle(x, y, 0.6 * side), inks[ink], 0.3);
    },
    fade(_size, [, above]) {
      for (let y = 0; y < above; y += 1) {
        for (const row of [y, HEIGHT - 1 - y]) fill(box(0, row, WIDTH, row + 1), inks.paper, 1 - y / above);
      }
      isDrawn = true;
    },
    words() {},
  }, WIDTH);
  return png(pixels);
}

function png(pixels) {
  const rows = Buffer.alloc((3 * WIDTH + 1) * HEIGHT);
  for (let y = 0; y < HEIGHT; y += 1) rows.set(pixels.subarray(3 * WIDTH * y, 3 * WIDTH * (y + 1)), (3 * WIDTH + 1) * y + 1);
  const head = Buffer.alloc(13);
  head.writeUInt32BE(WIDTH, 0);
  head.writeUInt32BE(HEIGHT, 4);
  // Eight bits of red, green and blue.
  head.set([8, 2, 0, 0, 0], 8);
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name, 'latin1'), data]);
    const [length, check] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(data.length);
    check.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, check]);
  };
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([signature, chunk('IHDR', head), chunk('IDAT', deflateSync(rows, { level: 9 })), chunk('IEND', Buffer.alloc(0))]);
}

/** The check of a chunk: CRC-32 of PNG (ISO 15948), bit by bit. */
function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit += 1) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}
