// Buttons, choices and keys of the page, each with what it does.

import * as panels from "./panels.js";
import { remember, state, ways } from "./state.js";

const element = (id) => document.getElementById(id);
const on = (id, event, act) => element(id).addEventListener(event, act);

// Keys that are not typed into something.
function keys({ openTab, clock, stage }) {
  return (event) => {
    if (event.target.matches("input, select, textarea, button, summary, [role=tab]") || event.ctrlKey || event.metaKey || event.altKey) return;
    const far = event.shiftKey ? 10 : 1;
    const actions = {
      " ": () => element("play").click(), ArrowLeft: () => clock.step(-far), ArrowRight: () => clock.step(far),
      Home: () => clock.step(-100), End: () => clock.step(100), "+": () => stage.magnify(1.25), "-": () => stage.magnify(0.8),
      0: () => stage.reset(), f: () => element("forces").click(), m: () => element("grips").click(),
      a: () => stage.turn(-20, 0), d: () => stage.turn(20, 0), w: () => stage.turn(0, 20), s: () => stage.turn(0, -20),
    };
    const action = actions[event.key] ?? (panels.names[event.key - 1] && (() => openTab(panels.names[event.key - 1])));
    if (!action || element("view").classList.contains("void")) return;
    event.preventDefault();
    action();
  };
}

// Light or dark, the other one than now.
function theme() {
  const { classList } = document.documentElement;
  const dark = classList.contains("dark") || (!classList.contains("light") && matchMedia("(prefers-color-scheme: dark)").matches);
  classList.remove("light", "dark");
  classList.add(dark ? "light" : "dark");
}

async function copy(button, text) {
  const label = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    // the address of a file is one of this computer; the page itself can be saved and sent
    button.textContent = location.protocol === "file:" ? "Copied, for this computer" : "Copied";
  } catch {
    button.textContent = "In the address bar";
  }
  setTimeout(() => (button.textContent = label), 1500);
}

// Whether there is something to be undone, or to be done again.
export function undoing() {
  const { back, forth } = ways();
  element("undo").disabled = !back;
  element("redo").disabled = !forth;
}

// `acts` are what the page does.
export function listen(acts) {
  on("scene", "change", ({ target }) => acts.choose(target.value));
  on("curve", "change", ({ target }) => {
    state.curve = target.value;
    remember();
    acts.redraw();
  });
  on("bar", "change", () => {
    state.time = acts.clock.t;
    remember();
  });
  on("stop", "click", acts.stop);
  on("undecided", "click", acts.stopDeciding);
  on("forces", "change", ({ target }) => acts.showMore("forces", target.checked));
  on("grips", "change", ({ target }) => acts.showMore("grips", target.checked));
  on("closer", "click", () => acts.curves.magnify(2));
  on("wider", "click", () => acts.curves.magnify(0.5));
  on("ends", "click", () => acts.curves.all());
  on("keep", "click", acts.keepText);
  on("undo", "click", () => ways().back && history.back());
  on("redo", "click", () => ways().forth && history.forward());
  on("link", "click", ({ target }) => copy(target, acts.link()));
  on("slide", "click", ({ target }) => copy(target, `<iframe src="${acts.link()}&only=stage" title="${document.title.replaceAll('"', "")}" width="800" height="500"></iframe>`));
  on("take", "click", () => element("taking").showModal());
  on("help", "click", () => element("about").showModal());
  on("theme", "click", () => {
    theme();
    acts.redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", acts.redraw);
  panels.listen(acts.openTab);
  document.addEventListener("keydown", keys(acts));
  addEventListener("popstate", acts.restore);
}
