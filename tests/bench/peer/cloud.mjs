// Clouds as `{ xs, ys, normals }`, and the chapter's map: a hash of cells with a few points each.
// A normal is `[nx, ny]`, or null where a point has none.

/** One whole number for a cell: each index has 16 bits. */
const key = (i, j) => (i << 16) | (j & 0xffff);

/**
 * The cloud moved by a pose. A beam straight ahead or abeam lies on an edge of a cell, and the last
 * bits, so the order of these sums, decide which cell it fills: one lap of `lap.json` shows it.
 */
export function transform({ xs, ys, normals }, { x, y, theta }) {
  const cos = Math.cos(theta);
  const sin = Math.sin(theta);
  return {
    xs: xs.map((px, k) => x + cos * px - sin * ys[k]),
    ys: xs.map((px, k) => y + sin * px + cos * ys[k]),
    normals: normals?.map((n) => n && [cos * n[0] - sin * n[1], sin * n[0] + cos * n[1]]),
  };
}

export function join(clouds) {
  return {
    xs: clouds.flatMap(({ xs }) => xs),
    ys: clouds.flatMap(({ ys }) => ys),
    normals: clouds.flatMap(({ normals }) => normals),
  };
}

/** The centroid of each cell's points, in the order in which the cells were met. */
export function downsample({ xs, ys }, cell) {
  const sums = new Map();
  for (let k = 0; k < xs.length; k++) {
    const at = key(Math.floor(xs[k] / cell), Math.floor(ys[k] / cell));
    const sum = sums.get(at);
    if (sum === undefined) {
      sums.set(at, { x: xs[k], y: ys[k], count: 1 });
    } else {
      sum.x += xs[k];
      sum.y += ys[k];
      sum.count += 1;
    }
  }
  const thinned = [...sums.values()];
  return {
    xs: thinned.map(({ x, count }) => x / count),
    ys: thinned.map(({ y, count }) => y / count),
  };
}

export class VoxelMap {
  constructor({ xs, ys, normals }, cell, maxPerCell) {
    Object.assign(this, { xs, ys, normals, cell, buckets: new Map() });
    for (let k = 0; k < xs.length; k++) {
      const at = key(Math.floor(xs[k] / cell), Math.floor(ys[k] / cell));
      const bucket = this.buckets.get(at);
      if (bucket === undefined) this.buckets.set(at, [k]);
      else if (bucket.length < maxPerCell) bucket.push(k);
    }
  }

  /** Calls `visit` with the bucket of every cell that a circle about `(x, y)` can touch. */
  forEachBucket(x, y, radius, visit) {
    const ring = Math.max(1, Math.ceil(radius / this.cell));
    const ci = Math.floor(x / this.cell);
    const cj = Math.floor(y / this.cell);
    for (let i = ci - ring; i <= ci + ring; i++) {
      for (let j = cj - ring; j <= cj + ring; j++) {
        const bucket = this.buckets.get(key(i, j));
        if (bucket !== undefined) visit(bucket);
      }
    }
  }

  /** Index and squared distance of the nearest point closer than `radius`; index −1 without one. */
  nearest(x, y, radius) {
    let index = -1;
    let squared = radius * radius;
    this.forEachBucket(x, y, radius, (bucket) => {
      for (const k of bucket) {
        const dx = this.xs[k] - x;
        const dy = this.ys[k] - y;
        const candidate = dx * dx + dy * dy;
        if (candidate < squared) {
          index = k;
          squared = candidate;
        }
      }
    });
    return { index, squared };
  }

  within(x, y, radius) {
    const found = [];
    this.forEachBucket(x, y, radius, (bucket) => {
      for (const k of bucket) {
        const dx = this.xs[k] - x;
        const dy = this.ys[k] - y;
        if (dx * dx + dy * dy <= radius * radius) found.push(k);
      }
    });
    return found;
  }
}

/** The cloud with a normal for each point: the direction in which its neighbours scatter least. */
export function withNormals({ xs, ys }, radius) {
  const map = new VoxelMap({ xs, ys }, Math.max(radius, 0.05), 64);
  const normals = xs.map((x, k) => {
    const near = map.within(x, ys[k], radius);
    return near.length < 4 ? null : normalOf(near, xs, ys);
  });
  return { xs, ys, normals };
}

function normalOf(near, xs, ys) {
  let mx = 0;
  let my = 0;
  for (const k of near) {
    mx += xs[k];
    my += ys[k];
  }
  mx /= near.length;
  my /= near.length;
  let xx = 0;
  let xy = 0;
  let yy = 0;
  for (const k of near) {
    const dx = xs[k] - mx;
    const dy = ys[k] - my;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  const { smallest, largest } = eigenvalues(xx, xy, yy);
  if (smallest / Math.max(largest, 1e-12) > 0.35) return null;
  const x = xx > yy ? xx - smallest : xy;
  const y = xx > yy ? xy : yy - smallest;
  const length = Math.sqrt(x * x + y * y);
  return length > 0 ? [-y / length, x / length] : null;
}

/** Of the symmetric matrix `[xx xy; xy yy]`. */
export function eigenvalues(xx, xy, yy) {
  const middle = 0.5 * (xx + yy);
  const half = 0.5 * (xx - yy);
  const gap = Math.sqrt(half * half + xy * xy);
  return { smallest: middle - gap, largest: middle + gap };
}
