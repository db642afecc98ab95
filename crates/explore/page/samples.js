// What the program answered about motions, with names for the places of the numbers.

import { read } from "./arrows.js";
import { look } from "./look.js";

// A place and a rotation.
class Pose {
  constructor(numbers, from) {
    const at = (i) => numbers[from + i];
    this.at = [at(0), at(1), at(2)];
    this.rotation = [[at(3), at(4), at(5)], [at(6), at(7), at(8)], [at(9), at(10), at(11)]];
  }

  place(p) {
    const { at, rotation: r } = this;
    return [0, 1, 2].map((i) => at[i] + r[i][0] * p[0] + r[i][1] * p[1] + r[i][2] * p[2]);
  }
}

// One motion: rows of t, coordinates, velocities, multipliers, invariants, observables, arrows, track and poses.
class Motion {
  constructor(answer, numbers, names, bodies, further, contacts) {
    Object.assign(this, answer);
    this.numbers = numbers;
    this.bodies = bodies.filter((body) => body.moved);
    this.look = look(answer.formulation, further);
    const groups = { coordinate: names, velocity: names.map((name) => `${name}'`), multiplier: answer.multipliers,
      invariant: answer.invariants, observable: answer.observables };
    this.columns = {};
    let place = 1;
    for (const [group, columns] of Object.entries(groups)) {
      this.columns[group] = Object.fromEntries(columns.map((name) => [name, place++]));
    }
    this.contacts = contacts;
    this.arrowPlace = place;
    this.trackPlace = place + (contacts ? 10 + 6 * contacts : 0);
  }

  // Velocity, reaction and virtual displacements in a row, where they were asked for.
  arrows(row) {
    return read((i) => this.value(row, this.arrowPlace + i), this.contacts);
  }

  value(row, column) {
    return this.numbers[this.from + row * this.width + column];
  }

  time(row) {
    return this.value(row, 0);
  }

  column(column) {
    return Array.from({ length: this.rows }, (_, row) => this.value(row, column));
  }

  // The last row not after t, and how far it is to the next.
  locate(t) {
    let [low, high] = [0, this.rows - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time(middle) <= t) low = middle;
      else high = middle - 1;
    }
    const [a, b] = [this.time(low), this.time(Math.min(low + 1, this.rows - 1))];
    return [low, b > a ? Math.min(1, Math.max(0, (t - a) / (b - a))) : 0];
  }

  place(row) {
    return this.from + row * this.width + this.trackPlace;
  }

  track(row) {
    const at = this.place(row);
    return [this.numbers[at], this.numbers[at + 1], this.numbers[at + 2]];
  }

  trackAt(t) {
    const [row, part] = this.locate(t);
    const [a, b] = [this.track(row), this.track(Math.min(row + 1, this.rows - 1))];
    return a.map((x, i) => x + part * (b[i] - x));
  }

  *poses(row) {
    for (const [i, body] of this.bodies.entries()) yield [new Pose(this.numbers, this.place(row) + 3 + 12 * i), body];
  }

  // Between rows: straight, which for a rotation is right as long as rows are near.
  *posesAt(t) {
    const [row, part] = this.locate(t);
    const next = [...this.poses(Math.min(row + 1, this.rows - 1))];
    const between = (a, b) => a.map((x, i) => x + part * (b[i] - x));
    for (const [i, [pose, body]] of [...this.poses(row)].entries()) {
      const [after] = next[i];
      pose.at = between(pose.at, after.at);
      pose.rotation = pose.rotation.map((r, axis) => between(r, after.rotation[axis]));
      yield [pose, body];
    }
  }
}

export class Samples {
  constructor({ answer, numbers, milliseconds }, coordinates) {
    const names = coordinates.map(({ name }) => name);
    const counts = {};
    const known = coordinates.filter(({ unit }) => unit);
    const units = known.flatMap(({ name, unit }) => [[`coordinate:${name}`, unit], [`velocity:${name}'`, `${unit}/s`]]);
    this.units = { gap: answer.gaps[0]?.unit, "observable:energy": "J", ...Object.fromEntries(units) };
    Object.assign(this, { start: answer.start, end: answer.end, times: answer.times, bodies: answer.bodies, milliseconds });
    this.numbers = numbers;
    this.all = answer.motions;
    this.contacts = answer.contacts ?? 0;
    this.grips = answer.grips ?? null;
    this.down = answer.down ?? undefined;
    this.length = known.some(({ unit }) => unit === "m") ? "m" : "";
    this.motions = answer.motions.flatMap((motion) => {
      const further = (counts[motion.formulation] = (counts[motion.formulation] ?? -1) + 1);
      return motion.refused ? [] : [new Motion(motion, numbers, names, answer.bodies, further, answer.contacts ?? 0)];
    });
    this.plane = this.motions.length ? this.pathIn(known.filter(({ unit }) => unit === "m").map(({ name }) => name)) : null;
    this.still = answer.ground;
    this.gaps = answer.gaps.map((gap) => {
      const column = (i) => Array.from({ length: gap.rows }, (_, row) => numbers[gap.from + 3 * row + i]);
      const [first, second] = [gap.first, gap.second].map((i) => answer.motions[i].label);
      return { ...gap, first, second, t: column(0), gap: column(1), limit: column(2) };
    });
  }

  // The plane of the path, the longer axis first: of two coordinates in metres, or else of two axes of space, in which the marked
  // points move; null if they do not move.
  pathIn(metres) {
    const isOwn = metres.length > 1;
    const names = isOwn ? metres.slice(0, 2) : ["x", "y", "z"];
    const at = (motion, row) => (isOwn ? names.map((name) => motion.value(row, motion.columns.coordinate[name])) : motion.track(row));
    const [first] = this.motions;
    const places = Array.from({ length: first.rows }, (_, row) => at(first, row));
    const long = names.map((_, i) => Math.max(...places.map((p) => p[i])) - Math.min(...places.map((p) => p[i])));
    const axes = [...names.keys()].sort((i, j) => long[j] - long[i]).slice(0, 2);
    // what is upright in space is so on the page
    if (axes[0] === 2) axes.reverse();
    return long[axes[0]] > 0 ? { names: axes.map((i) => names[i]), at: (motion, row) => axes.map((i) => at(motion, row)[i]) } : null;
  }

  // The row of the ground at t.
  rowAt(t) {
    const part = (t - this.start) / (this.end - this.start);
    return Math.round(Math.min(1, Math.max(0, part || 0)) * (this.times - 1));
  }

  *ground(row) {
    const bodies = this.bodies.filter((body) => !body.moved);
    const from = this.still.from + Math.min(row, this.still.rows - 1) * this.still.width;
    for (const [i, body] of bodies.entries()) yield [new Pose(this.numbers, from + 12 * i), body];
  }

  // Some poses of everything.
  *poses() {
    yield* this.ground(0);
    for (const motion of this.motions) {
      for (const row of [0, motion.rows >> 1, motion.rows - 1]) yield* motion.poses(row);
    }
  }
}
