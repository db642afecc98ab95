// The program's Markdown on the page: equations by KaTeX as MathML, which needs no fonts.

import katex from "katex";

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

// The verdict, why and how sure; then which family has which motion, and how that is proved.
export function verdict({ verdict, why, sure, decisions, refused }) {
  if (refused) return `<p>${escape(refused)}</p>`;
  const card = ([family, motion, which, reason]) =>
    `<li><p>Is the motion of <b>${escape(motion)}</b> one of <b>${escape(family)}</b>?</p><p>For ${inline(which)}: ${escape(reason)}.</p></li>`;
  const decided = decisions.length ? `<h3>Decided</h3><ul class="cards">${decisions.map(card).join("")}</ul>` : "";
  return `<h3>Verdict</h3><p>${escape(verdict)}</p><h3>Why</h3><p>${escape(why)}</p><h3>How sure</h3><p>${escape(sure)}</p>${decided}`;
}
