// The guided path: six steps, each a state of the page, with a question, a number to move, and what came out. A step's
// sentences about the motions are made from what was computed of them, so they hold wherever the slider stands.

import { byName, figure, readable } from "./names.js";

const BLUE = "Chetaev";
const ORANGE = "vakonomic";
const KAPPA = "between, κ";
const FRICTION = "first order, ε and slip";
const SLEDGE = { scene: "sledge", off: ["removed constraint (arc-length)"] };
const ONE_OR_TWO = ["One motion", "Two motions"];

// A skate on level ice.
export const SKATE = `title = "My skate on level ice"
[coordinates]
x   = { unit = "m", start = 0 }
y   = { unit = "m", start = 0 }
phi = { unit = "rad", start = 0.3 }   # where the blade points
[system]                              # a prime is a rate
lagrangian  = "(x'^2 + y'^2)/2 + phi'^2/4"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[start]
velocities = { "x'" = 1, "phi'" = 0.8 }
[run]
duration = 5
[view.ice]
shape = "plane"
size = [6, 6]
[view.skate]
shape = "blade"
size = [0.6, 0.2]
at = "[x, y, 0]"
rotation = "phi"
`;

// What the comparison found of two motions.
const pairOf = ({ decided }, one, other) =>
  decided.pairs.find(({ first, second }) => [first, second].includes(one) && [first, second].includes(other));

const seconds = (x) => `${figure(x)} s`;
const metres = (x) => `${figure(x)} m`;

// Largest distance between the marked points of two motions.
function apart({ samples }, one, other) {
  const [a, b] = [one, other].map((label) => samples.motions.find((motion) => motion.label === label));
  const rows = Math.min(a.rows, b.rows) - (a.rows === b.rows ? 0 : 1);
  const distances = Array.from({ length: rows }, (_, row) => Math.hypot(...a.track(row).map((x, i) => x - b.track(row)[i])));
  return Math.max(...distances);
}

// Which of two motions a third is nearer to: 0 or 1.
const nearer = (facts, label) => (apart(facts, label, BLUE) < apart(facts, label, ORANGE) ? 0 : 1);

function oneOrTwo(facts, one, two) {
  const pair = pairOf(facts, BLUE, ORANGE);
  if (pair.verdict === "undecided") return `This is undecided: ${pair.because}.`;
  if (pair.verdict === "same") return `There is one motion: up to ${seconds(pair.until)} no difference exceeds the errors. ${one}`;
  const from = pair.visible === null ? "" : `They differ by 0.001 ${pair.unit} after ${seconds(pair.visible)}. `;
  return `There are two motions. ${from}Their largest distance is ${metres(apart(facts, BLUE, ORANGE))}. ${two}`;
}

const sameOrNot = (facts) => ["same", "different"].indexOf(pairOf(facts, BLUE, ORANGE).verdict);

const membership = ({ decided }) => decided.decisions.find(({ family, motion }) => family === ORANGE && motion === BLUE);

// `seen` are the motions that run before a question is answered, by default the blue one alone.
export const STEPS = [
  {
    title: "A blade restricts velocities",
    state: { ...SLEDGE, set: { duration: 5 } },
    text: `A sledge stands on one blade on a slope. It glides along the blade and turns, but it never slides sideways.
      Equations of motion follow from comparing a motion with nearby curves, and there are two rules for which ones.
      <b class="blue">Blue</b> is d'Alembert–Lagrange's rule (Chetaev): small shifts that the blade allows at each instant.
      <b class="orange">Orange</b> is the vakonomic rule: whole curves on which the blade never slides sideways.`,
    question: "From the same start, do the two rules give one motion or two?",
    answers: ONE_OR_TWO,
    truth: sameOrNot,
    reveal: (facts) => oneOrTwo(facts, "From this start they agree.",
      "Shifts that are allowed at each instant need not add up to a curve on which the blade never slides. So the two rules compare with different curves."),
  },
  {
    title: "A rod restricts positions",
    state: { scene: "velocity-pendulum", off: ["removed constraint (quasi-velocities)", "removed constraint (along-x)"] },
    text: `A ball hangs on a rod. The rod, too, is written as a constraint on velocities: none along the rod. But it follows
      that the ball stays on a circle. Such a constraint is holonomic. The blade's is nonholonomic: by gliding and
      turning, the sledge can reach every position.`,
    question: "Do the same two rules give one motion or two?",
    answers: ONE_OR_TWO,
    truth: sameOrNot,
    reveal: (facts) => oneOrTwo(facts, "Allowed shifts of the ball stay on its circle. So both rules compare with the same curves.",
      "This is not expected of a rod."),
  },
  {
    title: "Try to make them meet",
    state: { ...SLEDGE, set: { duration: 5, mu0_1: 0 } },
    text: `The orange rule needs one more number at the start, the multiplier μ₀. The position and velocity of the sledge
      do not determine it. So there is one orange motion for each μ₀.`,
    question: "Is there a μ₀ with which orange follows blue?",
    answers: ["Yes, there is", "No, there is none"],
    seen: [BLUE, ORANGE],
    slider: { name: "mu0_1", sign: "μ₀", unit: "kg m/s", low: -20, high: 20, hint: "Move it, and try to lay orange on blue." },
    truth: (facts) => ["some", "none"].findIndex((word) => membership(facts).answer.startsWith(word)),
    reading: (facts) => `Their largest distance is ${metres(apart(facts, BLUE, ORANGE))}.`,
    reveal(facts) {
      const { answer, which, reason } = membership(facts);
      if (answer === "none, proved") return `There is none, and this is not a failed search: deltaq proves it for all μ₀ at once. In its words: ${reason}.`;
      if (answer === "none, measured") return `There is none, as far as deltaq measured: ${reason}.`;
      return answer === "undecided" ? `This is undecided: ${reason}.` : `There is one, ${which}: ${reason}.`;
    },
  },
  {
    title: "From one rule to the other",
    state: { ...SLEDGE, set: { duration: 3, kappa: 0.01 } },
    text: `A family of motions leads from one rule to the other. <b class="purple">Purple</b> is the member with the number κ;
      with κ = 0 it is orange. At κ = 0.01 per second, purple nearly coincides with orange.`,
    question: "Where does purple go when κ becomes large?",
    answers: ["It goes to blue", "It stays with orange"],
    seen: [BLUE, ORANGE, KAPPA],
    slider: { name: "kappa", sign: "κ", unit: "1/s", low: 0.01, high: 1000, log: true, start: 1000, hint: "κ is 1000 now. Move it to the left and back." },
    purple: KAPPA,
    truth: (facts) => nearer(facts, KAPPA),
    reading: (facts) => `Purple is at most ${metres(apart(facts, KAPPA, BLUE))} from blue and ${metres(apart(facts, KAPPA, ORANGE))} from orange.`,
    reveal: (facts) => (nearer(facts, KAPPA) === 0
      ? "Here purple is nearer to blue. As κ grows, its distance from blue tends to zero as 1/κ. The two rules are the ends of one family."
      : "Here purple is nearer to orange, because κ is small."),
  },
  {
    title: "Friction chooses",
    state: { ...SLEDGE, set: { duration: 5, slip: 0.1 } },
    text: `Which one is physical? Friction holds the blade of a real sledge: a force across the blade, N times the speed of
      slipping. The <b class="purple">purple</b> sledge has that force instead of the constraint. Newton's law gives its motion.`,
    question: "Whose motion is it if friction is strong?",
    answers: ["That of blue", "That of orange"],
    seen: [BLUE, ORANGE],
    slider: { name: "slip", sign: "N", unit: "kg/s", low: 3, high: 10000, log: true, inverse: true, start: 1000, hint: "N is 1000 now. Friction grows to the right." },
    purple: FRICTION,
    truth: (facts) => nearer(facts, FRICTION),
    reading: (facts) => `Purple is at most ${metres(apart(facts, FRICTION, BLUE))} from blue and ${metres(apart(facts, FRICTION, ORANGE))} from orange.`,
    reveal: (facts) => (nearer(facts, FRICTION) === 0
      ? "Purple is nearer to blue. Its distance decreases as friction grows, so friction chooses Chetaev. (A constraint that added mass enforces leads to an orange motion instead.)"
      : "With so little friction the sledge slips, and the constraint does not hold."),
  },
  {
    title: "Your own system",
    state: { scene: "own", text: SKATE, set: { "phi'": 0.8 }, off: ["removed constraint (coordinates)", "removed constraint (quasi-velocities)"] },
    text: `Every system here is a short text: coordinates, a Lagrangian, a constraint, a start. This one is a skate on level
      ice. You can change it or write another one. This skate turns while it glides, and the two motions diverge.`,
    question: "Let it start without turning. Do they still diverge?",
    answers: ["No: one motion", "Yes: two motions"],
    seen: [BLUE, ORANGE],
    slider: { name: "phi'", sign: "φ′", unit: "rad/s", low: -1.6, high: 1.6, start: 0, hint: "This is the rate of turning at the start." },
    truth: sameOrNot,
    reveal: (facts) => oneOrTwo(facts, "The skate glides straight on. Whether the motions differ also depends on the start.", "Set the rate of turning to zero."),
    last: `<button type="button" id="write">Open the text</button>`,
  },
];

// The motions that are not to be seen before a step's question is answered.
export const veiled = (step, labels) => labels.filter((label) => !(STEPS[step - 1].seen ?? [BLUE]).includes(label));

// The state of the page at the beginning of a step.
export function stateOf(step) {
  const { scene, text = null, set = {}, off = [] } = STEPS[step - 1].state;
  return { scene, text, set: byName(Object.entries(set)), on: [], off: [...off], time: 0, tab: "tour", step, guess: -1, follow: "", by: 1, grips: false };
}

export class Tour {
  // `go` enters a step, `set` sets a number, `guessed` is called with an answer, `write` opens the text.
  constructor(panel, acts) {
    Object.assign(this, { panel, acts });
  }

  // Shows a step: the question, and once it was answered what came out.
  show(number, guess) {
    const step = STEPS[number - 1];
    [this.step, this.guess, this.guessed] = [step, guess, guess >= 0];
    const { panel } = this;
    const focused = panel.contains(document.activeElement);
    const answers = step.answers.map((answer, i) => `<button type="button" aria-pressed="${i === guess}" data-answer="${i}">${answer}</button>`);
    panel.innerHTML = `<p class="steps">Step ${number} of ${STEPS.length}</p><h2 tabindex="-1">${step.title}</h2><p>${step.text}</p>
      <div role="group" aria-label="${step.question}"><p class="question">${step.question}</p><p class="answers">${answers.join("")}</p></div>
      <div class="found" ${this.guessed ? "" : "hidden"}></div>
      <div aria-live="polite" class="reveal"></div>
      <p class="ways"><button type="button" id="back" ${number === 1 ? "disabled" : ""}>Back</button>
      <button type="button" id="next">${number === STEPS.length ? "To all scenes" : "Next"}</button><button type="button" id="leave" class="plain">Leave the tour</button></p>`;
    const on = (selector, act) => panel.querySelector(selector)?.addEventListener("click", act);
    for (const i of step.answers.keys()) on(`[data-answer="${i}"]`, () => this.acts.guessed(i));
    on("#back", () => this.acts.go(number - 1));
    on("#next", () => (number === STEPS.length ? this.acts.leave() : this.acts.go(number + 1)));
    on("#leave", () => this.acts.leave());
    if (step.slider) this.slider(step.slider);
    else panel.querySelector(".found").remove();
    if (step.last) {
      panel.querySelector(".ways").insertAdjacentHTML("beforebegin", `<p>${step.last}</p>`);
      on("#write", () => this.acts.write());
    }
    // whoever is here by keys stays: at the answer, or at the head of a new step
    if (focused) panel.querySelector(`${this.guessed ? "[aria-pressed=true]" : "h2"}`).focus();
    this.update();
  }

  // A number of the step: it goes from low to high, or their logarithms do; of an inverse 1/x is what is set.
  slider({ name, sign, unit, low, high, log, inverse, hint }) {
    const found = this.panel.querySelector(".found");
    found.innerHTML = `<p class="hint">${hint}</p><p class="mover"><label for="mover">${sign}</label>
      <input id="mover" type="range" min="0" max="1000" step="1"><output for="mover"></output></p><p class="reading"></p>`;
    const [input, output] = [found.querySelector("input"), found.querySelector("output")];
    const [from, to] = log ? [Math.log(low), Math.log(high)] : [low, high];
    const value = () => {
      const x = from + ((to - from) * input.value) / 1000;
      return Number(log ? Math.exp(x).toPrecision(2) : x.toPrecision(3));
    };
    const tell = () => {
      output.textContent = `${figure(value())} ${unit}`;
      input.setAttribute("aria-valuetext", output.textContent);
    };
    const put = (x) => {
      input.value = Math.round((1000 * ((log ? Math.log(x) : x) - from)) / (to - from));
      tell();
    };
    const give = (moving) => {
      tell();
      this.acts.set({ [name]: inverse ? 1 / value() : value() }, moving);
    };
    input.addEventListener("input", () => give(true));
    input.addEventListener("change", () => give(false));
    const x = this.acts.facts().set[name];
    put(inverse ? 1 / x : x);
  }

  // What was computed of the motions is new, or is not there yet.
  update() {
    if (!this.step || !this.guessed) return;
    const { step, panel } = this;
    const facts = this.acts.facts();
    // an answer to what was asked in another step has not all of them
    const isThere = (label) => facts.samples?.motions.some((motion) => motion.label === label);
    const areThere = [BLUE, ORANGE, step.purple ?? BLUE].every(isThere);
    if (step.reading && areThere) panel.querySelector(".reading").textContent = step.reading(facts);
    const reveal = panel.querySelector(".reveal");
    if (!areThere || !facts.decided?.pairs) {
      reveal.setAttribute("aria-busy", "true");
      return;
    }
    reveal.setAttribute("aria-busy", "false");
    const isRight = step.truth(facts) === this.guess;
    const said = `${isRight ? "As you said." : "Not quite."} ${step.reveal(facts)}`;
    // what is said already is not said again
    if (reveal.textContent !== said) reveal.textContent = said;
  }
}
