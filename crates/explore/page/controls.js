// Sliders, each with a number that can be typed.

import { readable, short } from "./names.js";

const HEADINGS = {
  parameter: "Parameters", start: "Start", velocity: "Start velocities", multiplier: "Multipliers μ₀ (vakonomic, κ)",
  costate: "Costates P(t₀)", kappa: "Between Chetaev and vakonomic", run: "Run",
};

// Rows in all up to which all groups are open; of a longer list groups are open up to there, and parameters whose names begin
// alike, at least ALIKE, have a group of their own.
const ROWS = 20;
const ALIKE = 4;

// Controls in groups: each a heading and its controls, costates of each removal on their own.
function grouped(controls) {
  const isLong = controls.filter(({ kind }) => kind !== "costate").length > ROWS;
  const stem = ({ kind, name }) => {
    const isAlike = ({ kind: other, name: also }) => other === kind && also[0] === name[0];
    return isLong && kind === "parameter" && controls.filter(isAlike).length >= ALIKE ? `${name[0]} …` : undefined;
  };
  const groups = Object.keys(HEADINGS).map((kind) => controls.filter((control) => control.kind === kind)).flatMap((of) => {
    const part = (control) => control.motion ?? stem(control);
    return [...new Set(of.map(part))].map((name) => [name, of.filter((control) => part(control) === name)]);
  });
  let rows = 0;
  return groups.map(([name, of]) => {
    const heading = HEADINGS[of[0].kind] + (name === undefined ? "" : `, ${name}`);
    return { heading, of, motion: of[0].motion, open: !isLong || (rows += of.length) <= ROWS };
  });
}

export class Controls {
  // `set` is called with every change: numbers by name, or null for the number of the text.
  constructor(element, set) {
    Object.assign(this, { element, set, rows: new Map() });
  }

  // Rows for what can be varied, with the numbers that are set.
  build(controls, set) {
    this.clear();
    const all = document.createElement("button");
    all.type = "button";
    all.id = "all";
    all.textContent = "all as in the text";
    all.addEventListener("click", () => {
      const changed = [...this.rows.values()].filter((entry) => entry.changed);
      for (const entry of changed) this.put(entry, entry.control.value, false);
      this.set(Object.fromEntries(changed.flatMap(({ control }) => namesOf(control)).map((name) => [name, null])), false);
    });
    this.element.append(all);
    for (const { heading, of, motion, open } of grouped(controls)) {
      const group = document.createElement("details");
      group.innerHTML = "<summary></summary>";
      group.firstChild.textContent = heading;
      if (motion !== undefined) group.dataset.motion = motion;
      group.append(...of.map((control) => this.row(control, namesOf(control).map((name) => set[name]).find((x) => x !== undefined))));
      group.open = open || group.querySelector(".changed") !== null;
      this.element.append(group);
    }
    this.touched();
  }

  clear() {
    this.element.replaceChildren();
    this.rows.clear();
  }

  // Groups of motions that are not shown are not used.
  shown(labels) {
    for (const group of this.element.querySelectorAll("[data-motion]")) group.hidden = !labels.includes(group.dataset.motion);
  }

  touched() {
    this.element.querySelector("#all").disabled = ![...this.rows.values()].some(({ changed }) => changed);
  }

  row(control, given) {
    const { name, unit, low, high, value } = control;
    const row = document.createElement("div");
    row.className = "row";
    row.innerHTML = `<label>${readable(name)}<small></small></label><input type="range" min="0" max="1000" step="1">
      <input type="number" step="any"><button type="button" class="plain" title="as in the text" >↺</button>`;
    row.querySelector("button").setAttribute("aria-label", `${name} as in the text`);
    // a unit is whatever the text says
    row.querySelector("small").textContent = unit;
    const [slider, number, back] = row.querySelectorAll("input, button");
    const entry = { control, row, slider, number, bounds: [low, high] };
    this.rows.set(name, entry);
    slider.setAttribute("aria-label", name);
    number.setAttribute("aria-label", `${name}, number`);
    row.dataset.name = name;
    slider.addEventListener("input", () => {
      const [low, high] = entry.bounds;
      const x = Number((low + ((high - low) * slider.value) / 1000).toPrecision(5));
      number.value = short(x);
      this.give(entry, x, true);
    });
    slider.addEventListener("change", () => this.give(entry, Number(number.value), false));
    number.addEventListener("change", () => {
      const x = Number(number.value);
      if (number.value.trim() === "" || !Number.isFinite(x)) return this.reset(entry);
      this.put(entry, x, true);
      this.give(entry, x, false);
    });
    back.addEventListener("click", () => this.reset(entry));
    this.put(entry, given ?? value, given !== undefined);
    return row;
  }

  // A number of one's own. What a search finds of the costates of a removal is found together: with one of them
  // given, the others are, too, and stay what they were.
  give(entry, x, moving) {
    const numbers = { [entry.control.name]: x };
    this.mark(entry, true);
    for (const other of this.beside(entry)) {
      if (other.changed || other.number.value === "") continue;
      this.mark(other, true);
      numbers[other.control.name] = other.used ?? Number(other.number.value);
    }
    this.set(numbers, moving);
  }

  // The rows that a search finds together with this one.
  beside({ control }) {
    if (control.motion === undefined) return [];
    return [...this.rows.values()].filter((other) => other.control.motion === control.motion && other.control.value === null);
  }

  // Numbers that were set elsewhere.
  take(numbers) {
    for (const [name, x] of Object.entries(numbers)) this.put(this.rows.get(name), x, true);
  }

  reset(entry) {
    const together = entry.control.value === null ? this.beside(entry) : [entry];
    for (const other of together) this.put(other, other.control.value, false);
    this.set(Object.fromEntries(together.flatMap(({ control }) => namesOf(control)).map((name) => [name, null])), false);
  }

  mark(entry, changed) {
    entry.changed = changed;
    entry.row.classList.toggle("changed", changed);
    if (this.element.querySelector("#all")) this.touched();
  }

  // Puts a number there; the slider widens where it does not reach.
  put(entry, x, changed) {
    entry.used = x;
    if (x === null) {
      // found with the motion
      entry.number.value = "";
      return this.mark(entry, changed);
    }
    const [low, high] = entry.bounds;
    if (x < low || x > high) entry.bounds = [Math.min(low, x), Math.max(high, x)];
    const [from, to] = entry.bounds;
    entry.slider.value = Math.round(((x - from) / (to - from)) * 1000);
    entry.number.value = short(x);
    this.mark(entry, changed);
  }

  // Numbers that motions were computed with, where none is set. A costate that is none of their constants is zero.
  found(motions) {
    for (const { label, constants } of motions.filter(({ refused }) => !refused)) {
      const used = (control) => constants.find(({ name }) => control.name === `${name}@${label}`)?.value ?? 0;
      const found = [...this.rows.values()].filter(({ control, changed }) => control.motion === label && !changed);
      for (const entry of found) this.put(entry, used(entry.control), false);
    }
  }
}

// The names by which a number is set: that of a costate may be set for all removals at once.
const namesOf = ({ name }) => (name.includes("@") ? [name, name.split("@")[0]] : [name]);
