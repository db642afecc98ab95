// Texts of one's own: the one that is being written, and those that this browser keeps under their titles.

import { byName } from "./names.js";
import * as store from "./store.js";

const PREFIX = "kept:";
const NAME = "scenes";

export class Own {
  // `select` is where scenes are chosen, its last group that of the texts that are kept.
  constructor(select) {
    this.select = select;
    this.group = document.createElement("optgroup");
    this.group.label = "kept in this browser";
    this.draft = null;
    this.list();
  }

  list() {
    const option = (title) => new Option(title, PREFIX + title);
    this.group.replaceChildren(...Object.keys(this.texts()).sort().map(option));
    if (this.group.children.length) this.select.append(this.group);
    else this.group.remove();
  }

  texts() {
    const texts = store.kept(NAME, {});
    return byName(typeof texts === "object" && !Array.isArray(texts) ? Object.entries(texts) : []);
  }

  // The text behind a choice, null where it is none of these.
  text(choice) {
    return choice.startsWith(PREFIX) ? (this.texts()[choice.slice(PREFIX.length)] ?? null) : null;
  }

  // What is chosen; the text that is being written can be, once there is one.
  offer(own, chosen) {
    this.select.querySelector(`[value=${own}]`).hidden = this.draft === null;
    this.select.value = chosen;
  }

  isKept(title, text) {
    return this.texts()[title] === text;
  }

  // Keeps a text, or forgets it; whether that is done.
  keep(title, text) {
    const texts = this.texts();
    if (text === null) delete texts[title];
    else texts[title] = text;
    const done = store.keep(NAME, texts);
    this.list();
    return done;
  }
}
