// The verdict and the equations: computed beside the motions, shown in words, outdated when anything changes; integrals and
// derivatives, too, once somebody wants to see them.

import { load } from "./engine.js";
import { busy, say } from "./report.js";

const element = (id) => document.getElementById(id);
const PANELS = ["verdict", "equations"];
const FURTHER = ["integrals", "derivatives"];

export class Deciding {
  // `zipped` is the module of words, which is read when it is needed first.
  constructor(engine, zipped) {
    Object.assign(this, { engine, zipped, number: 0, awaited: 0, answer: null });
  }

  // What is shown in words belongs to what was asked before.
  outdated() {
    this.number += 1;
    this.awaited = 0;
    this.answer = null;
    this.engine.forget();
    element("deciding").hidden = true;
    this.question = null;
    this.shown = new Set();
    for (const id of [...PANELS, ...FURTHER]) {
      element(id).replaceChildren();
      busy(id, PANELS.includes(id) || id === this.open);
    }
  }

  words() {
    return (this.loaded ??= load(this.zipped));
  }

  // An answer (an object without any, if it was stopped) and the words for it, or null if something else is asked by then.
  // While an answer is awaited, that is said.
  async answered(kind, question) {
    const { number } = this;
    this.awaited += 1;
    element("deciding").hidden = false;
    const [reply, words] = await Promise.all([this.engine.ask(kind, question), this.words()]);
    if (number !== this.number) return null;
    this.awaited -= 1;
    element("deciding").hidden = this.awaited === 0;
    busy(kind === "decision" ? "verdict" : kind, false);
    const { answer } = reply ?? {};
    return { answer: answer?.faults ? { refused: answer.message } : answer, words };
  }

  // `question` makes one of a kind; `about` is what else is said of the scene and its motions; `decided` is called
  // once the verdict is there.
  async decide(question, about, decided) {
    say("deciding …");
    Object.assign(this, { number: this.number + 1, awaited: 0 });
    const found = await this.answered("decision", question("decision"));
    if (!found) return;
    const answer = found.answer ?? { refused: "The decision was stopped." };
    element("verdict").innerHTML = found.words.verdict(answer, about);
    say(answer.refused ?? answer.sentence ?? answer.verdict, Boolean(answer.refused));
    this.answer = answer;
    decided(answer);
    const written = await this.answered("equations", question("equations"));
    if (!written) return;
    element("equations").innerHTML = written.words.equations(written.answer ?? { refused: "The equations were stopped." });
    Object.assign(this, { question, about });
    this.look(this.open);
  }

  // A panel is opened.
  look(name) {
    this.open = name;
    if (FURTHER.includes(name) && this.question && !this.shown.has(name)) this.further(name, { degree: 1 });
  }

  // What was stopped is asked for again when its panel is opened again.
  async further(name, more) {
    this.shown.add(name);
    busy(name, true);
    const found = await this.answered(name, this.question(name, more));
    if (!found) return;
    if (!found.answer) this.shown.delete(name);
    const place = element(name);
    place.innerHTML = found.words[name](found.answer ?? { refused: "That was stopped." }, this.about.coordinates);
    place.querySelector("button")?.addEventListener("click", () => this.further(name, { degree: more.degree + 1 }));
  }
}
