// Boxes of a picture, [left, low, right, high], and which of them are seen together.

// What is joined to a box widens it at most this many times.
const WIDENED = 2;

export const empty = () => [Infinity, Infinity, -Infinity, -Infinity];

export const size = (w) => Math.hypot(w[2] - w[0], w[3] - w[1]);

export const join = (a, b) => a.map((x, i) => (i < 2 ? Math.min(x, b[i]) : Math.max(x, b[i])));

// Widens a box by a circle.
export function add(w, x, y, r = 0) {
  [w[0], w[1], w[2], w[3]] = join(w, [x - r, y - r, x + r, y + r]);
}

// The first box with the others that are near it, and which of these are not.
export function near(first, others) {
  const far = others.filter((w) => size(join(w, first)) > WIDENED * size(first));
  return [others.filter((w) => !far.includes(w)).reduce(join, first), far];
}
