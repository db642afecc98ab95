// The start in the hand: the place of a body, where it points, and its velocity, each a button over the picture that is
// dragged, or moved by arrow keys. What numbers do to them comes from the program; the numbers that are set are the least
// change of those that leads there, so a start stays on the constraint as it does where numbers are typed.

import { arrow, nice } from "./arrows.js";
import { ink } from "./look.js";

const KINDS = [["place", "place of the body"], ["heading", "where the body points"], ["velocity", "velocity of the body"]];
const HINT = "At the start, drag the rings – place, heading, velocity – or use arrow keys.";
// Pixels of an arrow key, and with shift.
const STEPS = [10, 1];
// Weight of numbers that should not move.
const ASIDE = 0.03;
// Length of the handles, as a fraction of the picture's smaller side, and its least value in pixels, so that
// rings do not overlap.
const ARM = 0.12;
const APART = 48;
// Where each stands in what the program says; what is smaller is no derivative, and no change.
const FROM = { place: 0, heading: 3, velocity: 6 };
const LEAST = [1e-4, 1e-6];

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const plus = (a, b, by) => a.map((x, i) => x + by * b[i]);

// The least x with A x = b, or nearest to it: Aᵀ y with (A Aᵀ + ε) y = b.
export function least(rows, goal) {
  const m = rows.map((row, i) => [...rows.map((other) => dot(row, other)), goal[i]]);
  const size = rows.reduce((sum, row) => sum + dot(row, row), 0);
  m.forEach((row, i) => (row[i] += 1e-9 * size + 1e-300));
  for (let i = 0; i < m.length; i++) {
    for (let k = i + 1; k < m.length; k++) m[k] = plus(m[k], m[i], -m[k][i] / m[i][i]);
  }
  const y = [];
  for (let i = m.length - 1; i >= 0; i--) y[i] = (m[i].at(-1) - dot(m[i].slice(i + 1, -1), y.slice(i + 1))) / m[i][i];
  return rows[0].map((_, j) => rows.reduce((sum, row, i) => sum + y[i] * row[j], 0));
}

export class Grips {
  // `give` takes numbers by name, and whether the hand moves on.
  constructor(frame, stage, give) {
    Object.assign(this, { stage, give, samples: null, wanted: false });
    this.buttons = KINDS.map(([kind, label]) => {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", className: "grip", hidden: true, ariaLabel: label });
      button.dataset.grip = kind;
      button.setAttribute("aria-describedby", "note");
      frame.append(button);
      this.listen(button, kind);
      return button;
    });
    stage.over = (pen) => this.draw(pen);
  }

  show(samples, wanted) {
    Object.assign(this, { samples, wanted });
    this.stage.hint = wanted && samples.grips ? HINT : "";
  }

  // Whether there is something to take hold of now.
  is() {
    const { samples, stage } = this;
    return Boolean(this.wanted && samples?.grips && samples.motions.length && stage.t === samples.start);
  }

  // Where each of them is, in space.
  places() {
    const { here } = this.samples.grips;
    const [place, along, velocity] = [0, 3, 6].map((from) => here.slice(from, from + 3));
    const { scale } = this.stage.projection();
    const { canvas } = this.stage;
    const arm = Math.max(ARM * Math.min(canvas.width, canvas.height), APART * devicePixelRatio) / scale;
    const speed = Math.hypot(...velocity);
    // seconds of the arrow, where it begins beside the body, and where the ring of the heading is: on the other side; all stay
    // while one of them is dragged
    if (!this.dragged || !this.arms) {
      const forward = speed > 0 ? velocity.map((x) => x / speed) : along;
      const [right, up] = this.stage.axes();
      // longer where it is seen from its end
      const length = (axis) => arm / Math.max(0.25, Math.hypot(dot(right, axis), dot(up, axis)));
      const [nose, heading] = [0.8 * length(forward), 1.3 * length(along)];
      this.arms = { seconds: nice((2 * arm) / Math.max(speed, arm / 10)), nose: forward.map((x) => nose * x), heading: dot(forward, along) < 0 ? heading : -heading };
    }
    const nose = plus(place, this.arms.nose, 1);
    return { place, heading: plus(place, along, this.arms.heading), nose, velocity: plus(nose, velocity, this.arms.seconds) };
  }

  // The buttons where they belong, and lines to them.
  draw(pen) {
    const is = this.is();
    for (const button of this.buttons) button.hidden = !is || !this.moves(button.dataset.grip);
    const has = (kind) => !this.buttons.find(({ dataset }) => dataset.grip === kind).hidden;
    if (!is) return;
    const { project } = pen.view;
    const places = this.places();
    const colour = ink("ink");
    const { context, ratio } = pen;
    if (has("heading")) {
      context.strokeStyle = colour;
      context.lineWidth = ratio;
      context.setLineDash([2 * ratio, 3 * ratio]);
      context.beginPath();
      context.moveTo(...project(places.place));
      context.lineTo(...project(places.heading));
      context.stroke();
      context.setLineDash([]);
    }
    if (has("velocity")) arrow(pen, project(places.nose), project(places.velocity), { colour, width: 1.4 });
    for (const button of this.buttons) {
      const [x, y] = project(places[button.dataset.grip]).map((x) => x / devicePixelRatio);
      button.style.translate = `${x}px ${y}px`;
    }
  }

  // The numbers that move one of them: those of velocities, which move nothing else, or the others.
  used(kind) {
    const isVelocity = ({ by }) => by.slice(0, 6).every((x) => x === 0);
    return this.samples.grips.numbers.filter((number) => isVelocity(number) === (kind === "velocity"));
  }

  // Whether any of them does.
  moves(kind) {
    return this.used(kind).some(({ by }) => by.slice(FROM[kind], FROM[kind] + 3).some((x) => Math.abs(x) > LEAST[0]));
  }

  // Numbers that move one of them by pixels of the page.
  numbers(kind, [dx, dy]) {
    const { scale } = this.stage.projection();
    const [right, up] = this.stage.axes();
    const used = this.used(kind);
    const along = (axis, from, size) => used.map(({ by }) => size * dot(axis, by.slice(from, from + 3)));
    this.places();
    const size = { place: 1, heading: this.arms.heading, velocity: this.arms.seconds }[kind];
    const rows = [right, up].map((axis) => along(axis, FROM[kind], size));
    // a body that is moved does not turn, one that is turned does not move, as far as that can be
    const other = { place: FROM.heading, heading: FROM.place }[kind];
    const rest = other === undefined ? [] : [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => along(axis, other, ASIDE));
    const goal = [dx, -dy].map((x) => (x * devicePixelRatio) / scale);
    const change = least([...rows, ...rest], [...goal, ...rest.map(() => 0)]);
    const moved = used.map(({ name, value }, i) => [name, value, Number((value + change[i]).toPrecision(6))]);
    const isMoved = ([, before, after]) => Number.isFinite(after) && Math.abs(after - before) > LEAST[1] * (1 + Math.abs(before));
    return Object.fromEntries(moved.filter(isMoved).map(([name, , after]) => [name, after]));
  }

  move(kind, by, moving) {
    if (!this.is()) return;
    const numbers = this.moves(kind) ? this.numbers(kind, by) : {};
    if (Object.keys(numbers).length || !moving) this.give(numbers, moving);
  }

  listen(button, kind) {
    const at = () => this.stage.projection().project(this.places()[kind]).map((x) => x / devicePixelRatio);
    let [offset, went] = [null, false];
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      const [x, y] = at();
      offset = [event.clientX - x, event.clientY - y];
      [this.dragged, went] = [true, false];
      this.stage.hold(true);
    });
    button.addEventListener("pointermove", (event) => {
      if (!offset) return;
      const [x, y] = at();
      went = true;
      this.move(kind, [event.clientX - offset[0] - x, event.clientY - offset[1] - y], true);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      button.addEventListener(end, () => {
        if (!offset) return;
        offset = null;
        this.dragged = false;
        this.stage.hold(false);
        if (went) this.give({}, false);
      });
    }
    button.addEventListener("keydown", (event) => {
      const far = STEPS[event.shiftKey ? 1 : 0];
      const by = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] }[event.key];
      if (!by || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      this.move(kind, by, false);
    });
  }
}
