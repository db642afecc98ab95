// The page: what was chosen goes to the program, what it answers is shown.

import { Clock } from "./clock.js";
import { Controls } from "./controls.js";
import { Curves } from "./curves.js";
import { Engine, compile } from "./engine.js";
import { look, swatch } from "./look.js";
import { Samples } from "./samples.js";
import { Stage } from "./stage.js";
import { decode, encode, forget, remember, state, turn } from "./state.js";
import { Text } from "./text.js";
import { equations, verdict } from "./words.js";

const element = (id) => document.getElementById(id);
const json = (id) => JSON.parse(element(id).textContent);

const scenes = json("scenes");
const chosen = json("chosen");
const OWN = "own";
// Rows of a motion at rest, and while a hand is on a slider.
const STEPS = [480, 240];

let scene; // what the program said of the text
let motionsEngine, wordsEngine;

const clock = new Clock(
  { button: element("play"), bar: element("bar"), reading: element("reading"), speed: element("speed") },
  (t) => {
    stage.draw(t);
    curves.at(t);
  },
);
const stage = new Stage(element("stage"), element("note"));
const curves = new Curves(element("plot"), element("curve"), (t) => {
  clock.pause();
  clock.go(t);
});
const controls = new Controls(element("numbers"), (numbers, moving) => set(numbers, moving));
const text = new Text({ area: element("area"), marks: element("marks"), faults: element("faults") }, (typed) => {
  const write = () => Object.assign(state, { scene: OWN, text: typed });
  if (own()) write();
  else turn(write);
  keep();
  remember();
  readScene(false);
});

// The last text of one's own: it can be chosen again.
let draft = null;

function keep() {
  draft = state.text ?? draft;
  element("scene").querySelector(`[value=${OWN}]`).hidden = draft === null;
  element("scene").value = own() ? OWN : state.scene;
}

const builtIn = (name) => scenes.find((scene) => scene.name === name);
const own = () => state.text !== null;
const sceneText = () => state.text ?? builtIn(state.scene)?.text ?? "";

const question = (ask, more = {}) => ({ ask, name: own() ? OWN : state.scene, text: sceneText(), set: state.set, ...more });

// Labels of the motions that are shown: at first Chetaev, vakonomic, the first removal, κ.
function shown() {
  const first = new Set();
  const standard = ({ formulation }) => {
    const fresh = !first.has(formulation);
    first.add(formulation);
    return fresh && formulation !== "vakonomic-costate";
  };
  const isShown = (motion) => {
    const normally = standard(motion);
    return state.on.includes(motion.label) || (normally && !state.off.includes(motion.label));
  };
  return scene.motions.filter(isShown).map(({ label }) => label);
}

function say(message, bad = false) {
  element("said").textContent = message;
  element("said").classList.toggle("bad", bad);
}

// What is shown in words belongs to what was asked before.
function outdated() {
  asked += 1;
  wordsEngine.stop();
  element("deciding").hidden = true;
  for (const id of ["verdict", "equations"]) {
    element(id).replaceChildren();
    element(id).setAttribute("aria-busy", "true");
  }
}

function busy(id, is) {
  element(id).setAttribute("aria-busy", String(is));
}

// No motion is shown; with a reason there is none.
function empty(reason = null) {
  asked += 1;
  clearTimeout(resting);
  clock.pause();
  for (const id of ["view", "graph"]) {
    element(id).classList.add("void");
    busy(id, reason === null);
  }
  for (const id of ["play", "bar"]) element(id).disabled = true;
  element("refused").hidden = reason === null;
  element("refused").textContent = reason ?? "";
  element("busy").hidden = true;
  if (reason === null) return;
  for (const id of ["verdict", "equations"]) busy(id, false);
  say(reason, true);
}

// Something is shown again.
function filled() {
  for (const id of ["view", "graph"]) {
    element(id).classList.remove("void");
    busy(id, false);
  }
  for (const id of ["play", "bar"]) element(id).disabled = false;
  element("refused").hidden = true;
}

// Reads the scene; with `anew` it is another one.
async function readScene(anew) {
  outdated();
  if (anew) {
    motionsEngine.stop();
    empty();
    say("");
    controls.clear();
    element("title").replaceChildren();
    element("legend").replaceChildren();
  }
  const reply = await motionsEngine.ask("scene", question("scene"));
  if (!reply) return;
  const { answer } = reply;
  if (answer.faults || answer.refused) {
    const faults = answer.faults ?? [{ line: 0, column: 0, length: 0, message: answer.refused }];
    text.mark(faults, answer.message ?? answer.refused);
    const [{ line, message }] = faults;
    return empty(line ? `line ${line}: ${message}` : message);
  }
  text.mark([]);
  scene = answer;
  element("title").innerHTML = "<b></b> <small></small>";
  element("title").firstChild.textContent = scene.title;
  element("title").lastChild.textContent = scene.source;
  element("title").title = scene.notes;
  document.title = `${scene.title} – deltaq explore`;
  controls.build(scene.controls, state.set);
  legend();
  await motions(false, anew);
}

function legend(answers = []) {
  const counts = {};
  const on = shown();
  const labels = scene.motions.map(({ label, formulation }) => {
    const further = (counts[formulation] = (counts[formulation] ?? -1) + 1);
    const row = document.createElement("label");
    row.innerHTML = `<input type="checkbox">${swatch(look(formulation, further))}<span></span><small></small>`;
    const [box, , name, remark] = row.children;
    const answer = answers.find((answer) => answer.label === label);
    box.checked = on.includes(label);
    row.classList.toggle("off", !box.checked);
    name.textContent = label;
    row.title = answer?.refused ?? answer?.cause ?? "";
    if (answer?.refused) remark.textContent = "no motion";
    else if (answer && answer.status !== "completed") remark.textContent = `${answer.status}${answer.status === "stopped" ? ` at ${Number(answer.end.toPrecision(4))} s` : ""}`;
    box.addEventListener("change", () => {
      state.on = state.on.filter((other) => other !== label).concat(box.checked ? [label] : []);
      state.off = state.off.filter((other) => other !== label).concat(box.checked ? [] : [label]);
      remember();
      row.classList.toggle("off", !box.checked);
      controls.shown(shown());
      outdated();
      motions(false, false);
    });
    return row;
  });
  controls.shown(on);
  // whoever has the focus on one of them keeps it
  const focused = [...element("legend").querySelectorAll("input")].indexOf(document.activeElement);
  element("legend").replaceChildren(...labels);
  labels[focused]?.querySelector("input").focus();
}

let resting;
let asked = 0;

// Asks for the motions: at a glance while something moves, and then in full.
async function motions(glance, anew) {
  clearTimeout(resting);
  const number = ++asked;
  const wait = setTimeout(() => (element("busy").hidden = false), 400);
  // what is new is first seen at a glance
  const more = { motions: shown(), steps: STEPS[glance || anew ? 1 : 0], glance: glance || anew };
  const reply = await motionsEngine.ask("motions", question("motions", more));
  clearTimeout(wait);
  if (!reply) return;
  element("busy").hidden = true;
  show(reply, anew);
  if (glance || anew) {
    resting = setTimeout(() => number === asked && motions(false, false), anew ? 0 : 200);
  } else {
    controls.found(reply.answer.motions ?? []);
    if (reply.answer.motions) decide();
  }
}

let drawn = 0;
let first;

function draw(samples, anew) {
  clock.samples = samples;
  if (anew) {
    const length = samples.end - samples.start;
    const speeds = [...element("speed").options].map(({ value }) => Number(value));
    // a run takes about ten seconds at most
    element("speed").value = String(speeds.find((speed) => length / speed <= 12) ?? speeds.at(-1));
    clock.t = state.time || samples.start;
  }
  stage.show(samples, anew);
  clock.span(samples.start, samples.end);
  curves.show(samples, state.curve);
  filled();
}

function show(reply, anew) {
  const { answer } = reply;
  if (answer.faults || answer.refused) return empty(answer.message ?? answer.refused);
  const samples = new Samples(reply, scene.coordinates);
  if (answer.motions.length && answer.motions.every(({ refused }) => refused)) {
    empty(answer.motions.map(({ label, refused }) => `${label}: ${refused}`).join(" "));
  } else {
    draw(samples, anew);
  }
  if (anew || answer.motions.some(({ error }) => error !== null)) legend(answer.motions);
  // for tests and for who looks behind the page
  window.explored = { answer, milliseconds: reply.milliseconds, drawn: ++drawn, samples, first: (first ??= performance.now()) };
}

// What takes longer, in the other worker.
async function decide() {
  say("deciding …");
  element("deciding").hidden = false;
  const [more, number] = [{ motions: shown() }, asked];
  const reply = await wordsEngine.ask("decision", question("decision", more));
  if (number !== asked) return;
  element("deciding").hidden = true;
  busy("verdict", false);
  const answer = reply?.answer ?? { refused: "The decision was stopped." };
  element("verdict").innerHTML = verdict(answer.faults ? { refused: answer.message } : answer);
  say(answer.refused ?? answer.message ?? answer.verdict, Boolean(answer.refused ?? answer.message));
  window.decided = answer;
  const written = await wordsEngine.ask("equations", question("equations", more));
  if (number !== asked) return;
  busy("equations", false);
  if (written) element("equations").innerHTML = equations(written.answer.faults ? { refused: written.answer.message } : written.answer);
}

// Sets numbers by name; null takes that of the text.
function set(numbers, moving) {
  const before = JSON.stringify(state.set);
  for (const [name, value] of Object.entries(numbers)) {
    if (value === null) delete state.set[name];
    else state.set[name] = value;
  }
  remember();
  if (JSON.stringify(state.set) !== before) outdated();
  // κ brings a motion of its own, which goes with it
  const hasKappa = scene.motions.some(({ formulation }) => formulation === "kappa");
  const isKappa = (name) => scene.controls.find((control) => control.name === name)?.kind === "kappa";
  const turned = Object.entries(numbers).some(([name, value]) => isKappa(name) && hasKappa === (value === null));
  if (turned) return kappa();
  motions(moving, false);
}

async function kappa() {
  const reply = await motionsEngine.ask("scene", question("scene"));
  if (!reply) return;
  scene.motions = reply.answer.motions ?? scene.motions;
  legend();
  motions(false, false);
}

function choose(name) {
  turn(() => Object.assign(state, { scene: name, text: name === OWN ? draft : null, set: {}, on: [], off: [], time: 0 }));
  keep();
  element("notice").hidden = true;
  text.put(sceneText());
  clock.t = 0;
  readScene(true).then(play);
}

function play() {
  if (!element("play").disabled) clock.play();
}

function openTab(name, isChosen = true) {
  state.tab = name;
  if (isChosen) remember();
  for (const tab of document.querySelectorAll("[role=tab]")) {
    const open = tab.dataset.tab === name;
    tab.setAttribute("aria-selected", open);
    tab.tabIndex = open ? 0 : -1;
    element(tab.dataset.tab).hidden = !open;
  }
}

function keys(event) {
  if (event.target.matches("input, select, textarea, button, summary") || event.ctrlKey || event.metaKey || event.altKey) return;
  const far = event.shiftKey ? 10 : 1;
  const actions = {
    " ": () => element("play").click(), ArrowLeft: () => clock.step(-far), ArrowRight: () => clock.step(far),
    Home: () => clock.step(-100), End: () => clock.step(100), "+": () => stage.magnify(1.25), "-": () => stage.magnify(0.8),
    0: () => stage.reset(),
  };
  const tabs = [...document.querySelectorAll("[role=tab]")];
  const action = actions[event.key] ?? (tabs[event.key - 1] && (() => openTab(tabs[event.key - 1].dataset.tab)));
  if (!action) return;
  event.preventDefault();
  action();
}

function listen() {
  element("scene").addEventListener("change", ({ target }) => choose(target.value));
  element("curve").addEventListener("change", ({ target }) => {
    state.curve = target.value;
    remember();
    curves.show(clock.samples, state.curve);
  });
  element("bar").addEventListener("change", () => {
    state.time = clock.t;
    remember();
  });
  element("stop").addEventListener("click", () => {
    motionsEngine.stop();
    element("busy").hidden = true;
    say("stopped", true);
  });
  element("undecided").addEventListener("click", () => wordsEngine.stop());
  for (const tab of document.querySelectorAll("[role=tab]")) tab.addEventListener("click", () => openTab(tab.dataset.tab));
  element("link").addEventListener("click", async () => {
    state.time = clock.t;
    const link = `${location.href.split("#")[0]}#${encode()}`;
    history.replaceState(null, "", link);
    try {
      await navigator.clipboard.writeText(link);
      element("link").textContent = "Copied";
    } catch {
      element("link").textContent = "In the address bar";
    }
    setTimeout(() => (element("link").textContent = "Copy link"), 1500);
  });
  element("theme").addEventListener("click", () => {
    const { classList } = document.documentElement;
    const dark = classList.contains("dark") || (!classList.contains("light") && matchMedia("(prefers-color-scheme: dark)").matches);
    classList.remove("light", "dark");
    classList.add(dark ? "light" : "dark");
    redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  element("help").addEventListener("click", () => element("about").showModal());
  document.addEventListener("keydown", keys);
  addEventListener("hashchange", () => restore());
}

function redraw() {
  if (!clock.samples) return;
  stage.draw();
  curves.show(clock.samples, state.curve);
}

// Everything as the address says; without a word there, as the page was made.
async function restore() {
  const otherwise = chosen ? { scene: chosen.text === null ? chosen.name : OWN, text: chosen.text, set: { ...chosen.set } } : {};
  forget();
  let fault = decode(location.hash, otherwise);
  if (!own() && !builtIn(state.scene)) {
    fault = `there is no scene ${state.scene} here`;
    state.scene = scenes[0].name;
  }
  // it stays there, and the address as it is, until something is chosen
  element("notice").hidden = fault === null;
  element("notice").textContent = `The link cannot be read: ${fault}.`;
  keep();
  text.put(sceneText());
  openTab(state.tab, false);
  await readScene(true);
  if (!state.time) play();
}

async function begin() {
  const option = ({ name, title }) => `<option value="${name}">${title}</option>`;
  const groups = [...new Set(scenes.map(({ group }) => group))];
  const list = (group) => scenes.filter((scene) => scene.group === group).map(option).join("");
  const grouped = groups.map((group) => `<optgroup label="${group}">${list(group)}</optgroup>`);
  element("scene").innerHTML = `${grouped.join("")}<option value="${OWN}" hidden>own text</option>`;
  const source = element("worker").textContent;
  const module = await compile(element("program").textContent);
  motionsEngine = new Engine(module, source);
  wordsEngine = new Engine(module, source);
  listen();
  await restore();
}

begin().catch((error) => say(`This browser cannot run the program: ${error.message}`, true));
