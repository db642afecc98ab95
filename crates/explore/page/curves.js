// The path, and quantities against time, with a cursor that the animation moves and that moves the animation; a part of the
// time larger.

import uPlot from "uplot";

import { add, empty, join, near } from "./frame.js";
import { ink } from "./look.js";

const NAMES = { coordinate: "", velocity: "", multiplier: "multipliers", invariant: "should be constant: ", observable: "" };

// Curves over RUNAWAY times as high as the others are cut, and so are those whose range is RUNAWAY times that
// without the PART of lowest and highest values.
const RUNAWAY = 8;
const PART = 0.03;
// The largest magnification of time.
const LARGEST = 200;
// Gaps at a glance, of which no error is known, are shown from here.
const GLANCE = 1e-6;

export class Curves {
  // `go` is called with a time that was pointed at; `note` shows what is cut off, the button `whole` shows
  // everything.
  constructor({ place, select, note, whole }, go) {
    Object.assign(this, { place, select, note, whole, go, window: null });
    whole.addEventListener("click", () => {
      whole.setAttribute("aria-pressed", String(whole.ariaPressed !== "true"));
      if (this.isPath) this.resize();
      else this.magnify(1);
    });
    new ResizeObserver(() => this.resize()).observe(place);
  }

  // New samples; of another scene all is seen first.
  show(samples, chosen, anew = false) {
    if (anew) this.all();
    this.samples = samples;
    const options = this.options();
    const key = options.some(([key]) => key === chosen) ? chosen : options[0]?.[0];
    const list = JSON.stringify(options);
    if (list !== this.list) this.select.replaceChildren(...options.map(([key, name]) => new Option(name, key)));
    this.list = list;
    this.select.value = key;
    this.draw(key);
  }

  options() {
    const { motions, gaps, units, plane } = this.samples;
    const options = plane && motions.length ? [["path", `path: ${plane.names[1]} over ${plane.names[0]} (m)`]] : [];
    for (const group of ["coordinate", "velocity", "observable", "invariant"]) {
      const names = new Set(motions.flatMap((motion) => Object.keys(motion.columns[group])));
      for (const name of names) {
        const key = `${group}:${name}`;
        if (!options.some(([known]) => known === key)) options.push([key, NAMES[group] + name]);
      }
    }
    if (motions.some((motion) => motion.multipliers.length)) options.push(["multiplier", "multipliers, costates"]);
    if (gaps.length) options.push(["gap", `distance to ${gaps[0].first}, logarithmic`], ["log", `distance to ${gaps[0].first}, log–log`]);
    const unit = (key) => units[isGap(key) ? "gap" : key];
    return options.map(([key, name]) => [key, unit(key) ? `${name} (${unit(key)})` : name]);
  }

  // Tables to join, and a series for each column of them.
  data(key) {
    const [group, name] = key.split(/:(.*)/s);
    const { motions, gaps } = this.samples;
    const [tables, series] = [[], []];
    const reading = isGap(key) ? (x) => 10 ** x : (x) => x;
    const add = (t, values, label, look) => {
      tables.push([t, values]);
      series.push({ label, stroke: look.colour, width: look.width * 0.6, dash: look.dash, points: { show: false },
        value: (_, x) => (x == null ? "–" : reading(x).toPrecision(4)) });
    };
    if (isGap(key)) {
      for (const { t, gap, limit, second } of gaps) {
        const { look } = motions.find((motion) => motion.label === second);
        // in doubt, as at a glance, there is no limit; neither what is not certain is drawn nor what is below half of all limits
        const known = limit.filter(Number.isFinite).sort((a, b) => a - b);
        const floor = known.length ? known[known.length >> 1] : GLANCE;
        const isCertain = (x, i) => x > floor && (!Number.isFinite(limit[i]) || x > limit[i]);
        add(t, gap.map((x, i) => (isCertain(x, i) ? logarithm(x) : null)), second, look);
        if (known.length) add(t, limit.map((x) => logarithm(Math.max(x, floor))), "error", { colour: `${look.colour}99`, dash: [2, 3], width: 1.6 });
      }
      return { tables, series };
    }
    for (const motion of motions) {
      const t = motion.column(0);
      for (const [column, place] of Object.entries(motion.columns[group])) {
        if (name !== undefined && name !== column) continue;
        add(t, motion.column(place), name === undefined ? `${motion.label}: ${column}` : motion.label, motion.look);
      }
    }
    return { tables, series };
  }

  // Ranges of the path: of the first motion and those near it, at one scale.
  ranges() {
    const { motions, plane } = this.samples;
    const boxes = motions.map((motion) => {
      const w = empty();
      for (let row = 0; row < motion.rows; row++) add(w, ...plane.at(motion, row));
      return w;
    });
    const [together, far] = near(boxes[0], boxes);
    this.cutting(motions.filter((_, i) => far.includes(boxes[i])).map(({ label }) => label));
    const box = this.whole.ariaPressed === "true" ? boxes.reduce(join) : together;
    const pixels = [this.place.clientWidth - 80, this.height() - 40].map((x) => Math.max(1, x));
    const scale = Math.max(...pixels.map((n, i) => (1.1 * (box[i + 2] - box[i])) / n));
    return pixels.map((n, i) => [-1, 1].map((side) => (box[i] + box[i + 2] + side * scale * n) / 2));
  }

  // Says what is cut off; the button shows it.
  cutting(labels) {
    const all = this.whole.ariaPressed === "true";
    this.note.textContent = labels.length && !all ? `${[...new Set(labels)].join(", ")}: out of the picture` : "";
    this.whole.hidden = !labels.length && !all;
  }

  // The paths of all motions, and where each is now.
  paths(plot) {
    const { ctx: context, bbox: { left, top, width, height } } = plot;
    const { plane, motions } = this.samples;
    // a text without a plane came while this was still to be drawn
    if (!plane) return;
    const ratio = devicePixelRatio;
    context.save();
    context.beginPath();
    context.rect(left, top, width, height);
    context.clip();
    for (const motion of motions) {
      const place = (row) => plane.at(motion, row).map((x, i) => plot.valToPos(x, "xy"[i], true));
      context.strokeStyle = context.fillStyle = motion.look.colour;
      context.lineWidth = motion.look.width * 0.6 * ratio;
      context.setLineDash(motion.look.dash.map((x) => x * ratio));
      context.beginPath();
      for (let row = 0; row < motion.rows; row++) context.lineTo(...place(row));
      context.stroke();
      context.setLineDash([]);
      context.beginPath();
      const [row, part] = motion.locate(this.t ?? this.samples.start);
      const [from, to] = [place(row), place(Math.min(row + 1, motion.rows - 1))];
      context.arc(...from.map((x, i) => x + part * (to[i] - x)), 5 * ratio, 0, 2 * Math.PI);
      context.fill();
    }
    context.restore();
  }

  // The time at which the first motion is nearest to a point of the plane.
  nearest(x, y) {
    const { plane, motions: [motion] } = this.samples;
    const far = Array.from({ length: motion.rows }, (_, row) => {
      const [a, b] = plane.at(motion, row);
      return Math.hypot(this.plot.valToPos(a, "x") - x, this.plot.valToPos(b, "y") - y);
    });
    return motion.time(far.indexOf(Math.min(...far)));
  }

  draw(key) {
    this.isPath = key === "path";
    this.select.closest("#above").classList.toggle("path", this.isPath);
    if (this.isPath) this.limits = this.ranges();
    const { tables, series } = !key ? { tables: [], series: [] } : this.isPath ? { tables: [[[0, 1], [0, 1]]], series: [{ show: false }] } : this.data(key);
    const { start, end } = this.samples;
    // along the axis: t, or the logarithm of t − start
    const log = key === "log";
    this.along = log ? (t) => Math.log10(Math.max(t - start, 1e-300)) : (t) => t;
    this.time = log ? (x) => start + 10 ** x : (x) => x;
    for (const table of log ? tables : []) {
      const later = table[0].flatMap((t, i) => (t > start ? [i] : []));
      table.forEach((column, k) => (table[k] = later.map((i) => (k ? column[i] : this.along(column[i])))));
    }
    this.ends = log ? [Math.min(...tables.map(([t]) => t[0])), this.along(end)] : [start, end];
    this.labels = series.map(({ label }) => label);
    this.cuts = !isGap(key);
    const looks = JSON.stringify([key, this.isPath && this.limits, start, end, series.map(({ label, stroke }) => [label, stroke]), ink("ink")]);
    if (this.plot && looks === this.looks) {
      this.plot.setData(uPlot.join(tables));
      return this.at(this.t);
    }
    if (this.key !== key) this.window = null;
    [this.looks, this.key] = [looks, key];
    this.plot?.destroy();
    this.plot = null;
    if (!tables.length) return;
    const axis = { stroke: ink("ink"), grid: { stroke: ink("line"), width: 1 }, ticks: { stroke: ink("line") }, font: "12px system-ui" };
    const powers = (is) => (is ? { incrs: [1, 2, 3, 5, 10, 20], values: (_, ticks) => ticks.map((x) => `1e${x}`) } : { values: (_, ticks) => ticks.map(label) });
    const options = {
      width: this.place.clientWidth, height: this.height(), padding: [10, 12, 0, 0],
      cursor: { show: !this.isPath, drag: { setScale: false, x: false, y: false }, y: false, points: { size: 6 } },
      scales: { x: { time: false, range: () => (this.isPath ? this.limits[0] : this.span()) }, y: { range: (plot) => (this.isPath ? this.limits[1] : this.heights(plot.data)) } },
      axes: [{ ...axis, size: 28, ...powers(log) }, { ...axis, size: 56, space: 22, ...powers(isGap(key)) }],
      series: [{ label: "t", value: (_, x) => (x == null ? "–" : `${Number(this.time(x).toPrecision(4))} s`) }, ...series],
      legend: { live: true, show: !this.isPath },
      hooks: { ready: [(plot) => this.ready(plot)], draw: this.isPath ? [(plot) => this.paths(plot)] : [] },
    };
    this.plot = new uPlot(options, uPlot.join(tables), this.place);
  }

  // What of the time is shown.
  span() {
    return this.window ?? this.ends;
  }

  // The heights that are shown: of all curves, but for steep parts and for those that run away from the others, unless all
  // are asked for.
  heights([t, ...columns]) {
    const [from, to] = this.span();
    const all = this.whole.ariaPressed === "true" || !this.cuts;
    const curves = columns.map((column, i) => ({ label: this.labels[i], ...bounds(column.filter((x, i) => Number.isFinite(x) && t[i] >= from && t[i] <= to), all) }));
    const seen = curves.filter(({ high, low }) => high >= low).sort((a, b) => a.high - a.low - (b.high - b.low));
    if (!seen.length) return [0, 1];
    const join = (list) => [Math.min(...list.map(({ low }) => low)), Math.max(...list.map(({ high }) => high))];
    const isFlat = ({ low, high }) => high - low <= 1e-6 * (1 + Math.max(Math.abs(low), Math.abs(high)));
    const last = seen.findIndex((curve, i) => {
      const [before, after] = [join(seen.slice(0, i || 1)), join(seen.slice(0, i + 1))];
      return i > 0 && !isFlat(seen[i - 1]) && after[1] - after[0] > RUNAWAY * (before[1] - before[0]);
    });
    const runs = last > 0 && seen.length - last <= seen.length / 2 && !all ? seen.splice(last) : [];
    this.cutting([...runs, ...seen.filter((curve) => curve.cut)].map(({ label }) => label));
    const [low, high] = join(seen);
    const room = 0.06 * (high - low) || 1e-3 * Math.abs(high) || 1;
    return [low - room, high + room];
  }

  // Magnifies time by `factor`, about a point of the axis, or about the current time.
  magnify(factor, at = this.along(this.t)) {
    const [first, last] = this.ends;
    const [from, to] = this.span();
    const width = Math.max((last - first) / LARGEST, (to - from) / factor);
    this.put(at - ((at - from) * width) / (to - from), width);
  }

  // Shows what begins there.
  put(from, width) {
    const [first, last] = this.ends;
    const begins = Math.max(first, Math.min(from, last - width));
    this.window = width < last - first ? [begins, begins + width] : null;
    const [min, max] = this.span();
    this.plot?.setScale("x", { min, max });
    if (this.plot) this.at(this.t);
  }

  // All of the time, and nothing that is cut on purpose.
  all() {
    this.window = null;
    this.whole.setAttribute("aria-pressed", "false");
    if (this.plot) this.magnify(1);
  }

  height() {
    // two lines for the legend, whose values are of changing length
    return Math.max(110, this.place.clientHeight - (this.isPath ? 0 : 44));
  }

  resize() {
    if (!this.plot || !this.place.clientWidth) return;
    if (this.isPath) this.limits = this.ranges();
    this.plot.setSize({ width: this.place.clientWidth, height: this.height() });
  }

  at(t) {
    const moved = t !== this.t;
    this.t = t;
    if (!this.plot) return;
    if (this.isPath) return this.plot.redraw(false);
    const x = this.along(t);
    const [from, to] = this.span();
    // what is shown goes with the time
    if (moved && this.window && (x < from || x > to) && x >= this.ends[0]) return this.put(x - 0.1 * (to - from), to - from);
    // the cursor of the plot, under which its legend has the values
    this.plot.setCursor({ left: this.plot.valToPos(x, "x"), top: 0 });
  }

  ready(plot) {
    this.plot = plot;
    this.listen(plot);
    this.resize();
    if (this.t !== undefined) this.at(this.t);
  }

  listen({ over }) {
    const fingers = new Map();
    const place = ({ clientX }) => this.plot.posToVal(clientX - over.getBoundingClientRect().left, "x");
    const time = (event) => (this.isPath ? this.nearest(event.offsetX, event.offsetY) : this.time(place(event)));
    const apart = () => {
      const [a, b] = [...fingers.values()].map(({ clientX }) => clientX);
      return Math.abs(a - b) + 1;
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
      if (fingers.size === 1) this.go(time(event));
    });
    over.addEventListener("pointermove", (event) => {
      if (!fingers.has(event.pointerId)) return;
      const before = fingers.size === 2 && !this.isPath && apart();
      fingers.set(event.pointerId, event);
      // one goes through time, two draw apart
      if (before) this.magnify(apart() / before, place(event));
      else if (fingers.size === 1) this.go(time(event));
    });
    for (const end of ["pointerup", "pointercancel"]) over.addEventListener(end, ({ pointerId }) => fingers.delete(pointerId));
    over.addEventListener("wheel", (event) => {
      if (this.isPath) return;
      event.preventDefault();
      const [from, to] = this.span();
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) this.put(from + ((to - from) * (event.deltaX || event.deltaY)) / 1000, to - from);
      else this.magnify(Math.exp(-event.deltaY / 500), place(event));
    }, { passive: false });
  }
}

const isGap = (key) => key === "gap" || key === "log";
const logarithm = (x) => (x > 0 && Number.isFinite(x) ? Math.log10(x) : null);

// The bounds of a curve; of one that is much steeper in a small part, without that, if not all is asked for.
function bounds(values, all) {
  const sorted = values.sort((a, b) => a - b);
  const at = (part) => sorted[Math.round(part * (sorted.length - 1))];
  const [low, inner, outer, high] = [0, PART, 1 - PART, 1].map(at);
  const cut = !all && outer - inner > 1e-6 * (1 + Math.abs(inner)) && high - low > RUNAWAY * (outer - inner);
  return cut ? { low: inner, high: outer, cut } : { low: low ?? Infinity, high: high ?? -Infinity, cut };
}

function label(x) {
  const size = Math.abs(x);
  if (x === 0 || (size >= 1e-3 && size < 1e5)) return String(Number(x.toPrecision(6)));
  return x.toExponential().replace("e+", "e");
}
