// The text of a scene, with its faults marked.

export class Text {
  // `changed` is called with the text shortly after typing.
  constructor({ area, marks, faults }, changed) {
    Object.assign(this, { area, marks, faults });
    let timer;
    area.addEventListener("input", () => {
      clearTimeout(timer);
      this.mark([]);
      timer = setTimeout(() => changed(area.value), 250);
    });
    area.addEventListener("scroll", () => this.scroll());
  }

  put(text) {
    if (this.area.value !== text) this.area.value = text;
    this.mark([]);
  }

  scroll() {
    this.marks.scrollTop = this.area.scrollTop;
    this.marks.scrollLeft = this.area.scrollLeft;
  }

  // Lines of faults under the text; below it the messages, each of which leads to its place.
  mark(faults, message = "") {
    const bad = new Set(faults.map(({ line }) => line));
    const lines = this.area.value.split("\n");
    this.marks.replaceChildren(...lines.map((line, i) => {
      const row = document.createElement("div");
      row.textContent = line || " ";
      row.classList.toggle("bad", bad.has(i + 1));
      return row;
    }));
    this.scroll();
    const list = document.createElement("ul");
    list.append(...faults.map((fault) => this.fault(fault)));
    this.faults.replaceChildren(list);
    this.faults.hidden = !faults.length;
    this.faults.dataset.message = message;
  }

  fault({ line, column, length, message }) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = line ? `line ${line}, column ${column}: ${message}` : message;
    button.addEventListener("click", () => {
      const before = this.area.value.split("\n").slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
      this.area.focus();
      this.area.setSelectionRange(before + column - 1, before + column - 1 + length);
    });
    const item = document.createElement("li");
    item.append(button);
    return item;
  }
}
