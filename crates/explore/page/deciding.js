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
    Object.assign(this, { engine, zipped, number: 0, answer: null });
  }

  // What is shown in words belongs to what was asked before.
  outdated() {
    this.number += 1;
    this.answer = null;
    this.engine.stop();
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

  // `question` makes one of a kind; `about` is what else is said of the scene and its motions; `decided` is called
  // once the verdict is there.
  async decide(question, about, decided) {
    say("deciding …");
    element("deciding").hidden = false;
    const number = ++this.number;
    const [reply, words] = await Promise.all([this.engine.ask("decision", question("decision")), this.words()]);
    if (number !== this.number) return;
    element("deciding").hidden = true;
    busy("verdict", false);
    const answer = reply?.answer ?? { refused: "The decision was stopped." };
    element("verdict").innerHTML = words.verdict(answer.faults ? { refused: answer.message } : answer, about);
    const failed = answer.refused ?? answer.message;
    say(failed ?? answer.sentence ?? answer.verdict, Boolean(failed));
    this.answer = answer;
    decided(answer);
    const written = await this.engine.ask("equations", question("equations"));
    if (number !== this.number) return;
    busy("equations", false);
    if (written) element("equations").innerHTML = words.equations(written.answer.faults ? { refused: written.answer.message } : written.answer);
    Object.assign(this, { question, about });
    this.look(this.open);
  }

  // A panel is opened.
  look(name) {
    this.open = name;
    if (FURTHER.includes(name) && this.question && !this.shown.has(name)) this.further(name, { degree: 1 });
  }

  async further(name, more) {
    this.shown.add(name);
    const number = this.number;
    const place = element(name);
    element("deciding").hidden = false;
    busy(name, true);
    const [reply, words] = await Promise.all([this.engine.ask(name, this.question(name, more)), this.words()]);
    if (number !== this.number) return;
    element("deciding").hidden = true;
    busy(name, false);
    const answer = reply?.answer ?? { refused: "That was stopped." };
    place.innerHTML = words[name](answer.faults ? { refused: answer.message } : answer, this.about.coordinates);
    place.querySelector("button")?.addEventListener("click", () => this.further(name, { degree: more.degree + 1 }));
  }
}
