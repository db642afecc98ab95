// Colours, dashes and widths: those of the pictures in the reports (crates/picture/src/style.rs).

const BLUE = "#0072B2";
const VERMILION = "#D55E00";
const GREEN = "#009E73";
const PURPLE = "#CC79A7";

const STYLES = {
  chetaev: [BLUE, []],
  vakonomic: [VERMILION, [12, 6]],
  "vakonomic-costate": [VERMILION, [3, 4]],
  "removed-constraint": [GREEN, [2, 5]],
  kappa: [PURPLE, [9, 4, 2, 4]],
};
// Of paths and of outlines: narrow ones lie on wide ones, so that motions which agree are all seen.
const WIDTHS = { chetaev: [4.4, 4], vakonomic: [2.6, 2.4], "removed-constraint": [2.6, 1.2] };
// Further removals: green in other dashes.
const FURTHER = [[2, 5], [8, 3, 2, 3], [5, 5], [12, 3]];

// The look of a motion; `further` counts the motions of its formulation before it.
export function look(formulation, further = 0) {
  const [colour, dash] = STYLES[formulation] ?? [PURPLE, []];
  const [width, outline] = WIDTHS[formulation] ?? [2, 1.2];
  return { colour, dash: further ? FURTHER[further % FURTHER.length] : dash, width, outline };
}

const probe = document.createElement("i");
probe.hidden = true;
document.body.append(probe);

const dark = matchMedia("(prefers-color-scheme: dark)");
const inks = new Map();

// A colour of the page's own style, as a canvas takes it: one that depends on light and dark is resolved, which takes
// the browser as long as a part of a picture, so once for each look.
export function ink(name) {
  const key = `${name} ${dark.matches} ${document.documentElement.className}`;
  if (!inks.has(key)) {
    probe.style.color = `var(--${name})`;
    inks.set(key, getComputedStyle(probe).color);
  }
  return inks.get(key);
}

// The swatch of a motion, as SVG.
export function swatch({ colour, dash, width }) {
  return `<svg class="swatch" viewBox="0 0 34 10" aria-hidden="true"><path d="M2 5H32" stroke="${colour}"
    stroke-width="${width}" stroke-dasharray="${dash.join(" ")}" stroke-linecap="${dash[0] === 2 ? "round" : "butt"}"/></svg>`;
}
