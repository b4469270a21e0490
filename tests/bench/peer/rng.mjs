// mulberry32, and normal numbers by the cosine branch of Box and Muller.

export class Rng {
  constructor(seed) {
    this.state = seed === 0 ? 0x9e3779b9 : seed;
  }

  /** One draw, uniform in [0, 1). */
  uniform() {
    this.state = (this.state + 0x6d2b79f5) >>> 0;
    let t = this.state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  }

  /** Two draws, also where the deviation is 0. */
  normal(mean, deviation) {
    const [u, v] = [this.aboveZero(), this.aboveZero()];
    return mean + deviation * Math.sqrt(-2 * Math.log(u)) * Math.cos(2 * Math.PI * v);
  }

  aboveZero() {
    for (;;) {
      const draw = this.uniform();
      if (draw !== 0) return draw;
    }
  }
}
