// Quantities against time, with a cursor that the animation moves and that moves the animation.

import uPlot from "uplot";

import { ink } from "./look.js";

const NAMES = { coordinate: "", velocity: "", multiplier: "multipliers", invariant: "should be constant: ", observable: "" };

export class Curves {
  // `go` is told a time that was pointed at.
  constructor(place, select, go) {
    Object.assign(this, { place, select, go });
    new ResizeObserver(() => this.resize()).observe(place);
  }

  show(samples, chosen) {
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
    const { motions, gaps, units } = this.samples;
    const options = gaps.length ? [["gap", `gap to ${gaps[0].first}`]] : [];
    if (motions.length) options.push(["observable:energy", "energy"]);
    if (motions.some((motion) => motion.multipliers.length)) options.push(["multiplier", "multipliers, costates"]);
    for (const group of ["coordinate", "velocity", "observable", "invariant"]) {
      const names = new Set(motions.flatMap((motion) => Object.keys(motion.columns[group])));
      for (const name of names) {
        const key = `${group}:${name}`;
        if (!options.some(([known]) => known === key)) options.push([key, NAMES[group] + name]);
      }
    }
    return options.map(([key, name]) => [key, units[key] ? `${name} (${units[key]})` : name]);
  }

  // Tables to join, and a series for each column of them.
  data(key) {
    const [group, name] = key.split(/:(.*)/s);
    const { motions, gaps } = this.samples;
    const [tables, series] = [[], []];
    const reading = key === "gap" ? (x) => 10 ** x : (x) => x;
    const add = (t, values, label, look) => {
      tables.push([t, values]);
      series.push({ label, stroke: look.colour, width: look.width * 0.6, dash: look.dash, points: { show: false },
        value: (_, x) => (x == null ? "–" : reading(x).toPrecision(4)) });
    };
    if (key === "gap") {
      for (const { t, gap, limit, second } of gaps) {
        const { look } = motions.find((motion) => motion.label === second);
        // in doubt, as at a glance, there is no limit; what is not certain is not drawn
        const isCertain = (x, i) => !Number.isFinite(limit[i]) || x > limit[i];
        add(t, gap.map((x, i) => (isCertain(x, i) ? logarithm(x) : null)), second, look);
        if (limit.every((x) => !Number.isFinite(x))) continue;
        add(t, limit.map(logarithm), "certain above", { colour: `${look.colour}99`, dash: [2, 3], width: 1.6 });
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

  draw(key) {
    const { tables, series } = key ? this.data(key) : { tables: [], series: [] };
    const { start, end } = this.samples;
    const looks = JSON.stringify([key, start, end, series.map(({ label, stroke }) => [label, stroke]), ink("ink")]);
    if (this.plot && looks === this.looks) {
      this.plot.setData(uPlot.join(tables));
      return this.at(this.t);
    }
    this.looks = looks;
    this.plot?.destroy();
    this.plot = null;
    if (!tables.length) return;
    const axis = { stroke: ink("ink"), grid: { stroke: ink("line"), width: 1 }, ticks: { stroke: ink("line") }, font: "12px system-ui" };
    const log = key === "gap";
    const options = {
      width: this.place.clientWidth, height: this.height(), padding: [10, 12, 0, 0],
      cursor: { drag: { setScale: false, x: false, y: false }, y: false, points: { size: 6 } },
      scales: { x: { time: false, range: [start, end] } },
      axes: [{ ...axis, size: 28 }, { ...axis, size: 56, space: 22, incrs: log ? [1, 2, 3, 5, 10, 20] : undefined,
        values: (_, ticks) => ticks.map((x) => (log ? `1e${x}` : label(x))) }],
      series: [{ label: "t", value: (_, x) => (x == null ? "–" : `${x.toFixed(3)} s`) }, ...series],
      legend: { live: true },
      hooks: { ready: [(plot) => this.ready(plot)] },
    };
    this.plot = new uPlot(options, uPlot.join(tables), this.place);
  }

  height() {
    // two lines for the legend, whose values are of changing length
    return Math.max(110, this.place.clientHeight - 44);
  }

  resize() {
    if (this.plot && this.place.clientWidth) this.plot.setSize({ width: this.place.clientWidth, height: this.height() });
  }

  at(t) {
    this.t = t;
    // the cursor of the plot, under which its legend has the values
    this.plot?.setCursor({ left: this.plot.valToPos(t, "x"), top: 0 });
  }

  ready(plot) {
    this.plot = plot;
    this.listen(plot);
    this.resize();
    if (this.t !== undefined) this.at(this.t);
  }

  listen(plot) {
    const point = (event) => {
      const { left } = plot.over.getBoundingClientRect();
      this.go(plot.posToVal(event.clientX - left, "x"));
    };
    plot.over.addEventListener("pointerdown", (event) => {
      plot.over.setPointerCapture(event.pointerId);
      point(event);
      plot.over.onpointermove = point;
    });
    plot.over.addEventListener("pointerup", () => (plot.over.onpointermove = null));
  }
}

const logarithm = (x) => (x > 0 && Number.isFinite(x) ? Math.log10(x) : null);

function label(x) {
  const size = Math.abs(x);
  if (x === 0 || (size >= 1e-3 && size < 1e5)) return String(Number(x.toPrecision(6)));
  return x.toExponential().replace("e+", "e");
}
