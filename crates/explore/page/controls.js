// Sliders, each with a number that can be typed.

const HEADINGS = {
  parameter: "Parameters", start: "Start", velocity: "Start velocities", multiplier: "Multipliers μ₀ (vakonomic, κ)",
  costate: "Costates P(t₀) (removed constraint)", kappa: "Between Chetaev and vakonomic", run: "Run",
};

const short = (x) => String(Number(x.toPrecision(6)));

const GREEK = { alpha: "α", beta: "β", gamma: "γ", delta: "δ", theta: "θ", kappa: "κ", lambda: "λ", mu: "μ", nu: "ν",
  rho: "ρ", phi: "φ", chi: "χ", psi: "ψ", omega: "ω", Omega: "Ω", Gamma: "Γ", eta: "η", sigma: "σ", tau: "τ", xi: "ξ" };

// A name as it is read: Greek letters, primes, an index below.
export function readable(name) {
  if (name.startsWith("P0_")) return `P<sub>${readable(name.slice(3))}</sub>`;
  const [, stem, index, primes] = /^(.*?)_?(\d*)('*)$/.exec(name);
  const [head, ...rest] = stem.split("_");
  const [, word, digits] = /^(\D*)(\d*)$/.exec(head) ?? [null, head, ""];
  const below = [digits + index, ...rest.map((part) => GREEK[part] ?? part)].filter((part) => part !== "").join(" ");
  return `${GREEK[word] ?? word}${below ? `<sub>${below}</sub>` : ""}${"′".repeat(primes.length)}`;
}

export class Controls {
  // `set` is told every change: the name, and the number or null for that of the text.
  constructor(element, set) {
    Object.assign(this, { element, set, rows: new Map() });
  }

  // Rows for what can be varied, with the numbers that are set.
  build(controls, set) {
    this.element.replaceChildren();
    this.rows.clear();
    for (const [kind, heading] of Object.entries(HEADINGS)) {
      const of = controls.filter((control) => control.kind === kind);
      if (!of.length) continue;
      const group = document.createElement("fieldset");
      group.innerHTML = `<legend>${heading}</legend>`;
      for (const control of of) group.append(this.row(control, set[control.name]));
      this.element.append(group);
    }
  }

  row(control, given) {
    const { name, unit, low, high, value } = control;
    const row = document.createElement("div");
    row.className = "row";
    row.innerHTML = `<label>${readable(name)}<small></small></label><input type="range" min="0" max="1000" step="1">
      <input type="number" step="any"><button type="button" class="plain" title="as in the text" aria-label="${name} as in the text">↺</button>`;
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
      this.mark(entry, true);
      this.set(name, x, true);
    });
    slider.addEventListener("change", () => this.set(name, Number(number.value), false));
    number.addEventListener("change", () => {
      const x = Number(number.value);
      if (number.value.trim() === "" || !Number.isFinite(x)) return this.reset(entry);
      this.put(entry, x, true);
      this.set(name, x, false);
    });
    back.addEventListener("click", () => this.reset(entry));
    this.put(entry, given ?? value, given !== undefined);
    return row;
  }

  reset(entry) {
    this.put(entry, entry.control.value, false);
    this.set(entry.control.name, null, false);
  }

  mark(entry, changed) {
    entry.changed = changed;
    entry.row.classList.toggle("changed", changed);
  }

  // Puts a number there; the slider widens where it does not reach.
  put(entry, x, changed) {
    const [low, high] = entry.bounds;
    if (x < low || x > high) entry.bounds = [Math.min(low, x), Math.max(high, x)];
    const [from, to] = entry.bounds;
    entry.slider.value = Math.round(((x - from) / (to - from)) * 1000);
    entry.number.value = short(x);
    this.mark(entry, changed);
  }

  // Numbers that the program found, where none is set.
  found(values) {
    for (const { name, value } of values) {
      const entry = this.rows.get(name);
      if (entry && !entry.changed && entry.control.kind === "costate") this.put(entry, value, false);
    }
  }

  // What stands there of a kind.
  values(kind) {
    const of = [...this.rows.values()].filter(({ control }) => control.kind === kind);
    return of.map(({ control, number }) => [control.name, Number(number.value)]);
  }
}
