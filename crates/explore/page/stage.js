// The bodies in motion on a canvas: outlines in axes of their own, places and rotations from the program.

import { Apart } from "./apart.js";
import * as arrows from "./arrows.js";
import { ink } from "./look.js";
import { Vector } from "./vector.js";

// Azimuth and elevation of the eye for what is not in a plane, as in the reports.
const OBLIQUE = [0.4, 0.5];
// A motion widens the frame at most this many times.
const WIDENED = 2;
const MARGIN = 18;
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
    [this.follow, this.by, this.held] = ["", 1, false];
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

  // Veiled, it shows where the bodies are and no way of them.
  veil(is) {
    this.veiled = is;
    this.draw();
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

  // What is to be seen: the ground and the first motion, and others unless they run far away.
  frame() {
    const [right, up] = this.axes();
    const empty = () => [Infinity, Infinity, -Infinity, -Infinity];
    const add = (w, x, y, r = 0) => {
      w[0] = Math.min(w[0], x - r);
      w[1] = Math.min(w[1], y - r);
      w[2] = Math.max(w[2], x + r);
      w[3] = Math.max(w[3], y + r);
    };
    const join = (a, b) => [0, 1, 2, 3].map((i) => (i < 2 ? Math.min(a[i], b[i]) : Math.max(a[i], b[i])));
    const size = (w) => Math.hypot(w[2] - w[0], w[3] - w[1]);
    const put = (w, pose, body) => {
      for (const p of body.lines.flat()) {
        const at = pose.place(p);
        add(w, dot(right, at), dot(up, at));
      }
      add(w, dot(right, pose.at), dot(up, pose.at), body.sphere ?? 0);
    };
    const ground = empty();
    for (const [pose, body] of this.samples.ground(0)) put(ground, pose, body);
    const { apart } = this;
    const windows = this.samples.motions.map((motion) => {
      const w = empty();
      const last = apart.last(motion);
      const stride = Math.max(1, Math.floor(motion.rows / 24));
      for (let row = 0; row <= last; row += stride) {
        for (const [pose, body] of apart.poses(motion, row)) put(w, pose, body);
      }
      for (let row = 0; row <= last; row++) {
        const at = apart.track(motion, row);
        add(w, dot(right, at), dot(up, at));
      }
      return w;
    });
    if (!windows.length) return;
    const first = join(windows[0], ground);
    const near = windows.filter((w) => size(join(w, first)) <= WIDENED * size(first));
    const all = near.reduce(join, first);
    const least = 1e-6 + 0.05 * size(all);
    this.target = [all[0] - least, all[1] - least, all[2] + least, all[3] + least];
    this.far = this.samples.motions.filter((_, i) => !near.includes(windows[i])).map((motion) => motion.label);
    const far = this.far.join(", ");
    const notes = far ? [`${far}: runs out of the picture, whose frame is the neighbourhood of the others`] : [];
    if (this.by !== 1 && windows.length > 1) notes.unshift(`Differences from ${this.samples.motions[0].label} are drawn ${this.by} times as large.`);
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
    let reach = 0.02 * Math.hypot(this.window[2] - this.window[0], this.window[3] - this.window[1]);
    for (const [pose, body] of motion.poses(0)) {
      const far = (p) => Math.hypot(...p.map((x, i) => x - from[i]));
      reach = Math.max(reach, far(pose.at) + (body.sphere ?? 0), ...body.lines.flat().map((p) => far(pose.place(p))));
    }
    return reach;
  }

  // Pixels of a place.
  projection() {
    const { width, height } = this.canvas;
    const w = this.window;
    const margin = MARGIN * devicePixelRatio;
    let fit = Math.min((width - 2 * margin) / (w[2] - w[0]), (height - 2 * margin) / (w[3] - w[1]));
    let [x, y] = [(w[0] + w[2]) / 2, (w[1] + w[3]) / 2];
    const [right, up, eye] = this.axes();
    const motion = this.followed();
    if (motion) {
      fit = Math.max(fit, Math.min(width, height) / (2 * ROUND * this.reach(motion)));
      // what is in the hand is not followed
      if (!this.held) this.middle = this.apart.trackAt(motion, this.t);
      [x, y] = [right, up].map((axis) => dot(axis, this.middle));
    }
    const scale = fit * this.zoom;
    const project = (p) => [width / 2 + (dot(right, p) - x) * scale, height / 2 - (dot(up, p) - y) * scale];
    return { project, scale, depth: (p) => dot(eye, p) };
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
    for (const [pose, body] of samples.ground(samples.rowAt(t))) draw(pen, pose, body, line, 1, floor);
    for (const motion of this.veiled ? [] : samples.motions) this.trail(pen, motion, t);
    for (const motion of samples.motions) {
      const { colour, outline } = motion.look;
      for (const [pose, body] of [...this.apart.posesAt(motion, t)].reverse()) draw(pen, pose, body, colour, outline, `${colour}2e`);
    }
    const side = Math.min(width, height);
    for (const motion of samples.contacts ? samples.motions : []) {
      const mark = this.apart.trackAt(motion, t);
      arrows.forces(pen, motion, t, this.largest, side, mark);
    }
    this.over?.(pen);
    arrows.orientation(pen, { width, height }, { down: samples.down, flat: this.flat && !this.eye, unit: samples.length });
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
      context.globalAlpha = strong ? 1 : 0.3;
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
