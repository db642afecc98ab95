// The bodies in motion on a canvas: outlines in axes of their own, places and rotations from the program.

import { Apart } from "./apart.js";
import * as arrows from "./arrows.js";
import { add, empty, join, near, size } from "./frame.js";
import { ink } from "./look.js";
import { Vector } from "./vector.js";

// Azimuth and elevation of the eye for what is not in a plane, as in the reports.
const OBLIQUE = [0.4, 0.5];
const MARGIN = 18;
// Pixels that a body has to reach; if it is smaller in the frame of the whole run, the camera goes with the bodies.
const SMALL = 22;
// Pixels of a picture that is too narrow for more than one body, beside which the others are ghosts.
const NARROW = 500;
// Floors beyond the one that is described, each way.
const FLOORS = 4;
// Opacity of ghosts.
const GHOST = 0.4;
// The choice of a camera that stays where it is.
export const REST = "rest";
// Size of the frame that follows a body, over the size of the body.
const ROUND = 2.5;

const still = matchMedia("(prefers-reduced-motion: reduce)");

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export class Stage {
  constructor(canvas, note) {
    this.canvas = canvas;
    this.note = note;
    this.zoom = 1;
    this.eye = null;
    this.window = null;
    // the motion that the camera goes with, how many times as large differences are drawn, whether the frame stays
    [this.follow, this.by, this.held, this.veiled] = ["", 1, false, () => []];
    new ResizeObserver(() => this.draw()).observe(canvas);
    this.listen();
  }

  // New samples; `anew` for another scene, whose frame is not eased to.
  show(samples, anew) {
    this.samples = samples;
    if (anew || !this.bodies) {
      this.eye = null;
      this.zoom = 1;
      this.window = null;
    }
    this.bodies = samples.bodies;
    this.apart = new Apart(samples.motions[0], this.by);
    this.flat = this.isFlat();
    this.largest = samples.contacts && arrows.sizes(samples.motions[0]);
    if (anew || !this.window || !this.held) this.frame();
    if (anew || !this.window) this.window = this.target;
    this.draw();
  }

  // The camera goes with that motion, or with none; differences are drawn `by` times as large.
  look(follow, by) {
    [this.follow, this.by] = [follow, by];
    if (!this.samples?.motions.length) return;
    this.apart = new Apart(this.samples.motions[0], by);
    this.frame();
    this.draw();
  }

  // While it is held, the frame is not moved by what comes.
  hold(is) {
    this.held = is;
    if (is || !this.samples?.motions.length) return;
    this.frame();
    this.draw();
  }

  // `veiled` says which of these motions are not shown.
  veil(veiled) {
    this.veiled = veiled;
    this.draw();
  }

  shown() {
    const hidden = this.veiled(this.samples.motions.map(({ label }) => label));
    return this.samples.motions.filter(({ label }) => !hidden.includes(label));
  }

  // Right, up and towards the eye.
  axes() {
    if (this.flat && !this.eye) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const [azimuth, elevation] = this.eye ?? OBLIQUE;
    const [s, c, up, level] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
    return [[-s, c, 0], [-c * up, -s * up, level], [c * level, s * level, up]];
  }

  isFlat() {
    const level = (pose, body) => {
      if (body.sphere && body.kind !== "point") return false;
      const points = body.lines.flat();
      return [[0, 0, 0], ...points].every((p) => Math.abs(pose.at[2] + dot(pose.rotation[2], p)) < 1e-9);
    };
    const { samples } = this;
    return [...samples.poses()].every(([pose, body]) => level(pose, body));
  }

  // Widens a box by a body.
  put(w, pose, body) {
    const [right, up] = this.axes();
    for (const p of body.lines.flat()) {
      const at = pose.place(p);
      add(w, dot(right, at), dot(up, at));
    }
    add(w, dot(right, pose.at), dot(up, pose.at), body.sphere ?? 0);
    return w;
  }

  // What is to be seen: the bodies that move, those of other motions unless they run far away, and what stands still near them;
  // not the floor.
  frame() {
    const [right, up] = this.axes();
    const { apart, samples: { motions } } = this;
    const windows = motions.map((motion) => {
      const w = empty();
      const last = apart.last(motion);
      const stride = Math.max(1, Math.floor(motion.rows / 24));
      for (let row = 0; row <= last; row += stride) {
        for (const [pose, body] of apart.poses(motion, row)) this.put(w, pose, body);
      }
      for (let row = 0; row <= last; row++) {
        const at = apart.track(motion, row);
        add(w, dot(right, at), dot(up, at));
      }
      return w;
    });
    if (!windows.length) return;
    const still = [...this.samples.ground(0)].filter(([, body]) => body.kind !== "plane").map((one) => this.put(empty(), ...one));
    const [around] = near(windows[0], still);
    const [all, far] = near(around, windows);
    const least = 1e-6 + 0.05 * size(all);
    this.target = [all[0] - least, all[1] - least, all[2] + least, all[3] + least];
    this.far = motions.filter((_, i) => far.includes(windows[i])).map(({ label }) => label);
    const notes = this.far.length ? [`${this.far.join(", ")}: runs out of the picture`] : [];
    if (this.by !== 1 && windows.length > 1) notes.unshift(`Differences from ${motions[0].label} are drawn ${this.by} times as large.`);
    if (this.hint) notes.unshift(this.hint);
    this.note.textContent = notes.join(" ");
  }

  // The motion that the camera goes with.
  followed() {
    return this.samples.motions.find(({ label }) => label === this.follow);
  }

  // How far bodies reach round the place whose path is drawn.
  reach(motion) {
    const from = motion.track(0);
    let reach = 0.01 * size(this.window);
    for (const [pose, body] of motion.poses(0)) {
      const far = (p) => Math.hypot(...p.map((x, i) => x - from[i]));
      reach = Math.max(reach, far(pose.at) + (body.sphere ?? 0), ...body.lines.flat().map((p) => far(pose.place(p))));
    }
    return reach;
  }

  // Whether there is room for one body only.
  isNarrow() {
    return this.canvas.clientWidth < NARROW;
  }

  // The box that is seen now: of the whole run; or of the bodies, or the one that the camera goes with, where they are.
  box(fit) {
    const [right, up] = this.axes();
    const followed = this.followed();
    const first = followed ?? this.samples.motions[0];
    const reach = this.reach(first);
    if (!followed && (this.follow === REST || fit * reach >= SMALL * devicePixelRatio)) return this.window;
    const { t } = this;
    const at = this.apart.trackAt(first, t);
    const [x, y] = [right, up].map((axis) => dot(axis, at));
    if (followed || this.isNarrow()) return [x - ROUND * reach, y - ROUND * reach, x + ROUND * reach, y + ROUND * reach];
    const others = this.shown().filter(({ label }) => !this.far.includes(label));
    const boxes = others.map((motion) => [...this.apart.posesAt(motion, t)].reduce((w, one) => this.put(w, ...one), empty()));
    const [left, low, far, high] = boxes.reduce(join, [x, y, x, y]);
    const room = 0.7 * reach;
    return [left - room, low - room, far + room, high + room];
  }

  // Pixels of a place.
  projection() {
    const { width, height } = this.canvas;
    const margin = MARGIN * devicePixelRatio;
    const fitted = (w) => Math.min((width - 2 * margin) / (w[2] - w[0]), (height - 2 * margin) / (w[3] - w[1]));
    const whole = fitted(this.window);
    // what is in the hand is not followed
    if (!this.held || !this.seen) this.seen = this.box(whole);
    const box = this.seen;
    const [right, up, eye] = this.axes();
    const [x, y] = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
    const scale = Math.max(whole, fitted(box)) * this.zoom;
    const project = (p) => [width / 2 + (dot(right, p) - x) * scale, height / 2 - (dot(up, p) - y) * scale];
    return { project, scale, depth: (p) => dot(eye, p), goes: size(box) < 0.99 * size(this.window) };
  }

  // Everything at time t.
  draw(t = this.t) {
    this.t = t;
    if (!this.samples?.motions.length || !this.target) return;
    const { canvas } = this;
    const ratio = devicePixelRatio;
    const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio].map(Math.round);
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const off = still.matches ? 0 : Math.max(...this.window.map((x, i) => Math.abs(x - this.target[i])));
    const eased = off > 1e-3 * Math.hypot(this.target[2] - this.target[0], this.target[3] - this.target[1]);
    this.window = eased ? this.window.map((x, i) => x + 0.25 * (this.target[i] - x)) : this.target;
    this.paint(canvas.getContext("2d"), canvas, ratio);
    if (eased) requestAnimationFrame(() => this.draw());
  }

  paint(context, { width, height }, ratio) {
    const { t, samples } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    context.lineJoin = "round";
    const view = this.projection();
    const pen = { context, view, ratio };
    const [line, floor] = [ink("ground"), ink("floor")];
    for (const [pose, body] of samples.ground(samples.rowAt(t))) {
      const poses = view.goes && body.kind === "plane" ? this.floors(pose, body) : [pose];
      for (const one of poses) draw(pen, one, body, line, 1, floor);
    }
    const shown = this.shown();
    for (const motion of shown) this.trail(pen, motion, t);
    for (const motion of shown) {
      const { colour, outline } = motion.look;
      context.globalAlpha = this.isGhost(motion) ? GHOST : 1;
      for (const [pose, body] of [...this.apart.posesAt(motion, t)].reverse()) draw(pen, pose, body, colour, outline, `${colour}2e`);
    }
    context.globalAlpha = 1;
    const side = Math.min(width, height);
    for (const motion of samples.contacts ? shown : []) {
      const mark = this.apart.trackAt(motion, t);
      arrows.forces(pen, motion, t, this.largest, side, mark);
    }
    this.over?.(pen);
    arrows.orientation(pen, { width, height }, { down: samples.down, flat: this.flat && !this.eye, unit: samples.length });
  }

  // In a narrow picture all but the first motion, or the one that the camera goes with, are ghosts.
  isGhost(motion) {
    return this.isNarrow() && motion !== (this.followed() ?? this.shown()[0]);
  }

  // A floor on which bodies run far is laid again and again, where they are.
  floors(pose, { lines }) {
    const [length, width] = [0, 1].map((axis) => 2 * Math.max(...lines.flat().map((p) => Math.abs(p[axis]))));
    const away = this.apart.trackAt(this.followed() ?? this.samples.motions[0], this.t).map((x, i) => x - pose.at[i]);
    const along = (axis) => pose.rotation.map((row) => row[axis]);
    const [i, j] = [length, width].map((size, axis) => Math.round(dot(along(axis), away) / size));
    const steps = Array.from({ length: 2 * FLOORS + 1 }, (_, k) => k - FLOORS);
    return steps.flatMap((k) => steps.map((l) => Object.assign(Object.create(pose), { at: pose.place([(i + k) * length, (j + l) * width, 0]) })));
  }

  // What is seen, as SVG.
  svg(title) {
    const vector = new Vector(this.canvas.width, this.canvas.height, ink("page"));
    this.paint(vector, this.canvas, devicePixelRatio);
    return vector.svg(title);
  }

  // The whole path thin, what has been run of it strong.
  trail({ context, view, ratio }, motion, t) {
    const { colour, dash, width } = motion.look;
    const path = (until, strong) => {
      context.beginPath();
      for (let row = 0; row <= this.apart.last(motion) && motion.time(row) <= until; row++) {
        const [x, y] = view.project(this.apart.track(motion, row));
        if (row) context.lineTo(x, y);
        else context.moveTo(x, y);
      }
      if (strong) context.lineTo(...view.project(this.apart.trackAt(motion, t)));
      context.strokeStyle = colour;
      context.globalAlpha = strong && !this.isGhost(motion) ? 1 : 0.3;
      context.lineWidth = (strong ? width * 0.8 : 1) * ratio;
      context.lineCap = dash[0] === 2 ? "round" : "butt";
      context.setLineDash(strong ? dash.map((x) => x * ratio) : []);
      context.stroke();
    };
    path(Infinity, false);
    path(t, true);
    context.globalAlpha = 1;
    context.setLineDash([]);
    context.lineCap = "butt";
  }

  listen() {
    const { canvas } = this;
    const fingers = new Map();
    const apart = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!fingers.has(event.pointerId)) return;
      const before = fingers.size === 2 && apart();
      const { x, y } = fingers.get(event.pointerId);
      fingers.set(event.pointerId, event);
      // one turns, two draw apart
      if (before) this.magnify(apart() / before);
      else if (fingers.size === 1) this.turn(event.x - x, event.y - y);
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, ({ pointerId }) => fingers.delete(pointerId));
    canvas.addEventListener("dblclick", () => this.reset());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.magnify(Math.exp(-event.deltaY / 500));
    }, { passive: false });
  }

  // What is in a plane is seen from above.
  turn(dx, dy) {
    if (this.flat && !this.eye) return;
    const [azimuth, elevation] = this.eye ?? OBLIQUE;
    this.eye = [azimuth - dx / 150, Math.min(Math.PI / 2, Math.max(-0.2, elevation + dy / 150))];
    this.frame();
    this.draw();
  }

  magnify(factor) {
    this.zoom = Math.min(50, Math.max(0.2, this.zoom * factor));
    this.draw();
  }

  reset() {
    [this.eye, this.zoom] = [null, 1];
    if (!this.samples) return;
    this.frame();
    this.draw();
  }
}

// One body: its lines, filled where they are closed; of a sphere the edge and what is on the near side.
function draw({ context, view, ratio }, pose, body, colour, width, fill) {
  context.strokeStyle = colour;
  context.fillStyle = fill;
  context.lineWidth = width * ratio;
  if (body.sphere !== null) {
    const [x, y] = view.project(pose.at);
    context.beginPath();
    context.arc(x, y, Math.max(body.sphere * view.scale, (body.kind === "point" ? 5 : 1) * ratio), 0, 2 * Math.PI);
    if (body.kind === "point") context.fillStyle = colour;
    context.fill();
    context.stroke();
  }
  const middle = view.depth(pose.at);
  for (const line of body.lines) {
    context.beginPath();
    let drawn = false;
    for (const p of line) {
      const at = pose.place(p);
      const [x, y] = view.project(at);
      const seen = body.sphere === null || view.depth(at) >= middle;
      if (seen && drawn) context.lineTo(x, y);
      else if (seen) context.moveTo(x, y);
      drawn = seen;
    }
    const [first, last] = [line[0], line[line.length - 1]];
    const closed = line.length > 3 && first.every((x, i) => Math.abs(x - last[i]) < 1e-12);
    if (closed && body.sphere === null) context.fill();
    context.stroke();
  }
}
