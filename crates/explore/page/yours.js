// Somebody's equations beside the scene: whether they are right, and the wrong term marked.

import { button, mark } from "./text.js";

const VERDICTS = { right: "These equations are right: they give d'Alembert–Lagrange's motions from every start.", wrong: "These equations are wrong.", undecided: "deltaq cannot tell." };

const line = (text, kind = "") => Object.assign(document.createElement("p"), { textContent: text, className: kind });

export class Yours {
  // `ask` gives the answer about a text, or null if something else is asked by then.
  constructor({ theirs, under, judge, judged }, ask) {
    Object.assign(this, { theirs, under, judge, judged, ask });
    judge.addEventListener("click", () => this.review());
    theirs.addEventListener("input", () => this.clear());
    theirs.addEventListener("scroll", () => Object.assign(under, { scrollTop: theirs.scrollTop, scrollLeft: theirs.scrollLeft }));
    this.clear();
  }

  // What was said belongs to what was asked before.
  clear() {
    this.judged.replaceChildren();
    mark(this.under, this.theirs, []);
  }

  async review() {
    this.clear();
    this.judged.append(line("reviewing …", "hint"));
    const answer = await this.ask(this.theirs.value);
    this.clear();
    if (answer) this.show(answer);
  }

  show({ verdict, refused, message, mends = [], explanations = [], broken = [], notes = [], differences = [] }) {
    const cannot = refused ?? message;
    const [, row, column] = /^yours:(\d+)(?::(\d+))?/.exec(cannot) ?? [];
    const marks = cannot ? (row ? [{ line: Number(row), column: Number(column ?? 1), length: 1 }] : []) : mends;
    mark(this.under, this.theirs, marks.map((one) => ({ ...one, kind: "bad" })));
    const say = (...lines) => this.judged.append(...lines);
    if (cannot) return say(line(`They cannot be read: ${cannot}`, "bad"));
    say(line(VERDICTS[verdict], verdict === "wrong" ? "bad sentence" : "sentence"));
    for (const one of mends) {
      const item = line("");
      item.append(button(`line ${one.line}: ${one.message}`, () => {
        const before = this.theirs.value.split("\n").slice(0, one.line - 1).reduce((sum, text) => sum + text.length + 1, 0);
        this.theirs.focus();
        this.theirs.setSelectionRange(before + one.column - 1, before + one.column - 1 + one.length);
      }));
      say(item);
    }
    explanations.forEach((one, i) => say(line(`${i ? "The same equations come of" : "They are exactly the equations of"}: ${one.join(", ")}.`)));
    for (const one of broken) say(line(`The constraint ${one} is not that of the scene.`));
    for (const { name, theirs, right } of differences) say(line(`${name} is ${theirs.toPrecision(6)} instead of ${right.toPrecision(6)}.`));
    for (const one of notes) say(line(one, "hint"));
  }
}
