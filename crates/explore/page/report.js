// What the page says of itself: that it computes, that there is nothing to be seen, and why.

const element = (id) => document.getElementById(id);
const CONTROLS = ["play", "bar", "take"];

export function say(message, bad = false) {
  element("said").textContent = message;
  element("said").classList.toggle("bad", bad);
}

// What is said above the page until something is chosen; nothing with an empty text.
export function notice(text) {
  element("notice").hidden = text === "";
  element("notice").textContent = text;
}

export function busy(id, is) {
  element(id).setAttribute("aria-busy", String(is));
}

// No motion is shown; with a reason there is none.
export function nothing(reason = null) {
  for (const id of ["view", "graph"]) {
    element(id).classList.add("void");
    busy(id, reason === null);
  }
  for (const id of CONTROLS) element(id).disabled = true;
  element("refused").hidden = reason === null;
  element("refused").textContent = reason ?? "";
  element("busy").hidden = true;
  if (reason === null) return;
  for (const id of ["verdict", "equations"]) busy(id, false);
  say(reason, true);
}

// Something is shown again.
export function something() {
  for (const id of ["view", "graph"]) {
    element(id).classList.remove("void");
    busy(id, false);
  }
  for (const id of CONTROLS) element(id).disabled = false;
  element("refused").hidden = true;
}

// Whose motions are shown.
export function entitled({ title, source }) {
  element("title").innerHTML = "<b></b> <small></small>";
  element("title").firstChild.textContent = title;
  element("title").lastChild.textContent = source;
  element("stage").setAttribute("aria-label", `bodies in motion: ${title}`);
  document.title = `${title} – deltaq explore`;
}

// Options of scenes, in their groups.
export function groups(scenes) {
  return [...new Set(scenes.map(({ group }) => group))].map((name) => {
    const group = document.createElement("optgroup");
    group.label = name;
    group.append(...scenes.filter((scene) => scene.group === name).map(({ name, title }) => new Option(title, name)));
    return group;
  });
}
