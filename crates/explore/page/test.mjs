// node test.mjs BROWSER DELTAQ PAGE PICTURES all|numbers|shown|elsewhere|CHECK|ROUNDS: the page in a browser without network,
// against the native program; or its numbers only; or whether what is shown is what was computed; or what another browser,
// Firefox, can be asked; or one of these checks by name; or whether it grows in this number of rounds of slider moves, and whether its
// frames come slower in five minutes.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

import puppeteer from "puppeteer-core";

import * as access from "./access.test.mjs";
import { broken } from "./broken.test.mjs";
import * as drawn from "./drawn.test.mjs";
import { editor, reviewed, robot } from "./editor.test.mjs";
import * as first from "./first.test.mjs";
import * as further from "./further.test.mjs";
import { frames, growth } from "./growth.test.mjs";
import * as hands from "./hand.test.mjs";
import * as looking from "./look.test.mjs";
import * as checks from "./shown.test.mjs";
import { LIVELY, Pages, after, choose, processor, resize } from "./pages.test.mjs";
import { eachBody, everyScene } from "./scenes.test.mjs";
import * as takes from "./take.test.mjs";
import { tasks } from "./tasks.test.mjs";
import { tour } from "./tour.test.mjs";

const [executablePath, deltaq, file, pictures, what] = process.argv.slice(2);
// Rounds of slider moves within all checks, and seconds of frames when rounds are asked for.
const [ROUNDS, SECONDS] = [6, 300];
// Milliseconds are of processor, of the page and its workers, until the first motion, for an update while a hand is on a slider,
// for a motion in a cone. What a clock says depends on what else the machine does, and is printed only.
const LIMITS = { megabytes: 2.3, first: 1000, update: 60, cone: 200, difference: 1e-12 };
const OWN = `title = "Skate"
[coordinates]
x = { unit = "m", start = 0 }
y = { unit = "m", start = 0 }
phi = { unit = "rad", start = 0.1 }
[system]
lagrangian = "(x'^2 + y'^2 + phi'^2)/2 + 0.3*x"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[start]
velocities = { "x'" = 1, "phi'" = 0.7 }
[run]
duration = 3
`;

const url = pathToFileURL(resolve(file)).href;
const userDataDir = mkdtempSync(join(tmpdir(), "explore-"));
mkdirSync(pictures, { recursive: true });
const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];
// flags for network, appearance and touch go to Chromium only, not to Firefox
const isChromium = !/firefox/.test(executablePath);
const browser = await puppeteer.launch({ executablePath, headless: true, userDataDir, ...(isChromium ? { args: flags } : { browser: "firefox" }) });
const browserName = browser.version();
const complaints = [];
const said = [];

let held = 0;

function must(holds, what) {
  held += 1;
  if (!holds) complaints.push(what);
}

const pages = new Pages(browser, isChromium, (what) => complaints.push(what));
const [open, leave, look, forget] = [pages.open, pages.leave, pages.look, pages.forget].map((does) => does.bind(pages));
const link = (state) => `${url}#${Buffer.from(JSON.stringify(state)).toString("base64url")}`;

const rows = (page, label) => page.evaluate((label) => {
  const motion = window.explored.samples.motions.find((motion) => motion.label === label);
  const names = Object.values(motion.columns.coordinate);
  return Array.from({ length: motion.rows }, (_, row) => [motion.time(row), ...names.map((place) => motion.value(row, place))]);
}, label);

function native(text, formulation, times) {
  const words = ["solve", "-", "--formulation", formulation, "--format", "csv", "--times", times.join(",")];
  const lines = execFileSync(deltaq, words, { input: text, encoding: "utf8" }).trim().split("\n").filter((line) => !line.startsWith("#"));
  const head = lines[0].split(",");
  return lines.slice(1).map((line) => ["t", "x", "y", "phi"].map((name) => Number(line.split(",")[head.indexOf(name)])));
}

// Types the text of a scene, in place of what is there.
const type = (page, text) => page.evaluate((text) => {
  const area = document.getElementById("area");
  area.value = text;
  area.dispatchEvent(new Event("input"));
}, text);

async function slide(page, name, thousandths, end = true) {
  await page.evaluate((name, thousandths, end) => {
    const slider = document.querySelector(`[data-name="${CSS.escape(name)}"] input[type=range]`);
    slider.value = thousandths;
    slider.dispatchEvent(new Event("input"));
    if (end) slider.dispatchEvent(new Event("change"));
  }, name, thousandths, end);
}

const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];

// Milliseconds that the native program takes for Chetaev's, the vakonomic and the first removed motion, in two runs.
function nativeMilliseconds(scene) {
  const of = (formulation) => {
    const { stdout } = spawnSync(deltaq, ["solve", scene, "-f", formulation, "--format", "json"], { encoding: "utf8" });
    const { derive, compile, integrate } = JSON.parse(stdout).seconds;
    return 1000 * (derive + compile + integrate);
  };
  return ["chetaev", "vakonomic", "removed-constraint"].map(of).reduce((a, b) => a + b);
}

async function opening() {
  const size = statSync(file).size / 1e6;
  must(size <= LIMITS.megabytes, `${size.toFixed(2)} MB, at most ${LIMITS.megabytes}`);
  const [firsts, took] = [[], []];
  for (let i = 0; i < 3; i++) {
    const page = await open("about:blank", { alone: true, until: "body", features: LIVELY });
    const before = await processor(browser);
    await page.goto(link({ scene: "sledge" }), { waitUntil: "domcontentloaded" });
    await page.waitForFunction(() => window.explored?.first, { timeout: 60000 });
    took.push((await processor(browser)) - before);
    firsts.push(await page.evaluate(() => window.explored.first));
    await leave(page);
  }
  must(Math.min(...took) <= LIMITS.first, `the first motion takes ${took.map(Math.round)} ms of processor, at most ${LIMITS.first}`);
  said.push(`${size.toFixed(2)} MB; first motion after ${Math.min(...firsts).toFixed(0)} ms, ${Math.min(...took).toFixed(0)} ms of processor`);
}

async function sliders() {
  const page = await open(link({ scene: "sledge" }), { features: LIVELY });
  const before = await rows(page, "Chetaev");
  await after(page, () => slide(page, "phi'", 800));
  const moved = await rows(page, "Chetaev");
  must(Math.abs(moved.at(-1)[3] - before.at(-1)[3]) > 1, "a slider changes nothing");
  // a hand on a slider: for thirty updates while the browser still compiles, and for sixty more
  const hand = (updates) => page.evaluate(async (updates) => {
    const slider = document.querySelector('[data-name="alpha"] input[type=range]');
    const [took, from, began] = [[], window.explored.drawn, performance.now()];
    for (let i = 0; window.explored.drawn < from + updates && performance.now() - began < 30000; i++) {
      slider.value = 300 + 200 * Math.sin(i / 20);
      slider.dispatchEvent(new Event("input"));
      await new Promise(requestAnimationFrame);
      took.push(window.explored.milliseconds);
    }
    return [window.explored.drawn - from, (performance.now() - began) / 1000, took];
  }, updates);
  const [, , cold] = await hand(30);
  const before_hand = await processor(browser);
  const [updates, seconds, took] = await hand(60);
  const each = ((await processor(browser)) - before_hand) / updates;
  must(each <= LIMITS.update, `${updates} updates take ${each.toFixed(1)} ms of processor each, at most ${LIMITS.update}`);
  said.push(`sledge ${median(took).toFixed(1)} ms (least ${Math.min(...took).toFixed(1)}, in the first seconds ${median(cold).toFixed(1)}), ${(updates / seconds).toFixed(0)} updates a second of ${each.toFixed(1)} ms of processor, native in two runs ${nativeMilliseconds("sledge").toFixed(1)} ms`);
  await page.keyboard.press("Escape");
  await page.focus("#stage");
  const label = () => page.$eval("#play", (button) => button.getAttribute("aria-label"));
  const was = await label();
  await page.keyboard.press("Space");
  must((await label()) !== was, "the space bar does nothing");
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  must((await page.$eval("#reading", (reading) => reading.textContent)) === "t = 0.10 s", "the arrow does not step");
  await leave(page);

  const cone = await open(link({ scene: "ball-in-cone" }), { features: LIVELY });
  const [times, turns] = [[], []];
  for (let i = 0; i < 8; i++) {
    const began = await processor(browser);
    const { drawn } = await cone.evaluate(() => ({ drawn: window.explored.drawn }));
    await slide(cone, "alpha", 320 + i, false);
    await cone.waitForFunction((drawn) => window.explored.drawn > drawn, {}, drawn);
    times.push(await cone.evaluate(() => window.explored.milliseconds));
    turns.push((await processor(browser)) - began);
  }
  must(Math.min(...turns) <= LIMITS.cone, `the cone takes ${turns.map(Math.round)} ms of processor, at most ${LIMITS.cone}`);
  const native = nativeMilliseconds("ball-in-cone").toFixed(1);
  said.push(`cone ${median(times).toFixed(1)} ms (least ${Math.min(...times).toFixed(1)}; ${Math.min(...turns).toFixed(1)} of processor), native in two runs ${native} ms`);
  // κ brings its motion
  await slide(cone, "kappa", 500);
  await cone.waitForFunction(() => window.explored.answer.motions.some(({ formulation }) => formulation === "kappa"));
  await leave(cone);
}

// Two fingers make it larger.
async function fingers() {
  const page = await open(link({ scene: "ball-in-cone", time: 3 }), { width: 400, height: 860 });
  const picture = () => page.$eval("#stage", (canvas) => canvas.toDataURL());
  const [before, { x, y }] = [await picture(), await (await page.$("#stage")).boundingBox()];
  const client = await page.createCDPSession();
  const touch = (type, ...places) => client.send("Input.dispatchTouchEvent", { type, touchPoints: places.map((at, id) => ({ x: x + at, y: y + 80, id })) });
  await touch("touchStart", 100, 140);
  for (let i = 1; i <= 5; i++) await touch("touchMove", 100 - 10 * i, 140 + 10 * i);
  await touch("touchEnd");
  await page.evaluate(() => new Promise(requestAnimationFrame));
  must((await picture()) !== before, "two fingers change nothing");
  await page.screenshot({ path: join(pictures, "fingers.png") });
  await leave(page);
}

// A text of one's own has the numbers of the native program, a faulty one its message, a link all of it.
async function ownText() {
  const page = await open(link({ scene: "disc", tab: "text" }));
  await after(page, () => type(page, OWN));
  must((await page.title()).startsWith("Skate"), "a text of one's own is not read");
  let largest = 0;
  for (const [label, formulation] of [["Chetaev", "chetaev"], ["vakonomic", "vakonomic"]]) {
    const ours = (await rows(page, label)).filter((_, i) => i % 16 === 0);
    const theirs = native(OWN, formulation, ours.map(([t]) => t));
    const differences = ours.map((row, i) => Math.max(...row.map((x, j) => Math.abs(x - theirs[i][j]))));
    must(theirs.length === ours.length && ours.length > 20, `${theirs.length} native rows`);
    largest = Math.max(largest, ...differences);
  }
  must(largest <= LIMITS.difference, `native numbers differ by ${largest}, at most ${LIMITS.difference}`);
  said.push(`numbers as native to ${largest.toExponential(1)}`);

  await after(page, () => slide(page, "phi", 700));
  await page.waitForFunction(() => location.hash.length > 300);
  await new Promise((resolve) => setTimeout(resolve, 400));
  const twin = await open(await page.evaluate(() => location.href));
  const [here, there] = [await rows(page, "vakonomic"), await rows(twin, "vakonomic")];
  must(JSON.stringify(here) === JSON.stringify(there) && here[0][3] !== 0.1, "a link does not bring the motion back");
  must(await twin.$eval("#text", (panel) => !panel.hidden), "a link does not bring the panel back");
  await leave(twin);

  // what a text says is shown as it stands there
  const marked = OWN.replace('x = { unit = "m"', 'x = { unit = "<i>m</i>"') + `[observables]\n'<i>"sum"</i>' = "x + y"\n`;
  await after(page, () => type(page, marked));
  const units = await page.$$eval("[data-name=x] small, #curve option", (all) => all.map(({ textContent }) => textContent));
  must(units.includes("<i>m</i>") && units.includes(`<i>"sum"</i>`), `marks in names and units: ${units}`);
  must((await page.$$("#numbers i, #curve i")).length === 0, "names or units are taken for elements");

  const broken = OWN.replace("y'*cos(phi)", "y'*cos(phj)").replace("duration = 3", "duratoin = 3");
  await type(page, broken);
  await page.waitForSelector("#faults:not([hidden])");
  const message = await page.$eval("#faults", (faults) => faults.dataset.message);
  const { stderr } = spawnSync(deltaq, ["solve", "-", "--formulation", "chetaev"], { input: broken, encoding: "utf8" });
  must(stderr.trim().replaceAll("stdin:", "own:") === `deltaq: ${message}`, `message:\n${message}\nnative:\n${stderr}`);
  must((await page.$$("#marks .bad")).length > 0, "no line is marked");
  await page.screenshot({ path: join(pictures, "broken.png") });
  await leave(page);
}

async function looks() {
  const looks = [["light", "light", { width: 1280, height: 900 }], ["dark", "dark", { width: 1280, height: 900 }], ["phone", "light", { width: 400, height: 860 }]];
  const tabs = { sledge: "numbers", disc: "verdict", "ball-in-cone": "equations", turntable: "text", trailer: "numbers" };
  for (const [scene, tab] of Object.entries(tabs)) {
    const page = await open(link({ scene, tab, time: 3 }));
    if (tab === "equations") await page.waitForSelector("#equations .formula");
    for (const [name, scheme, size] of looks) {
      await look(page, scheme);
      await resize(page, size);
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      must(width <= size.width, `${scene} is ${width} px wide on ${name}`);
      if (tab === "equations") {
        const longest = await page.$$eval(".formula", (formulas) => Math.max(...formulas.map(({ children }) => children.length)));
        must(longest > 3, `equations of ${scene} are not in pieces`);
      }
      await page.screenshot({ path: join(pictures, `${scene}-${name}.png`) });
    }
    await leave(page);
  }
}

// A browser that was never here.
const fresh = () => browser.createBrowserContext();

const tools = { browser, made: pages.made.bind(pages), open, leave, look, forget, fresh, link, must, after, choose, slide, type, rows, native, said, OWN, url, pictures, deltaq };
// tests without settings that only Chromium has; all scenes run in Chromium only, and here eachBody for a
// part of them
const ELSEWHERE = ["eachBody", "costates", "cleared", "refusals", "overlaps", "wayBack", "badLinks", "table", "tabs", "forces", "down", "camera", "differences",
  "runaway", "logarithms", "hand", "rolling", "halted", "curves", "newText", "bodies", "editor", "reviewed"];
// one that breaks off does not hide what the others find
const single = { everyScene, eachBody, ...checks, ...access, ...drawn, ...looking, ...hands, ...takes, ...further, ...first, editor, reviewed, robot, broken, tour, tasks };
const whole = (name, check) => () => check(tools).catch((error) => complaints.push(`${name}: ${error.stack}`));
const named = (names) => names.map((name) => whole(name, single[name]));

try {
  const grows = whole("growth", () => growth(tools, Number(what) || ROUNDS));
  // how fast frames come is no question for a machine that does other things as well
  const slows = whole("frames", () => frames(tools, SECONDS));
  const shown = named(Object.keys(single).filter((name) => name !== "eachBody"));
  const all = [opening, sliders, fingers, ownText, looks, ...shown, grows];
  const several = { all, numbers: [ownText], shown, elsewhere: [ownText, ...named(ELSEWHERE)], speed: [opening, sliders] };
  const parts = several[what] ?? (Number(what) ? [grows, slows] : what in single ? named([what]) : undefined);
  if (!parts) throw new Error(`${what} is none of ${[...Object.keys(several), ...Object.keys(single)].join(", ")}, nor a number of rounds`);
  for (const part of parts) await part();
} catch (error) {
  complaints.push(error.stack);
} finally {
  await browser.close();
  rmSync(userDataDir, { recursive: true, force: true, maxRetries: 5 });
}
if (what === "elsewhere") said.push(`${ELSEWHERE.length} checks in ${await browserName}`);
said.push(`${held} claims`);
console.log(said.join("; "));
if (complaints.length) {
  console.error([...new Set(complaints)].join("\n"));
  process.exit(1);
}
