// The page: what was chosen goes to the program, what it answers is shown.

import { told } from "./arrows.js";
import { Camera } from "./camera.js";
import { Clock } from "./clock.js";
import { Controls } from "./controls.js";
import { Curves } from "./curves.js";
import { Deciding } from "./deciding.js";
import { Engine, compile, textOf } from "./engine.js";
import { Grips } from "./grips.js";
import { Legend, choosing, shownOf } from "./legend.js";
import { listen, undoing } from "./listen.js";
import { byName } from "./names.js";
import { Own } from "./own.js";
import * as panels from "./panels.js";
import { entitled, groups, nothing, notice, say, something } from "./report.js";
import { Samples } from "./samples.js";
import { Stage } from "./stage.js";
import { arrived, decode, forget, push, remember, settle, shownOnly, state, turn } from "./state.js";
import * as store from "./store.js";
import { Take } from "./take.js";
import { Text } from "./text.js";
import { SKATE, STEPS, Tour, stateOf, veiled } from "./tour.js";
import { Yours } from "./yours.js";

const element = (id) => document.getElementById(id);
const chosen = JSON.parse(element("chosen").textContent);
const OWN = "own";
// Rows of a motion at rest, and while a hand is on a slider.
const SAMPLED = [480, 240];

// Parameters that bring a motion of their own, which goes with them.
const OF_LAWS = ["kappa", "slip", "epsilon"];
// Who does not like things to move starts them himself.
const still = matchMedia("(prefers-reduced-motion: reduce)");

let scenes; // the built-in ones
let scene; // what the program said of the text
let latest = []; // what it said of the motions last
let motionsEngine, wordsEngine, deciding;

const clock = new Clock(
  { button: element("play"), bar: element("bar"), reading: element("reading"), speed: element("speed") },
  (t) => {
    stage.draw(t);
    curves.at(t);
    if (clock.playing && window.explored) window.explored.moved ??= moved ??= performance.now();
    element("key").textContent = told(clock.samples, t, state.forces);
  },
);
const ownTexts = new Own(element("scene"));
const stage = new Stage(element("stage"), element("note"));
const camera = new Camera({ follow: element("follow"), by: element("by") }, stage, remember);
const curves = new Curves({ place: element("plot"), select: element("curve"), note: element("cut"), whole: element("whole") }, (t) => {
  clock.pause();
  clock.go(t);
});
const grips = new Grips(element("frame"), stage, (numbers, moving) => {
  controls.take(numbers);
  set(numbers, moving);
});
const controls = new Controls(element("numbers"), (numbers, moving) => set(numbers, moving));
const motionsLegend = new Legend(element("legend"), (label, on) => {
  choosing(state, label, on);
  remember();
  controls.shown(shown());
  outdated();
  motions(false, false);
});
const parts = ["area", "marks", "offers", "faults", "notes", "functions", "example"].map((id) => [id, element(id)]);
const editor = new Text(Object.fromEntries(parts), (typed) => {
  const write = () => Object.assign(state, { scene: OWN, text: typed, time: 0 });
  if (own()) write();
  else turn(write);
  keep();
  remember();
  undoing();
  readScene(true).then(() => {
    keep();
    run();
  });
});

const tour = new Tour(element("tour"), {
  go: enter,
  leave() {
    openTab("numbers");
    run();
  },
  write: () => openTab("text"),
  set: (numbers, moving) => set(numbers, moving),
  facts: () => ({ samples: clock.samples, decided: deciding.answer, set: state.set }),
  guessed(answer) {
    state.guess = answer;
    const { name, start, inverse } = STEPS[state.step - 1].slider ?? {};
    // what was computed before is no answer then
    if (start !== undefined) set({ [name]: inverse ? 1 / start : start }, false);
    showTour();
    clock.go(clock.start);
    remember();
    run();
  },
});

const yours = new Yours({ theirs: element("theirs"), under: element("under"), judge: element("judge"), judged: element("judged") },
  async (theirs) => (await motionsEngine.ask("review", question("review", { theirs })))?.answer);

function keep() {
  if (own() && (ownTexts.draft === null || state.text !== SKATE)) ownTexts.draft = state.text;
  ownTexts.offer(OWN, own() ? OWN : state.scene);
  element("keep").hidden = !own();
  element("keep").textContent = own() && scene && ownTexts.isKept(scene.title, state.text) ? "Forget this text" : "Keep in this browser";
}

const builtIn = (name) => scenes.find((scene) => scene.name === name);
const own = () => state.text !== null;
const sceneText = () => state.text ?? builtIn(state.scene)?.text ?? "";

const question = (ask, more = {}) => ({ ask, name: own() ? OWN : state.scene, text: sceneText(), set: state.set, ...more });

const shown = () => shownOf(scene.motions, state);

// What is shown in words belongs to what was asked before.
function outdated() {
  asked += 1;
  deciding.outdated();
}

// No motion is shown; with a reason there is none.
function empty(reason = null) {
  asked += 1;
  clearTimeout(resting);
  clock.pause();
  clock.samples = null;
  nothing(reason);
}

// Reads the scene; with `anew` it is another one.
async function readScene(anew) {
  outdated();
  yours.clear();
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
    editor.mark(faults, answer.message ?? answer.refused);
    const [{ line, message }] = faults;
    return empty(line ? `line ${line}: ${message}` : message);
  }
  editor.mark([]);
  scene = answer;
  for (const name of answer.unknown) delete state.set[name];
  if (answer.unknown.length) notice(`The text no longer defines ${answer.unknown.join(", ")}.`);
  entitled(scene);
  check();
  controls.build(scene.controls, state.set);
  legend();
  await motions(false, anew);
}

// Notes on the text, for who looks at it.
async function check() {
  if (state.tab !== "text") return;
  const reply = await wordsEngine.ask("check", question("check"));
  if (reply?.answer.remarks) editor.mark([], "", reply.answer.remarks);
}

function legend(answers = []) {
  controls.shown(shown());
  motionsLegend.show(scene.motions, shown(), answers);
}

let resting;
let asked = 0;

// Asks for the motions: at a glance while something moves, and then in full.
async function motions(glance, anew) {
  clearTimeout(resting);
  const number = ++asked;
  const wait = setTimeout(() => (element("busy").hidden = false), 400);
  // what is new is first seen at a glance
  const more = { motions: shown(), steps: SAMPLED[glance || anew ? 1 : 0], glance: glance || anew, forces: state.forces, grips: state.grips };
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

let drawn = 0, first, moved;

function draw(samples, anew) {
  clock.samples = samples;
  if (anew) clock.begin(samples, state.time);
  grips.show(samples, state.grips);
  camera.show(samples);
  stage.show(samples, anew);
  clock.span(samples.start, samples.end);
  curves.show(samples, state.curve, anew);
  something();
}

function show(reply, anew) {
  const { answer } = reply;
  if (answer.faults || answer.refused) return empty(answer.message ?? answer.refused);
  const samples = new Samples(reply, scene.coordinates);
  latest = answer.motions;
  // which way is down is not asked at a glance
  samples.down ??= anew ? undefined : clock.samples?.down;
  if (answer.motions.length && answer.motions.every(({ refused }) => refused)) {
    empty(answer.motions.map(({ label, refused }) => `${label}: ${refused}`).join(" "));
  } else {
    draw(samples, anew);
  }
  if (anew || answer.motions.some(({ error }) => error !== null)) legend(answer.motions);
  tour.update();
  // for tests and for who looks behind the page
  window.explored = { answer, scenes, milliseconds: reply.milliseconds, drawn: ++drawn, samples, stage, curves, grips, first: (first ??= performance.now()), moved };
}

// What takes longer, in the other worker.
function decide() {
  deciding.decide((ask, further) => question(ask, { motions: shown(), ...further }), { ...scene, motions: latest }, (answer) => {
    window.decided = answer;
    tour.update();
  });
}

// Sets numbers by name; null takes that of the text. What a hand has done with a slider is one change, when it lets go.
function set(numbers, moving) {
  if (!inHand) settle();
  inHand = moving;
  const before = { ...state.set };
  for (const [name, value] of Object.entries(numbers)) {
    if (value === null) delete state.set[name];
    else state.set[name] = value;
  }
  if (!moving) {
    push();
    undoing();
  }
  if (JSON.stringify(state.set) !== JSON.stringify(before)) outdated();
  if (OF_LAWS.some((name) => name in state.set !== name in before)) return laws();
  motions(moving, false);
}

let inHand = false;

async function laws() {
  const reply = await motionsEngine.ask("scene", question("scene"));
  if (!reply) return;
  scene.motions = reply.answer.motions ?? scene.motions;
  legend();
  motions(false, false);
}

function choose(choice) {
  const kept = ownTexts.text(choice);
  const name = kept === null ? choice : OWN;
  const text = kept ?? (choice === OWN ? ownTexts.draft : null);
  if (state.tab === "tour") openTab("numbers");
  turn(() => Object.assign(state, { scene: name, text, set: byName(), on: [], off: [], time: 0 }));
  notice("");
  arrive();
}

// Runs by itself, if that is wanted.
function run() {
  if (!still.matches && !clock.playing && !element("play").disabled) clock.play();
}

// Goes to a step of the tour.
function enter(step) {
  turn(() => Object.assign(state, stateOf(step)));
  notice("");
  arrive();
}

// Before a question is answered, what answers it is not to be seen.
const asks = () => state.tab === "tour" && state.guess < 0;

function showTour() {
  document.querySelector("main").classList.toggle("touring", state.tab === "tour");
  stage.veil((labels) => (asks() ? veiled(state.step, labels) : []));
  if (state.tab === "tour") tour.show(state.step, state.guess);
  deciding.look(state.tab);
}

// Opens a panel that was chosen; the tour goes on where it was left.
function openTab(name) {
  const before = state.tab;
  state.tab = name;
  panels.open(name);
  if (name === "tour") {
    state.step ||= 1;
    if (STEPS[state.step - 1].state.scene !== state.scene) return enter(state.step);
  }
  if (before === "tour" && name !== "tour") {
    store.keep("toured", true);
    // numbers were moved there, too
    if (scene) controls.build(scene.controls, state.set);
    if (scene) controls.shown(shown());
  }
  if (name === "text") check();
  showTour();
  remember();
}

// A link to what is seen now.
function link() {
  state.time = clock.t;
  remember();
  settle();
  return location.href;
}

function redraw() {
  if (!clock.samples) return;
  stage.draw();
  curves.show(clock.samples, state.curve);
}

// Forces, or what a hand takes hold of, which are at the start.
function showMore(what, is) {
  state[what] = is;
  remember();
  if (what === "grips" && is) {
    clock.pause();
    clock.go(clock.start);
  }
  motions(false, false);
}

function keepText() {
  const isKept = ownTexts.isKept(scene.title, state.text);
  if (!ownTexts.keep(scene.title, isKept ? null : state.text)) say("This browser does not store texts.", true);
  keep();
}

// Everything as the address says; without a word there, as the page was made, or the tour.
async function restore() {
  forget();
  arrived();
  const [name, before] = [state.scene, sceneText()];
  const made = () => chosen.state ?? { scene: chosen.text === null ? chosen.name : OWN, text: chosen.text, set: { ...chosen.set } };
  const isFirst = !chosen && location.hash === "" && !store.kept("toured", false);
  let fault = decode(location.hash, chosen ? structuredClone(made()) : isFirst ? stateOf(1) : {});
  if (!own() && !builtIn(state.scene)) {
    fault = `there is no scene ${state.scene} here`;
    state.scene = scenes[0].name;
  }
  if (!panels.names.includes(state.tab)) state.tab = "numbers";
  state.step = Math.min(STEPS.length, Math.max(state.tab === "tour" ? 1 : 0, Math.round(state.step)));
  document.documentElement.classList.toggle("only-stage", shownOnly() === "stage");
  // it stays there, and the address as it is, until something is chosen
  notice(fault === null ? "" : `The link cannot be read: ${fault}.`);
  await arrive(scene && name === state.scene && before === sceneText());
}

// Shows what the state says; of the scene that is shown already, the time goes on.
async function arrive(isSame = false) {
  keep();
  undoing();
  editor.put(sceneText());
  if (!isSame) clock.t = state.time;
  for (const id of ["forces", "grips"]) element(id).checked = state[id];
  camera.put();
  panels.open(state.tab);
  showTour();
  await readScene(!isSame);
  keep();
  if (!isSame && !state.time && !state.grips) run();
}

new Take(element("takes"), {
  name: () => (own() ? "scene" : state.scene), scene: () => scene, samples: () => clock.samples, told: () => latest,
  text: sceneText, set: () => state.set, state: () => ({ ...state, time: clock.t }), stage,
  equations: async () => (await wordsEngine.ask("taken", question("equations", { motions: shown() })))?.answer,
  written: async () => (await motionsEngine.ask("text", question("text")))?.answer.text,
});

// What buttons and keys do.
const begin = () =>
  listen({
    choose, openTab, link, redraw, showMore, keepText, restore, clock, stage, curves,
    stop() {
      motionsEngine.stop();
      element("busy").hidden = true;
      say("stopped", true);
    },
    stopDeciding: () => wordsEngine.stop(),
  });

async function start() {
  const source = element("worker").textContent;
  const compiled = compile(element("program").textContent);
  const texts = JSON.parse(await textOf(element("scenes").textContent));
  ({ scenes } = texts);
  editor.know(texts.keys, texts.examples);
  element("scene").prepend(...groups(scenes), new Option("own text", OWN));
  const module = await compiled;
  motionsEngine = new Engine(module, source);
  wordsEngine = new Engine(module, source);
  deciding = new Deciding(wordsEngine, element("words").textContent);
  begin();
  await restore();
}

start().catch((error) => say(`This browser cannot run the program: ${error.message}`, true));
