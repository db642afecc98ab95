// Everybody's page: keys only, a screen reader, no motion, fingers; and what axe-core finds, in every state.

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

import { yours } from "./editor.test.mjs";
import { LIVELY, resize } from "./pages.test.mjs";

const SIZES = [[1280, 600], [400, 800]];
// CSS pixels that a control has at least, each way (WCAG 2.2, 2.5.8).
const LEAST = 24;

// Arrow keys go from tab to tab and open what they come to; the tab stop is the one that is open.
export async function tabs({ open, leave, link, must }) {
  const page = await open(link({ scene: "sledge" }));
  const now = () => page.evaluate(() => {
    const tab = document.activeElement;
    const open = [...document.querySelectorAll("[role=tabpanel]:not([hidden])")].map(({ id }) => id);
    const stops = [...document.querySelectorAll("[role=tab]")].filter(({ tabIndex }) => tabIndex === 0).map(({ dataset }) => dataset.tab);
    const named = document.getElementById(tab.getAttribute("aria-controls"))?.getAttribute("aria-labelledby") === tab.id;
    return [tab.dataset.tab, open.join(), stops.join(), tab.getAttribute("aria-selected"), String(named)].join(" ");
  });
  await page.focus("[data-tab=numbers]");
  for (const [key, tab] of [["ArrowRight", "verdict"], ["ArrowRight", "equations"], ["End", "text"], ["ArrowLeft", "review"], ["ArrowLeft", "derivatives"], ["ArrowLeft", "integrals"], ["ArrowLeft", "equations"], ["ArrowLeft", "verdict"], ["ArrowLeft", "numbers"]]) {
    await page.keyboard.press(key);
    must((await now()) === `${tab} ${tab} ${tab} true true`, `${key} leads to: ${await now()}`);
  }
  await leave(page);
}

// The tour by keys alone, from the first to the last step, and out of it.
export async function byKeys({ open, leave, forget, fresh, must, url }) {
  const context = await fresh();
  const page = await open(url, { context });
  const press = async (selector, most = 60) => {
    for (let i = 0; i < most; i++) {
      if (await page.evaluate((selector) => document.activeElement.matches(selector), selector)) return page.keyboard.press("Enter");
      await page.keyboard.press("Tab");
    }
    must(false, `keys do not reach ${selector}`);
  };
  for (let step = 1; step <= 6; step++) {
    const heading = await page.$eval("#tour .steps", ({ textContent }) => textContent);
    must(heading === `Step ${step} of 6`, `keys lead to ${heading}`);
    await press('[data-answer="0"]');
    await page.waitForFunction(() => document.querySelector("#tour .reveal").textContent, { timeout: 60000 });
    must(await page.evaluate(() => document.activeElement.matches("#tour *")), `step ${step}: the focus is lost`);
    await press("#next");
  }
  await page.waitForFunction(() => !document.querySelector("#numbers").hidden, { timeout: 5000 }).catch(() => must(false, "keys do not leave the tour"));
  await leave(page);
  await forget(context);
}

// Who does not like things to move: nothing runs by itself, and a picture is where it is going at once.
export async function calm({ open, leave, forget, link, must, choose, fresh, url }) {
  const page = await open(link({ scene: "sledge" }));
  const time = () => page.$eval("#reading", ({ textContent }) => textContent);
  const runs = async (page) => {
    const before = await page.$eval("#reading", ({ textContent }) => textContent);
    await new Promise((resolve) => setTimeout(resolve, 400));
    return before !== (await page.$eval("#reading", ({ textContent }) => textContent));
  };
  must(!(await runs(page)), `a first scene runs by itself: ${await time()}`);
  await choose(page, "disc");
  must(!(await runs(page)), "another scene runs by itself");
  await page.click("#play");
  must(await runs(page), "the play button does nothing");
  await leave(page);
  const lively = await open(link({ scene: "sledge" }), { features: LIVELY });
  must(await runs(lively), "nothing runs by itself where motion is liked");
  await leave(lively);
  const context = await fresh();
  const toured = await open(url, { context });
  await toured.click("[data-answer='0']");
  must(!(await runs(toured)), "an answer in the tour starts the motion");
  await forget(context);
}

const STATES = [
  ...["numbers", "verdict", "equations", "text"].map((tab) => [tab, { scene: "sledge", tab, time: 1 }]),
  ...["integrals", "derivatives"].map((tab) => [tab, { scene: "sledge", tab }, (page) => page.waitForSelector(`#${tab} table`)]),
  ["review", { scene: "sledge", tab: "review", time: 1 }, (page) => yours(page, "x'' = -g*sin(alpha) - l*sin(phi)\ny'' = l*cos(phi)\nphi'' = 0*t")],
  ["tour, a question", { scene: "sledge", set: { duration: 5 }, tab: "tour", step: 1, guess: -1 }],
  ["tour, an answer", { scene: "sledge", tab: "tour", step: 3, guess: 1, set: { mu0_1: 2, duration: 5 }, time: 1 }],
  ["forces", { scene: "sledge", forces: true, time: 1 }],
  ["the start in the hand", { scene: "sledge", grips: true }],
  ["curves cut, a camera that goes with a body, differences", { scene: "sledge", curve: "coordinate:x", follow: "Chetaev", by: 10, time: 1 }],
  ["no motion", { scene: "sledge", set: { k: 0 }, tab: "verdict" }],
  ["a faulty text", { scene: "own", text: "title = 3\n", tab: "text" }],
  ["a link that cannot be read", { scene: "nowhere" }],
  ["a dialog", { scene: "disc", time: 1 }, (page) => page.click("#help")],
  ["what to take along", { scene: "disc", time: 1 }, (page) => page.click("#take")],
];

// Each state in both colours and in both sizes: one of these pairs, and the next state the other one. Of what axe knows nothing
// depends on colour and size at once.
const LOOKS = [["light", "dark"], ["dark", "light"]].map((schemes) => schemes.map((scheme, i) => [scheme, SIZES[i]]));

// axe-core finds nothing serious in any state; every control has a name, and is large enough for a finger.
export async function axe({ open, leave, look, link, must, said }) {
  const source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
  let passes = 0;
  for (const [i, [name, state, act]] of STATES.entries()) {
    const refused = ["no motion", "a faulty text"].includes(name);
    const page = await open(link(state), { until: refused ? "#refused:not([hidden])" : null });
    await act?.(page);
    await page.evaluate(source);
    // sizes and colours are the style's: the page that is there takes them on
    for (const [scheme, [width, height]] of LOOKS[i % LOOKS.length]) {
      await look(page, scheme);
      const at = `(${name}, ${scheme}, ${width} × ${height})`;
      await resize(page, { width, height });
      const seen = await page.evaluate(() => [innerWidth, innerHeight, matchMedia("(prefers-color-scheme: dark)").matches].join());
      must(seen === [width, height, scheme === "dark"].join(), `the page is seen as ${seen} ${at}`);
      const found = await page.evaluate(() => axe.run({ resultTypes: ["violations"], rules: { "target-size": { enabled: true } } }));
      passes += found.passes.length;
      const bad = found.violations.filter(({ impact }) => impact === "serious" || impact === "critical");
      for (const { id, nodes } of bad) must(false, `axe: ${id} at ${nodes.slice(0, 3).map(({ target }) => target)} ${at}`);
      for (const small of await page.evaluate(tooSmall, LEAST)) must(false, `${small}, ${LEAST} are needed ${at}`);
    }
    await leave(page);
  }
  must(passes > 0, "axe looked at nothing");
  said.push(`axe: ${passes} rules hold in ${LOOKS[0].length * STATES.length} states`);
}

// Controls under a size, with what one can hit: a box in a label is as large as its label.
function tooSmall(least) {
  const controls = [...document.querySelectorAll("button, select, input, textarea, summary, a[href], [role=tab]")];
  const seen = controls.filter((control) => control.checkVisibility({ visibilityProperty: true }) && !control.disabled);
  return seen.flatMap((control) => {
    const { width, height } = (control.type === "checkbox" ? control.closest("label") : control).getBoundingClientRect();
    if (width >= least - 0.1 && height >= least - 0.1) return [];
    return [`${control.id || control.ariaLabel || control.textContent} is ${width.toFixed(1)} × ${height.toFixed(1)} px`];
  });
}
