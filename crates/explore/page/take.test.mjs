// What is taken along is what was computed; what was done can be undone; texts are kept.

import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { taken } from "./pages.test.mjs";

const LABELS = ["Chetaev", "vakonomic", "removed constraint (arc-length)"];

export async function files({ open, leave, link, must, deltaq }) {
  const page = await open(link({ scene: "sledge", set: { phi: 0.5, "P0_y@removed constraint (arc-length)": 0.25 }, time: 2 }));
  const kinds = ["png", "svg", "curves", "csv", "latex", "python", "toml"];
  const files = await taken(page, kinds);
  const text = (kind) => files[kind].bytes.toString("utf8");
  const names = kinds.map((kind) => files[kind].name);
  must(names.join() === "sledge.png,sledge.svg,sledge-curves.png,sledge.csv,sledge.tex,sledge.py,sledge.toml", `files are ${names}`);
  for (const kind of ["png", "curves"]) {
    must(files[kind].bytes.subarray(1, 4).toString() === "PNG" && files[kind].bytes.length > 2000, `${kind} is no picture`);
  }
  const [faulty, paths] = await page.evaluate((text) => {
    const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
    return [parsed.querySelector("parsererror") !== null, parsed.querySelectorAll("path").length];
  }, text("svg"));
  must(!faulty && paths > 10, `the SVG has ${paths} paths, faulty: ${faulty}`);

  const [head, ...lines] = text("csv").trim().split("\n").map((line) => line.split(","));
  must(head.slice(0, 8).join() === "motion,t,x,y,phi,x',y',phi'", `CSV begins with ${head}`);
  const numbers = await page.evaluate(() => window.explored.samples.motions.map((motion) => {
    const row = motion.rows >> 1;
    return [motion.rows, motion.label, motion.time(row), ...Object.values(motion.columns.coordinate).map((place) => motion.value(row, place))];
  }));
  let at = 0;
  for (const [count, ...row] of numbers) {
    must(lines[at + (count >> 1)].slice(0, 5).join() === row.map(String).join(), `CSV: ${lines[at + (count >> 1)]}, not ${row}`);
    at += count;
  }
  must(at === lines.length && lines.every((line) => line.length === head.length), `CSV has ${lines.length} rows of ${at}`);

  // the scene with the number in it has the motion that is shown, in the native program
  const [, , time, ...q] = numbers[0];
  const words = ["solve", "-", "--formulation", "chetaev", "--format", "csv", "--times", String(time)];
  const native = execFileSync(deltaq, words, { input: text("toml"), encoding: "utf8" }).trim().split("\n").filter((line) => !line.startsWith("#"));
  const of = (name) => Number(native[1].split(",")[native[0].split(",").indexOf(name)]);
  const off = Math.max(...["x", "y", "phi"].map((name, i) => Math.abs(of(name) - q[i])));
  must(off < 1e-9, `the scene that was taken has another motion, by ${off}`);

  const depth = [...text("latex").matchAll(/\\left|\\right|(?<!\\)[{}]/g)].reduce((sum, [token]) => sum + ({ "{": 1, "}": -1 }[token] ?? 0), 0);
  must(depth === 0 && text("latex").includes("\\ddot{x}") && text("latex").includes("\\end{document}"), `LaTeX, braces ${depth}:\n${text("latex").slice(0, 300)}`);
  for (const label of LABELS) must(text("latex").includes(`\\section*{${label}}`), `LaTeX has no ${label}`);

  const script = text("python");
  execFileSync("python3", ["-c", "import sys; compile(sys.stdin.read(), 'script', 'exec')"], { input: script });
  for (const part of ['"phi": 0.5', 'solve("vakonomic")', 'solve("removed-constraint", removal="arc-length", constants=[', "0.25]"]) must(script.includes(part), `the script lacks ${part}:\n${script}`);
  await leave(page);
}

// The page that is saved opens with what was chosen, from another place on the disk.
export async function savedPage({ open, leave, link, must }) {
  const state = { scene: "sledge", set: { phi: 0.5 }, off: ["vakonomic"], time: 2, tab: "verdict" };
  const page = await open(link(state));
  const numbers = (page) => page.evaluate(() => window.explored.samples.motions.map((motion) => [motion.label, ...motion.track(motion.rows - 1)].join()).join(" "));
  const { page: saved } = await taken(page, ["page"]);
  const folder = mkdtempSync(join(tmpdir(), "saved-"));
  writeFileSync(join(folder, "other.html"), saved.bytes);
  const other = await open(pathToFileURL(join(folder, "other.html")).href);
  must((await numbers(other)) === (await numbers(page)), "a page that was saved has other motions");
  must((await other.$eval("#reading", ({ textContent }) => textContent)) === "t = 2.00 s" && await other.$eval("#verdict", ({ hidden }) => !hidden), "a page that was saved opens elsewhere");
  await leave(other);
  await leave(page);
  rmSync(folder, { recursive: true, force: true });
}

// For slides: the stage alone, in motion.
export async function onlyStage({ open, leave, url, must, pictures }) {
  const page = await open(`${url}#scene=sledge&only=stage`, { width: 800, height: 500 });
  const seen = await page.evaluate(() => ["header", "#side", "#graph", "#stage", "#play"].map((name) => document.querySelector(name).checkVisibility()).join());
  must(seen === "false,false,false,true,true", `only the stage is to be seen: ${seen}`);
  const { height, bottom } = await page.evaluate(() => ({ height: document.getElementById("stage").clientHeight, bottom: document.documentElement.scrollHeight }));
  must(height > 250 && bottom <= 501, `the stage is ${height} px high, the slide ${bottom}`);
  await page.screenshot({ path: join(pictures, "only-stage.png") });
  await leave(page);
}

// Undo takes back one change of a number, whatever was moved on the way, and the time goes on; redo brings it again.
export async function undo({ open, leave, link, must, after, slide, choose }) {
  const page = await open(link({ scene: "sledge", time: 3 }));
  const value = () => page.$eval("[data-name=phi] input[type=number]", ({ value }) => Number(value));
  const enabled = () => page.evaluate(() => ["undo", "redo"].map((id) => !document.getElementById(id).disabled).join());
  const first = await value();
  must((await enabled()) === "false,false", "there is something to be undone before anything was done");
  for (const part of [600, 650, 690]) await slide(page, "phi", part, false);
  await after(page, () => slide(page, "phi", 700));
  const second = await value();
  await after(page, () => slide(page, "phi", 300));
  const third = await value();
  const time = await page.$eval("#reading", ({ textContent }) => textContent);
  const press = (id) => after(page, () => page.click(`#${id}`));
  await press("undo");
  must((await value()) === second, `undo leads from ${third} to ${await value()}, not to ${second}`);
  must((await page.$eval("#reading", ({ textContent }) => textContent)) === time, "undo sets the time back");
  await press("undo");
  must((await value()) === first && (await enabled()) === "false,true", `undo leads to ${await value()}, not to ${first}`);
  await press("redo");
  must((await value()) === second, `redo leads to ${await value()}, not to ${second}`);
  await choose(page, "disc");
  await press("undo");
  must((await value()) === second && (await page.title()).includes("sledge"), "undo does not lead back to a scene");
  // what was chosen a moment before is not lost
  await page.click("[data-tab=verdict]");
  await after(page, () => slide(page, "phi", 400));
  await press("undo");
  must(await page.$eval("#verdict", ({ hidden }) => !hidden), "undo takes back a panel, too");
  await leave(page);
}

// A text is kept in the browser under its title, chosen from the list on another visit, and forgotten.
export async function keeps({ open, leave, forget, fresh, link, must, after, type, choose, OWN }) {
  const context = await fresh();
  const page = await open(link({ scene: "disc", tab: "text" }), { context });
  must(await page.$eval("#keep", ({ hidden }) => hidden), "a built-in scene can be kept");
  await after(page, () => type(page, OWN));
  await page.waitForSelector("#keep:not([hidden])");
  await page.click("#keep");
  await leave(page);
  const later = await open(link({ scene: "sledge" }), { context });
  await choose(later, "kept:Skate");
  must((await later.$eval("#area", ({ value }) => value)) === OWN, "a text that was kept is lost");
  await later.click("[data-tab=text]");
  must((await later.$eval("#keep", ({ textContent }) => textContent)).startsWith("Forget"), "a text that is kept cannot be forgotten");
  await later.click("#keep");
  must((await later.$("[value='kept:Skate']")) === null, "a text that was forgotten is there");
  await forget(context);
}
