// The text of a scene: lines with numbers, faults and notes marked, names completed, functions and examples to insert.

import { FUNCTIONS } from "./functions.js";

// Names that are offered at most, for words of at least so many letters.
const [OFFERED, LETTERS] = [6, 2];

export const button = (text, act) => {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = text;
  made.addEventListener("click", act);
  return made;
};

// Lines under a text, with numbers; the places of what was found there are marked, unless one lies in another.
export function mark(under, area, found) {
  under.replaceChildren(...area.value.split("\n").map((line, i) => {
    const row = document.createElement("div");
    let done = 0;
    for (const { line: at, column, length, kind } of found) {
      if (at !== i + 1 || column - 1 < done) continue;
      row.className ||= kind;
      const place = document.createElement("u");
      place.textContent = line.slice(column - 1, column - 1 + Math.max(1, length));
      row.append(line.slice(done, column - 1), place);
      done = column - 1 + place.textContent.length;
    }
    row.append(line.slice(done) || " ");
    return row;
  }));
}

export class Text {
  // `changed` is called with the text shortly after typing; `keys` are words of the format, `examples` texts by their names.
  constructor(parts, changed) {
    Object.assign(this, parts, { keys: [] });
    const { area } = this;
    let timer;
    area.addEventListener("input", () => {
      clearTimeout(timer);
      this.mark([]);
      this.offer();
      timer = setTimeout(() => changed(area.value), 250);
    });
    area.addEventListener("scroll", () => this.scroll());
    area.addEventListener("keydown", (event) => this.key(event));
    for (const event of ["blur", "pointerdown"]) area.addEventListener(event, () => this.offer(false));
    // what is offered is taken without the focus leaving the text
    this.offers.addEventListener("pointerdown", (event) => event.preventDefault());
    this.functions.append(...FUNCTIONS.map(([call, says = ""]) => {
      const item = document.createElement("li");
      item.append(button(call, () => this.insert(call)), ` ${says}`);
      return item;
    }));
    this.example.addEventListener("change", () => {
      const { text, whole } = this.examples[this.example.value];
      this.example.value = "";
      if (whole) this.insert(text, 0, area.value.length);
      else this.insert(`${area.value.endsWith("\n") ? "" : "\n"}${text}`, area.value.length);
      area.scrollTop = whole ? 0 : area.scrollHeight;
    });
  }

  // What can be completed and inserted.
  know(keys, examples) {
    Object.assign(this, { keys, examples });
    this.example.append(...examples.map(({ name }, i) => new Option(name, i)));
  }

  put(text) {
    if (this.area.value !== text) this.area.value = text;
    this.mark([]);
  }

  // Puts a text in the place of a part, or at the caret, as if it were typed.
  insert(text, from = this.area.selectionStart, to = from) {
    const { area } = this;
    area.focus();
    area.setRangeText(text, from, to, "end");
    area.dispatchEvent(new Event("input"));
  }

  scroll() {
    this.marks.scrollTop = this.area.scrollTop;
    this.marks.scrollLeft = this.area.scrollLeft;
  }

  // The word before the caret, if it is no comment; and the names that go on from there, those of the text first.
  completions() {
    const { area: { value, selectionStart: at, selectionEnd: end }, keys } = this;
    const line = value.slice(value.lastIndexOf("\n", at - 1) + 1, at);
    const [word = ""] = /[A-Za-z_][\w-]*$/.exec(line) ?? [];
    if (at !== end || word.length < LETTERS || line.includes("#") || /^\w/.test(value.slice(at))) return [word, []];
    const own = (value.slice(0, at - word.length) + value.slice(at)).match(/[A-Za-z_]\w*/g) ?? [];
    const calls = FUNCTIONS.map(([call]) => call.replace(/\(.*/, "("));
    const names = new Set([...own, ...calls, ...keys].filter((name) => name.startsWith(word) && name !== word));
    return [word, [...names].slice(0, OFFERED)];
  }

  // Offers names below the text; with `is` false none.
  offer(is = true) {
    const [word, names] = is ? this.completions() : ["", []];
    const take = (name) => this.insert(name.slice(word.length));
    this.taken = names.length ? () => take(names[0]) : null;
    this.offers.replaceChildren(...names.map((name) => Object.assign(button(name, () => take(name)), { tabIndex: -1 })));
    if (names.length) this.offers.append("Tab takes the first");
  }

  key(event) {
    const act = { Tab: event.shiftKey ? null : this.taken, Escape: this.taken && (() => this.offer(false)) }[event.key];
    if (act) event.preventDefault();
    if (act) act();
    else if (!["Shift", "Backspace"].includes(event.key) && event.key.length > 1) this.offer(false);
  }

  // Lines under the text, with numbers and marks; below it the messages of faults and notes, each of which leads to its place.
  mark(faults, message = "", notes = []) {
    const kinds = [[faults, "bad"], [notes, "note"]];
    mark(this.marks, this.area, kinds.flatMap(([those, kind]) => those.map((one) => ({ ...one, kind }))));
    this.scroll();
    for (const [list, those] of [[this.faults, faults], [this.notes, notes]]) {
      const items = document.createElement("ul");
      items.append(...those.map((one) => this.fault(one)));
      list.replaceChildren(items);
      list.hidden = !those.length;
    }
    this.faults.dataset.message = message;
  }

  fault({ line, column, length, message }) {
    const item = document.createElement("li");
    item.append(button(line ? `line ${line}, column ${column}: ${message}` : message, () => {
      const before = this.area.value.split("\n").slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
      this.area.focus();
      this.area.setSelectionRange(before + column - 1, before + column - 1 + length);
    }));
    return item;
  }
}
