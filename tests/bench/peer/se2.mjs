// Poses of the plane as `{ x, y, theta }`: metres, radians, theta in (−π, π].

export const wrap = (angle) => {
  const turned = angle % (2 * Math.PI);
  if (turned > Math.PI) return turned - 2 * Math.PI;
  return turned <= -Math.PI ? turned + 2 * Math.PI : turned;
};

export const pose = (x, y, theta) => ({ x, y, theta: wrap(theta) });

export const identity = () => ({ x: 0, y: 0, theta: 0 });

/** `a ∘ b`: `b` seen from where `a` leads. */
export function compose(a, b) {
  const cos = Math.cos(a.theta);
  const sin = Math.sin(a.theta);
  return pose(a.x + cos * b.x - sin * b.y, a.y + sin * b.x + cos * b.y, a.theta + b.theta);
}

export function inverse({ x, y, theta }) {
  const cos = Math.cos(theta);
  const sin = Math.sin(theta);
  return pose(-cos * x - sin * y, sin * x - cos * y, -theta);
}

/** `a⁻¹ ∘ b`: the pose `b` in the frame of `a`. */
export function between(a, b) {
  const cos = Math.cos(a.theta);
  const sin = Math.sin(a.theta);
  const dx = b.x - a.x;
  const dy = b.y - a.y;
  return pose(cos * dx + sin * dy, cos * dy - sin * dx, b.theta - a.theta);
}

/** sin θ / θ and (1 − cos θ) / θ, without the digits that 1 − cos loses near 0. */
function arcTerms(theta) {
  if (Math.abs(theta) < 1e-4) return [1 - (theta * theta) / 6, theta * (0.5 - (theta * theta) / 24)];
  const sin = Math.sin(theta);
  const cos = Math.cos(theta);
  return [sin / theta, (cos > 0 ? (sin * sin) / (1 + cos) : 1 - cos) / theta];
}

/** The motion of the twist `[vx, vy, omega]` held for one unit of time. */
export function exp([vx, vy, omega]) {
  const [a, b] = arcTerms(omega);
  return pose(a * vx - b * vy, b * vx + a * vy, omega);
}

/** The twist `[vx, vy, omega]` whose motion this is. */
export function log({ x, y, theta }) {
  const [a, b] = arcTerms(theta);
  const scale = a * a + b * b;
  return [(a * x + b * y) / scale, (a * y - b * x) / scale, theta];
}

/** `‖(vx, vy)‖ + |omega|`, by which loops decide that nothing moves any more. */
export const size = ([vx, vy, omega]) => Math.sqrt(vx * vx + vy * vy) + Math.abs(omega);

export const distance = (a, b) => Math.sqrt((a.x - b.x) ** 2 + (a.y - b.y) ** 2);
