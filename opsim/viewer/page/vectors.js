// Vectors of three numbers as arrays; for the few of a body where clarity is worth more than speed.

const HALF_TURN = 1e-4;

export const point = (joints, j) => [joints[3 * j], joints[3 * j + 1], joints[3 * j + 2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const plus = (a, b, k = 1) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
export const times = (a, k) => [a[0] * k, a[1] * k, a[2] * k];
export const mix = (a, b, u) => [a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

/** Length 1; nan in every part where shorter than a thousandth of a millimetre. */
export function unit(a) {
  const long = length(a);
  return long >= 1e-6 ? times(a, 1 / long) : [NaN, NaN, NaN];
}

/** How far to turn from one angle to another, the shorter way; half a turn goes left, whatever rounding says. */
export function turn(from, to) {
  const way = (to - from + Math.PI - HALF_TURN) % (2 * Math.PI);
  return (way < 0 ? way + 2 * Math.PI : way) - Math.PI + HALF_TURN;
}

export const smooth = (u) => (u <= 0 ? 0 : u >= 1 ? 1 : u * u * (3 - 2 * u));
