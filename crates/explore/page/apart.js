// Differences from the first motion, drawn larger than they are.

const plus = (a, b, by) => a.map((x, i) => x + by * (b[i] - x));
const times = (a, b) => a.map((row) => [0, 1, 2].map((j) => row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]));
const turned = (a) => [0, 1, 2].map((i) => [0, 1, 2].map((j) => a[j][i]));

// The rotation about the axis of `r`, by an angle as many times as large.
function multiplied(r, by) {
  const axis = [(r[2][1] - r[1][2]) / 2, (r[0][2] - r[2][0]) / 2, (r[1][0] - r[0][1]) / 2];
  const sine = Math.hypot(...axis);
  if (sine < 1e-12) return r;
  const [x, y, z] = axis.map((a) => a / sine);
  const angle = by * Math.atan2(sine, (r[0][0] + r[1][1] + r[2][2] - 1) / 2);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const d = 1 - c;
  return [[c + x * x * d, x * y * d - z * s, x * z * d + y * s], [y * x * d + z * s, c + y * y * d, y * z * d - x * s], [z * x * d - y * s, z * y * d + x * s, c + z * z * d]];
}

// Motions as they are drawn: each place and turn is that of the first motion and `by` times the difference from it.
export class Apart {
  constructor(first, by) {
    Object.assign(this, { first, by });
  }

  is(motion) {
    return this.by !== 1 && motion !== this.first;
  }

  // The last row that both motions have.
  last(motion) {
    if (!this.is(motion)) return motion.rows - 1;
    const last = Math.min(motion.rows, this.first.rows) - 1;
    return this.first.time(last) === motion.time(last) ? last : last - 1;
  }

  track(motion, row) {
    return this.is(motion) ? plus(this.first.track(row), motion.track(row), this.by) : motion.track(row);
  }

  trackAt(motion, t) {
    if (!this.is(motion)) return motion.trackAt(t);
    const at = Math.min(t, motion.time(this.last(motion)));
    return plus(this.first.trackAt(at), motion.trackAt(at), this.by);
  }

  *poses(motion, row) {
    yield* this.is(motion) ? this.apart(this.first.poses(row), motion.poses(row)) : motion.poses(row);
  }

  *posesAt(motion, t) {
    const at = Math.min(t, motion.time(this.last(motion)));
    yield* this.is(motion) ? this.apart(this.first.posesAt(at), motion.posesAt(at)) : motion.posesAt(t);
  }

  *apart(first, poses) {
    const from = [...first];
    for (const [i, [pose, body]] of [...poses].entries()) {
      const [base] = from[i];
      const turn = multiplied(times(turned(base.rotation), pose.rotation), this.by);
      pose.at = plus(base.at, pose.at, this.by);
      pose.rotation = times(base.rotation, turn);
      yield [pose, body];
    }
  }
}
