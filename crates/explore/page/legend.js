// The motions there are, each with its look, to be shown or not, and with a word where one is none or ends early.

import { look, swatch } from "./look.js";
import { figure } from "./names.js";

// The word for a motion that is not complete.
function remark(answer) {
  if (answer?.refused) return "no motion";
  if (!answer || answer.status === "completed") return "";
  return answer.status === "stopped" ? `stopped at ${figure(answer.end)} s` : answer.status;
}

// Labels of the motions that are shown: at first Chetaev, vakonomic, the first removal, κ.
export function shownOf(motions, { on, off }) {
  const first = new Set();
  const isShown = ({ label, formulation }) => {
    const normally = !first.has(formulation) && formulation !== "vakonomic-costate";
    first.add(formulation);
    return on.includes(label) || (normally && !off.includes(label));
  };
  return motions.filter(isShown).map(({ label }) => label);
}

// A motion is chosen to be shown, or not to be.
export function choosing(state, label, on) {
  state.on = state.on.filter((other) => other !== label).concat(on ? [label] : []);
  state.off = state.off.filter((other) => other !== label).concat(on ? [] : [label]);
}

export class Legend {
  // `turned` is called with a label that is to be shown or not to be.
  constructor(element, turned) {
    Object.assign(this, { element, turned });
  }

  show(motions, on, answers) {
    const counts = {};
    const rows = motions.map(({ label, formulation }) => {
      const further = (counts[formulation] = (counts[formulation] ?? -1) + 1);
      const row = document.createElement("label");
      row.innerHTML = `<input type="checkbox">${swatch(look(formulation, further))}<span></span><small></small>`;
      const [box, , name, small] = row.children;
      box.checked = on.includes(label);
      row.classList.toggle("off", !box.checked);
      name.textContent = label;
      small.textContent = remark(answers.find((answer) => answer.label === label));
      box.addEventListener("change", () => {
        row.classList.toggle("off", !box.checked);
        this.turned(label, box.checked);
      });
      return row;
    });
    // whoever has the focus on one of them keeps it
    const focused = [...this.element.querySelectorAll("input")].indexOf(document.activeElement);
    this.element.replaceChildren(...rows);
    rows[focused]?.querySelector("input").focus();
  }
}
