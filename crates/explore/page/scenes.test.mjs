// Every built-in scene, each shown once: it moves, has something to hold, and its equations compile.

import katex from "katex";

import { taken } from "./pages.test.mjs";

const names = (page) => page.$$eval("#scene option:not([hidden])", (all) => all.map(({ value }) => value));

// Whether there is a motion, and what is drawn of it changes with time; it is at its start then. Rings are at the start only,
// so the two pictures have none.
const moves = (page) => page.evaluate(() => {
  const [canvas, bar, play] = ["stage", "bar", "play"].map((id) => document.getElementById(id));
  if (play.getAttribute("aria-label") === "pause") play.click();
  const at = (part) => {
    bar.value = part;
    bar.dispatchEvent(new Event("input"));
    return canvas.toDataURL();
  };
  const differ = at(0.3) !== at(0.6);
  at(0);
  return differ && window.explored.samples.motions.length > 0;
});

const KNOWN = new Set("alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi varphi chi psi omega Gamma Delta Theta Lambda Sigma Phi Psi Omega dot ddot frac sqrt left right cdot mathrm sin cos tan cot sec csc sinh cosh tanh arcsin arccos arctan exp log ln operatorname quad varepsilon partial to in ne le ge times infty text".split(" "));

// Equations compile: each piece of mathematics by KaTeX in its strict mode, with no command that LaTeX with amsmath lacks
// (those are put into `strange`); between them nothing stands that TeX takes for a command. How many pieces there are.
async function compiled(page, name, must, strange) {
  let count = 0;
  const { latex } = await taken(page, ["latex"]);
  const body = latex.bytes.toString("utf8").split("\\begin{document}")[1] ?? "";
  const pieces = body.split(/\\begin\{dmath\*\}\n([\s\S]*?)\n\\end\{dmath\*\}|\$([^$]+)\$/);
  for (const [i, piece] of pieces.entries()) {
    if (piece === undefined) continue;
    if (i % 3 === 0) {
      must(!/[\u0370-\u03ff]/.test(piece), `${name}: Greek that no font of text has in ${piece.slice(0, 60)}`);
      must(!/(?<!\\)[&%#_^~$]/.test(piece), `${name}: what is no mathematics has ${/.{0,20}(?<!\\)[&%#_^~$].{0,20}/.exec(piece)?.[0]}`);
      continue;
    }
    for (const [, word] of piece.matchAll(/\\([a-zA-Z]+)/g)) if (!KNOWN.has(word)) strange.add(word);
    try {
      katex.renderToString(piece, { throwOnError: true, strict: "error", output: "mathml" });
    } catch (error) {
      must(false, `${name}: ${error.message.slice(0, 200)}`);
    }
    count += 1;
  }
  must(pieces.length > 3, `${name} has no equations: ${body.slice(0, 100)}`);
  return count;
}

// There is something to hold, and a number for each ring that is there; no ring moves nothing. How many rings there are.
async function held(page, name, must) {
  await page.waitForFunction(() => window.explored.samples?.grips, { timeout: 20000 }).catch(() => must(false, `${name} has nothing to hold`));
  const [rings, nearest] = await page.evaluate(() => {
    const seen = [...document.querySelectorAll(".grip")].filter((grip) => grip.checkVisibility());
    const boxes = seen.map((grip) => grip.getBoundingClientRect());
    const apart = boxes.flatMap((a, i) => boxes.slice(i + 1).map((b) => Math.hypot(a.left - b.left, a.top - b.top)));
    return [seen.map(({ dataset }) => [dataset.grip, Object.keys(window.explored.grips.numbers(dataset.grip, [7, 5])).length]), Math.min(...apart)];
  });
  must(rings.length > 0, `${name} has no ring`);
  must(rings.length < 2 || nearest > 20, `${name}: rings are ${nearest} px apart`);
  for (const [kind, numbers] of rings) must(numbers > 0, `${name}: ${kind} moves nothing`);
  return rings.length;
}

// Every built-in scene, in one round.
export async function everyScene({ open, leave, url, must, choose, after, said }) {
  const page = await open(`${url}#scene=sledge`);
  const all = await names(page);
  must(all.length >= 40, `${all.length} scenes`);
  const strange = new Set();
  let [rings, pieces] = [0, 0];
  await after(page, () => page.click("#grips"));
  for (const name of all) {
    if (name !== "sledge") await choose(page, name);
    must(await moves(page), `${name} does not move`);
    rings += await held(page, name, must);
    pieces += await compiled(page, name, must, strange);
  }
  must(strange.size === 0, `commands that are not known to be LaTeX's: ${[...strange]}`);
  said.push(`${all.length} scenes move; ${rings} rings; ${pieces} pieces of LaTeX compile`);
  await leave(page);
}

// Of every shape of body, and every group of scenes, the first scene that has it moves.
export async function eachBody({ open, leave, url, must, choose, said }) {
  const page = await open(`${url}#scene=sledge`);
  const scenes = await page.evaluate(() => window.explored.scenes.map(({ name, group, text }) => [name, [group, ...text.match(/(?<=^shape = ")\w+/gm)]]));
  const seen = new Set();
  let count = 0;
  for (const [name, kinds] of scenes) {
    if (kinds.every((kind) => seen.has(kind))) continue;
    for (const kind of kinds) seen.add(kind);
    if (name !== "sledge") await choose(page, name);
    must(await moves(page), `${name} does not move`);
    count += 1;
  }
  must(seen.size >= 13, `only these are seen: ${[...seen]}`);
  said.push(`${count} scenes with every shape of body move`);
  await leave(page);
}
