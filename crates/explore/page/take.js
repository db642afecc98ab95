// What can be taken along: pictures, numbers, equations, a script, the scene. Files are made here and nowhere else.

import { ink } from "./look.js";
import { GREEK } from "./names.js";

// Kinds of files: what they are called, how their names end, and their type.
const LABELS = {
  png: ["Picture, PNG", "png", "image/png"], svg: ["Picture, SVG", "svg", "image/svg+xml"], curves: ["Curves, PNG", "png", "image/png"],
  csv: ["Motions, CSV", "csv", "text/csv"], latex: ["Equations, LaTeX", "tex", "text/x-tex"], python: ["Script, Python", "py", "text/x-python"],
  toml: ["Scene, TOML", "toml", "application/toml"], page: ["This page, HTML", "html", "text/html"],
};
const LETTERS = Object.fromEntries(Object.entries(GREEK).map(([name, letter]) => [letter, `$\\${name}$`]));
// The page as it came, before anything was put into it.
const untouched = document.documentElement.cloneNode(true);

// A field of CSV, as RFC 4180 has it.
const field = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

// All motions, a row for each time: the motion, t, and every quantity that one of them has, empty for the others.
export function csv(samples) {
  const groups = ["coordinate", "velocity", "multiplier", "invariant", "observable"];
  const names = [];
  for (const motion of samples.motions) {
    for (const group of groups) names.push(...Object.keys(motion.columns[group]).map((name) => `${group}:${name}`));
  }
  const columns = [...new Set(names)].sort((a, b) => groups.indexOf(a.split(":")[0]) - groups.indexOf(b.split(":")[0]));
  const bare = columns.map((column) => column.slice(column.indexOf(":") + 1));
  const head = ["motion", "t", ...bare].map(field).join(",");
  const lines = samples.motions.flatMap((motion) => Array.from({ length: motion.rows }, (_, row) => {
    const value = (column) => {
      const place = motion.columns[column.split(":")[0]][column.slice(column.indexOf(":") + 1)];
      return place === undefined ? "" : String(motion.value(row, place));
    };
    return [field(motion.label), String(motion.time(row)), ...columns.map(value)].join(",");
  }));
  return `${[head, ...lines].join("\n")}\n`;
}

// The answer about equations as a document: its fenced pieces displayed, the rest as text between them.
export function latex({ system, integrability, motions }, title) {
  const special = { "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "\\": "\\textbackslash{}" };
  // fonts of text have no Greek
  const greek = (piece) => piece.replace(/[α-ωΓ-Ω]/g, (c) => LETTERS[c] ?? c);
  const plain = (piece) => greek(piece.replace(/[&%#_{}~^\\]/g, (c) => special[c] ?? `\\${c}`).replaceAll("**", ""));
  const words = (text) => text.split(/(\$[^$]+\$)/).map((piece) => (piece.startsWith("$") ? piece : plain(piece))).join("");
  const prose = (text) => text.split("\n").map((line) => words(line.trim().replace(/^- /, "")));
  const body = (text) => text.split(/```math\n([\s\S]*?)\n```/).map((piece, i) => (i % 2 ? `\\begin{dmath*}\n${piece}\n\\end{dmath*}` : prose(piece).join("\n"))).join("\n");
  const sections = motions.map(({ label, equations, refused }) => `\\section*{${words(label)}}\n${refused ? words(refused) : body(equations)}`);
  return `% lualatex or xelatex\n\\documentclass{article}\n\\usepackage{amsmath, breqn}\n\\begin{document}\n\\title{${words(title)}}\\date{}\\maketitle\n${body(system)}\n\nConstraint: ${words(integrability)}.\n${sections.join("\n")}\n\\end{document}\n`;
}

// A string of Python.
const quoted = (text) => JSON.stringify(text).replace(/[\u007f-\uffff]/g, (c) => `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`);

// A script that computes the motions that are shown, by the module deltaq; costates are given as they are here.
export function python({ text, set, motions, costates, end }) {
  const numbers = Object.entries(set).filter(([name]) => !name.startsWith("P0_"));
  const overrides = numbers.map(([name, x]) => `${quoted(name)}: ${x}`).join(", ");
  const solve = ({ label, formulation }) => {
    const [, removal] = /^removed constraint \((.*)\)$/.exec(label) ?? [];
    const given = costates(label);
    const words = [quoted(formulation), removal && `removal=${quoted(removal)}`, given && `constants=[${given.join(", ")}]`];
    return `    ${quoted(label)}: system.solve(${words.filter(Boolean).join(", ")}),\n`;
  };
  const scene = text.includes("'''") ? quoted(text) : `r'''\n${text}'''`;
  return `import deltaq\n\nSCENE = ${scene}\n\nsystem = deltaq.parse(SCENE, {${overrides}})\nmotions = {\n${motions.map(solve).join("")}}
for label, motion in motions.items():\n    print(label, motion.status, motion.at(${end}).coordinates)\nprint(system.compare(fits="none"))\n`;
}

function save(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

const blobOf = (canvas) => new Promise((resolve) => canvas.toBlob(resolve, "image/png"));

// A canvas on paper.
function onPaper(canvas, colour) {
  const paper = document.createElement("canvas");
  [paper.width, paper.height] = [canvas.width, canvas.height];
  const context = paper.getContext("2d");
  context.fillStyle = colour;
  context.fillRect(0, 0, paper.width, paper.height);
  context.drawImage(canvas, 0, 0);
  return paper;
}

export class Take {
  // `page` gives what files are made of.
  constructor(list, page) {
    const button = ([kind, [label]]) => `<button type="button" data-take="${kind}">${label}</button>`;
    list.innerHTML = Object.entries(LABELS).map(button).join("");
    for (const one of list.children) one.addEventListener("click", () => this.take(one.dataset.take));
    this.page = page;
  }

  // Costates at the start of a motion, where one of them was set; null where none was.
  costates(label) {
    const { page } = this;
    const names = page.scene().controls.filter(({ motion }) => motion === label).map(({ name }) => name);
    if (!names.some((name) => name in page.set())) return null;
    const { constants = [] } = page.told().find((motion) => motion.label === label) ?? {};
    return names.map((name) => page.set()[name] ?? constants.find((constant) => `${constant.name}@${label}` === name)?.value ?? 0);
  }

  // What a file has in it; nothing where what it needs was stopped.
  async content(kind) {
    const { page } = this;
    const [samples, title] = [page.samples(), page.scene().title];
    const onWhite = (canvas) => blobOf(onPaper(canvas, ink("page")));
    switch (kind) {
      case "png": return onWhite(page.stage.canvas);
      case "curves": return onWhite(document.querySelector("#plot canvas"));
      case "svg": return page.stage.svg(title);
      case "csv": return csv(samples);
      case "python":
        return python({ text: page.text(), set: page.set(), motions: samples.motions, costates: (label) => this.costates(label), end: samples.end });
      case "toml":
        // numbers that were set are in the text then, which is written anew
        return Object.keys(page.set()).length ? page.written() : page.text();
      case "page": {
        // as `deltaq explore` does: what is chosen stands in it, and cannot end the element that it is in
        const chosen = JSON.stringify({ name: page.name(), text: null, set: {}, state: page.state() });
        untouched.querySelector("#chosen").textContent = chosen.replaceAll("<", "\\u003c");
        return `<!DOCTYPE html>\n${untouched.outerHTML}\n`;
      }
      default: {
        const equations = await page.equations();
        return equations && latex(equations, title);
      }
    }
  }

  async take(kind) {
    const content = await this.content(kind);
    const [, ending, type] = LABELS[kind];
    if (content) save(`${this.page.name()}${kind === "curves" ? "-curves" : ""}.${ending}`, content, type);
  }
}
