// The program's Markdown on the page: equations by KaTeX as MathML, which needs no fonts.

import katex from "katex";

import { figure, readable } from "./names.js";

const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

// Functions stand apart from what is before and behind them also where no font for mathematics is there to say so.
const spaced = (mathml) =>
  mathml.replace(/<mi>([a-z]{2,})<\/mi><mo>\u2061<\/mo>/g, '<mspace width=".17em"/>$&<mspace width=".17em"/>');

const math = (latex, displayMode) =>
  spaced(katex.renderToString(latex, { output: "mathml", displayMode, throwOnError: false }));

// An equation in pieces between which a line can end: all but the first begin with a plus or minus that is in no
// bracket.
function formula(latex) {
  const pieces = [""];
  let depth = 0;
  for (const token of latex.split(/(\\[a-zA-Z]+|[{}()[\]]| [-+] )/)) {
    if ("{([".includes(token || " ")) depth += 1;
    else if ("})]".includes(token || " ")) depth -= 1;
    // with nothing before it, a sign stands between two terms all the same
    else if (depth === 0 && / [-+] /.test(token)) pieces.push("{}");
    pieces[pieces.length - 1] += token;
  }
  return `<div class="formula">${pieces.map((piece) => math(piece, true)).join("")}</div>`;
}

function inline(text) {
  const parts = text.split(/(\$[^$]+\$|\*\*[^*]+\*\*)/);
  const part = (piece) => {
    if (piece.startsWith("$")) return math(piece.slice(1, -1), false);
    return piece.startsWith("**") ? `<strong>${escape(piece.slice(2, -2))}</strong>` : escape(piece);
  };
  return parts.map(part).join("");
}

// Lines, fenced math and lists.
function markup(text) {
  const pieces = text.split(/```math\n([\s\S]*?)\n```/);
  const prose = (piece) =>
    piece.split("\n").map((line) => line.trim()).filter(Boolean)
      .map((line) => (line.startsWith("- ") ? `<ul><li>${inline(line.slice(2))}</li></ul>` : `<p>${inline(line)}</p>`))
      .join("").replaceAll("</ul><ul>", "");
  return pieces.map((piece, i) => (i % 2 ? formula(piece) : prose(piece))).join("");
}

// The system, then the equations of every motion in a section of their own.
export function equations({ system, integrability, motions, refused }) {
  if (refused) return `<p>${escape(refused)}</p>`;
  const section = ({ label, equations, refused }, i) =>
    `<details${i ? "" : " open"}><summary>${escape(label)}</summary>${refused ? `<p>refused: ${escape(refused)}</p>` : markup(equations)}</details>`;
  return `${markup(system)}<p>Constraint: ${escape(integrability)}.</p>${motions.map(section).join("")}`;
}

const VERDICTS = { same: ["=", "the same"], different: ["≠", "different"], undecided: ["?", "undecided"] };

// When the gap passes 0.001; of one that does not, since when a difference is certain.
function since({ verdict, visible, certain }) {
  if (verdict !== "different") return "–";
  if (visible !== null) return `${figure(visible)} s`;
  return certain === null ? "not seen" : `less, from ${figure(certain)} s`;
}

// The largest differences of coordinates, by name with their units, the largest of each unit.
function differences({ verdict, coordinates }) {
  if (verdict !== "different") return "–";
  const largest = new Map();
  for (const one of coordinates) if (!(largest.get(one.unit)?.by >= one.by)) largest.set(one.unit, one);
  const part = ({ name, unit, by }) => `<i>${readable(escape(name))}</i>: ${figure(by)} ${escape(unit)}`;
  return [...largest.values()].filter(({ by }) => by > 0).map(part).join("<br>") || "–";
}

// Pair by pair: the same or not, from when, by how much.
function table(pairs) {
  const row = (pair) => {
    const [sign, word] = VERDICTS[pair.verdict];
    return `<tr><th scope="row">${escape(pair.first)} – ${escape(pair.second)}</th>
      <td class="${pair.verdict}"><b aria-hidden="true">${sign}</b> ${word}${pair.proved ? "<br>proved" : ""}</td>
      <td>${since(pair)}</td><td>${differences(pair)}</td><td>${figure(pair.largest)} ${escape(pair.unit)}</td></tr>`;
  };
  const undecided = pairs.filter(({ because }) => because).map(({ first, second, because }) => `<p>${escape(first)} – ${escape(second)}: undecided, ${escape(because)}.</p>`);
  return `<div class="wide" tabindex="0" role="region" aria-label="pairs of motions"><table><thead><tr><th scope="col">pair</th><th scope="col">motions</th><th scope="col">0.001 ${escape(pairs[0].unit)} apart from</th>
    <th scope="col">differ by up to</th><th scope="col">largest distance</th></tr></thead><tbody>${pairs.map(row).join("")}</tbody></table></div>${undecided.join("")}`;
}

// The table of pairs and one sentence of why; the verdict, why and how sure in the words of the program; which family
// has which motion, and how that is proved; motions that are none or end early; what is known of the scene.
export function verdict({ verdict, why, sure, whose, sentence, pairs, decisions, refused }, { notes = "", motions = [] } = {}) {
  if (refused) return `<p>${escape(refused)}</p>`;
  const card = ({ family, motion, which, reason }) =>
    `<li><p>Is the motion of <b>${escape(motion)}</b> one of <b>${escape(family)}</b>?</p><p>For ${inline(which)}: ${escape(reason)}.</p></li>`;
  const decided = decisions.length ? `<h3>Decided</h3><ul class="cards">${decisions.map(card).join("")}</ul>` : "";
  const causes = motions.map((motion) => [motion.label, motion.refused ?? motion.cause]).filter(([, cause]) => cause);
  const ends = causes.length ? `<h3>Motions that do not exist or end early</h3>${causes.map(([label, cause]) => `<p><b>${escape(label)}</b>: ${escape(cause)}</p>`).join("")}` : "";
  return `${sentence ? `<p class="sentence">${escape(sentence)}</p>` : ""}${pairs.length ? table(pairs) : ""}
    <h3>Verdict</h3><p>${escape(verdict)}</p><h3>Why</h3><p>${escape(why)}</p><h3>How sure</h3><p>${escape(sure)}</p>${whose ? `<h3>Which one</h3><p>${escape(whose)}</p>` : ""}${decided}${ends}
    ${notes ? `<h3>Notes on the scene</h3><p>${escape(notes)}</p>` : ""}`;
}

// Invariant measures and integrals of one motion: what each answer is about, and the answer.
export function integrals({ label, near, degree, lines, refused }) {
  if (refused) return `<p>${escape(refused)}</p>`;
  const row = ([about, words]) => `<tr><th scope="row">${escape(about)}</th><td>${escape(words).replaceAll(/[*^/]|\w\(/g, "$&<wbr>")}</td></tr>`;
  const more = degree < 2 ? `<p><button type="button">Also quadratic ones</button></p>` : "";
  return `<p>Of the motion of <b>${escape(label)}</b>${near ? `, ${escape(near)}` : ""}:</p>
    <div class="wide" tabindex="0" role="region" aria-label="integrals"><table class="said"><tbody>${lines.map(row).join("")}</tbody></table></div>${more}`;
}

// An error is shown where it is more than this of a derivative.
const SEEN = 1e-3;

// Derivatives of the coordinates at the end by the numbers: a table for each motion.
export function derivatives({ motions, refused }, coordinates) {
  if (refused) return `<p>${escape(refused)}</p>`;
  const named = (name, unit) => `<i>${readable(escape(name))}</i>${unit ? `, ${escape(unit)}` : ""}`;
  const cell = (by, error) => `<td>${figure(by)}${error > SEEN * Math.abs(by) && error > 0 ? ` ± ${figure(error)}` : ""}</td>`;
  const cells = ({ by, error, refused }) => (refused ? `<td colspan="${coordinates.length}">refused: ${escape(refused)}</td>` : by.map((x, i) => cell(x, error[i])).join(""));
  const row = (number) => `<tr><th scope="row">${named(number.name, number.unit)}</th>${cells(number)}</tr>`;
  const table = ({ label, rows }) => `<div class="wide" tabindex="0" role="region" aria-label="derivatives, ${escape(label)}"><table><thead><tr><th scope="col">by</th>
    ${coordinates.map(({ name, unit }) => `<th scope="col">${named(name, unit)}</th>`).join("")}</tr></thead><tbody>${rows.map(row).join("")}</tbody></table></div>`;
  const section = (motion, i) => `<details${i ? "" : " open"}><summary>${escape(motion.label)}${motion.refused ? "" : `, at ${figure(motion.end)} s`}</summary>
    ${motion.refused ? `<p>refused: ${escape(motion.refused)}</p>` : table(motion)}</details>`;
  return `<p>These are the derivatives of the final coordinates with respect to each number, in the unit of the column per unit of the row.
    Errors are shown if they exceed a thousandth.</p>${motions.map(section).join("")}`;
}
