// What is drawn beside the bodies: which way is down, axes and a scale; and where it is asked for, velocities,
// reactions at the contacts, and virtual displacements, between the rails that the constraint leaves.

import { figure } from "./names.js";
import { ink } from "./look.js";

// The longest arrow of a kind in the first motion, and half a virtual displacement, as parts of the picture's smaller
// side. Arrows of others that are over twice as long are cut there, which two heads say.
const LONGEST = { velocity: 0.2, force: 0.24 };
const CUT = 2;
const DISPLACEMENT = 0.09;
// Parts below this are none.
const LEAST = 1e-6;

const plus = (a, b, by = 1) => a.map((x, i) => x + by * b[i]);

// A line with a head at its end, or at both.
export function arrow({ context, ratio }, from, to, { colour, width = 2, both = false }) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(dx, dy);
  if (!(length > 3 * ratio)) return;
  const head = Math.min(length / 2, (4 + 2 * width) * ratio);
  const [ux, uy] = [dx / length, dy / length];
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = width * ratio;
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(to[0] - 0.7 * head * ux, to[1] - 0.7 * head * uy);
  context.stroke();
  for (const [tip, side] of both ? [[to, 1], [from, -1]] : [[to, 1]]) {
    context.beginPath();
    context.moveTo(...tip);
    for (const across of [-0.45, 0.45]) context.lineTo(tip[0] - side * head * (ux - across * uy), tip[1] - side * head * (uy + across * ux));
    context.fill();
  }
}

function label({ context, ratio }, text, [x, y], colour = ink("soft"), align = "left") {
  context.fillStyle = colour;
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  context.textAlign = align;
  context.fillText(text, x, y);
}

// The largest speed and force of a motion, after which lengths of arrows go.
export function sizes(motion) {
  const largest = { velocity: 0, force: 0 };
  for (let row = 0; row < (motion?.rows ?? 0); row++) {
    const { velocity, contacts } = motion.arrows(row);
    largest.velocity = Math.max(largest.velocity, Math.hypot(...velocity));
    for (const { force } of contacts) largest.force = Math.max(largest.force, Math.hypot(...force));
  }
  return largest;
}

// The arrows of one motion at a time, which go with the place where it is drawn.
export function forces(pen, motion, t, largest, side, mark) {
  const { view, ratio } = pen;
  const { velocity, directions, contacts } = motion.arrows(motion.locate(t)[0]);
  const at = motion.trackAt(t);
  const shifted = (place) => place.map((x, i) => x + mark[i] - at[i]);
  const { colour } = motion.look;
  const pointed = (kind, place, vector, width) => {
    const part = Math.hypot(...vector) / largest[kind];
    // of a first motion without any there is no measure
    if (!(part > LEAST && part < Infinity)) return;
    const by = (Math.min(1, CUT / part) * LONGEST[kind] * side) / view.scale / largest[kind];
    const to = (far) => view.project(plus(place, vector, far * by));
    arrow(pen, view.project(place), to(1), { colour, width });
    if (part > CUT) arrow(pen, view.project(place), to(0.9), { colour, width });
  };
  rails(pen, mark, directions, (DISPLACEMENT * side) / view.scale);
  pointed("velocity", mark, velocity, 1.4);
  for (const { place, force } of contacts) pointed("force", shifted(place), force, 3.2);
  pen.context.lineWidth = ratio;
}

// Virtual displacements of a place: along one line, between rails; in a plane, a disc; none, a cross.
function rails(pen, mark, directions, reach) {
  const { context, view, ratio } = pen;
  const colour = ink("ink");
  const from = view.project(mark);
  context.strokeStyle = colour;
  context.lineWidth = ratio;
  context.setLineDash([3 * ratio, 3 * ratio]);
  context.beginPath();
  if (directions.length === 2) {
    for (let i = 0; i <= 32; i++) {
      const [c, s] = [Math.cos((Math.PI * i) / 16), Math.sin((Math.PI * i) / 16)];
      const at = view.project(plus(plus(mark, directions[0], reach * c), directions[1], reach * s));
      if (i) context.lineTo(...at);
      else context.moveTo(...at);
    }
  } else if (directions.length === 1) {
    const [a, b] = [-reach, reach].map((by) => view.project(plus(mark, directions[0], by)));
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const [nx, ny] = [(-(b[1] - a[1]) / length) * 7 * ratio, ((b[0] - a[0]) / length) * 7 * ratio];
    for (const side of [-1, 1]) {
      context.moveTo(a[0] + side * nx, a[1] + side * ny);
      context.lineTo(b[0] + side * nx, b[1] + side * ny);
    }
  } else {
    const r = 6 * ratio;
    for (const side of [-1, 1]) {
      context.moveTo(from[0] - r, from[1] - side * r);
      context.lineTo(from[0] + r, from[1] + side * r);
    }
  }
  context.stroke();
  context.setLineDash([]);
  for (const direction of directions) {
    const [a, b] = [-reach, reach].map((by) => view.project(plus(mark, direction, by)));
    arrow(pen, a, b, { colour, width: 1.2, both: true });
  }
}

// Down, axes and a scale, in the lower right corner.
export function orientation(pen, { width, height }, { down, flat, unit }) {
  const { context, view, ratio } = pen;
  const colour = ink("soft");
  const origin = view.project([0, 0, 0]);
  const towards = (axis) => view.project(axis.map((x) => x / view.scale)).map((x, i) => x - origin[i]);
  const corner = [width - 46 * ratio, height - 48 * ratio];
  for (const [i, name] of (flat ? ["x", "y"] : ["x", "y", "z"]).entries()) {
    const [x, y] = towards([0, 1, 2].map((j) => Number(i === j)));
    const at = (far) => [corner[0] + x * far * ratio, corner[1] + y * far * ratio];
    arrow(pen, corner, at(26), { colour, width: 1.2 });
    if (Math.hypot(x, y) > 0.2) label(pen, name, [at(34)[0], at(34)[1] + 4 * ratio], colour, "center");
  }
  const length = nice((80 * ratio) / view.scale);
  const [left, y] = [width - 14 * ratio - length * view.scale, height - 12 * ratio];
  context.strokeStyle = colour;
  context.lineWidth = 1.4 * ratio;
  context.beginPath();
  for (const x of [left, left + length * view.scale]) {
    context.moveTo(x, y - 4 * ratio);
    context.lineTo(x, y + 4 * ratio);
  }
  context.moveTo(left, y);
  context.lineTo(left + length * view.scale, y);
  context.stroke();
  label(pen, `${length} ${unit}`.trim(), [left - 6 * ratio, y + 4 * ratio], colour, "right");
  if (!down) return;
  const [x, up] = towards(down);
  // from above nothing of it is seen
  if (Math.hypot(x, up) < 0.2) return;
  const from = [width - 34 * ratio, 30 * ratio];
  const to = [from[0] + (x * 44 * ratio) / Math.hypot(x, up), from[1] + (up * 44 * ratio) / Math.hypot(x, up)];
  arrow(pen, from, to, { colour: ink("ink"), width: 2.4 });
  label(pen, "down", [Math.min(from[0], to[0]) - 8 * ratio, (from[1] + to[1]) / 2 + 4 * ratio], ink("ink"), "right");
}

// The largest of 1, 2, 5 times a power of ten that is not over x.
export function nice(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  const [digit] = [5, 2, 1].filter((digit) => digit * power <= x);
  return Number((digit * power).toPrecision(1));
}

// The numbers of the arrows at a time, a line for each motion; where there are none, whether some are wanted.
export function told(samples, t, wanted) {
  if (samples?.contacts) return samples.motions.map((motion) => line(motion, t)).join("\n");
  return wanted ? "This scene has no bodies at which forces could be drawn." : "";
}

function line(motion, t) {
  const { velocity, rest, contacts } = motion.arrows(motion.locate(t)[0]);
  const sum = contacts.map(({ force }) => `${figure(Math.hypot(...force))} N`).join(", ");
  const part = rest > 0.01 ? `; ${figure(100 * rest)} % of the reaction is no force at a contact` : "";
  return `${motion.label}: speed ${figure(Math.hypot(...velocity))} m/s, reaction ${sum}${part}`;
}

// One row of what the program says of arrows.
export function read(at, contacts) {
  const three = (i) => [at(i), at(i + 1), at(i + 2)];
  const directions = [three(4), three(7)].filter((direction) => Math.hypot(...direction) > LEAST);
  const touch = (_, k) => ({ place: three(10 + 6 * k), force: three(13 + 6 * k) });
  return { velocity: three(0), rest: at(3), directions, contacts: Array.from({ length: contacts }, touch) };
}
