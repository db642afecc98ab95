// What the page shows is what was computed: numbers, verdicts, pictures, refusals, and the way back.

import { join } from "node:path";

import { LIVELY, resize } from "./pages.test.mjs";

const SIZES = [[1280, 600], [400, 800], [1366, 657]];
const BOTH = { scene: "sledge", on: ["removed constraint (arc-length)", "removed constraint (along-x)"], time: 1 };

// A page is looked at in every size, one after the other; in the first two, a desk and a phone, where places are no matter.
const sizes = async (page, check, all = SIZES) => {
  for (const [width, height] of all) {
    await resize(page, { width, height });
    await check({ width, height }, `at ${width} × ${height}`);
  }
};

// Costates of the motions that are shown, of each removal; what is none of its constants is zero.
const used = (page) => page.evaluate(() => {
  const names = [...document.querySelectorAll("[data-motion] .row")].map((row) => row.dataset.name.split("@"));
  const motions = window.explored.answer.motions.map(({ label, constants }) => [label, constants]);
  const of = ([name, label]) => motions.filter(([other]) => other === label).map(([, constants]) => constants.find((constant) => constant.name === name)?.value ?? 0);
  return Object.fromEntries(names.flatMap(([name, label]) => of([name, label]).map((x) => [`${name}@${label}`, x])));
});
const rows = (page) => page.evaluate(() => Object.fromEntries([...document.querySelectorAll("[data-motion]:not([hidden]) .row")].map((row) =>
  [row.dataset.name, Number(row.querySelector("input[type=number]").value)])));
const set = (page, name, x) => page.evaluate((name, x) => {
  const number = document.querySelector(`[data-name="${CSS.escape(name)}"] input[type=number]`);
  number.value = x;
  number.dispatchEvent(new Event("change"));
}, name, x);
const ends = (page) => page.evaluate(() => Object.fromEntries(window.explored.samples.motions.map((motion) =>
  [motion.label, motion.value(motion.rows - 1, motion.columns.coordinate.x)])));
const kept = (page) => page.evaluate(async () => {
  await new Promise((resolve) => setTimeout(resolve, 400));
  const base64 = location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/");
  return JSON.parse(atob(base64)).set ?? {};
});
const near = (a, b) => Math.abs(a - b) <= 1e-5 * Math.max(1, Math.abs(b));

// A slider shows the number that is used, and touching it at its own value moves nothing.
export async function costates({ open, leave, link, must, after }) {
  const page = await open(link(BOTH));
  const [computed, before] = [await used(page), await rows(page)];
  must(Object.values(computed).some((x) => Math.abs(x - 38.2019394) < 1e-6), `no costate is 38.2019394: ${JSON.stringify(computed)}`);
  must(Object.keys(computed).length === 3 && Object.keys(before).length === 3, `${Object.keys(before)} are shown, ${Object.keys(computed)} used`);
  for (const [name, x] of Object.entries(computed)) must(near(before[name], x), `${name}: ${before[name]} shown, ${x} used`);
  const [name] = Object.keys(before);
  const was = await ends(page);
  await after(page, () => set(page, name, computed[name]));
  const now = await ends(page);
  for (const [label, x] of Object.entries(was)) must(Math.abs(now[label] - x) < 1e-4, `touching ${name} moves ${label} from ${x} to ${now[label]}`);
  const touched = Object.keys(await kept(page));
  must(touched.every((other) => other.endsWith(name.split("@")[1])), `touching ${name} sets ${touched}`);
  await after(page, () => page.evaluate((name) => document.querySelector(`[data-name="${CSS.escape(name)}"] .plain`).click(), name));
  must(Object.keys(await kept(page)).length === 0, `↺ leaves ${JSON.stringify(await kept(page))} in the address`);
  await after(page, () => set(page, "phi", 0.5));
  must(JSON.stringify(await kept(page)) === '{"phi":0.5}', `one number sets ${JSON.stringify(await kept(page))}`);
  await after(page, () => set(page, name, 3));
  await after(page, () => page.$eval("#all", (all) => all.click()));
  const end = await ends(page);
  must(JSON.stringify(await kept(page)) === "{}" && Object.entries(was).every(([label, x]) => end[label] === x), "not all is as in the text");
  for (const [other, x] of Object.entries(await used(page))) must(near((await rows(page))[other], x), `${other} is not shown as used`);
  await leave(page);
}

// A new scene, and a new number, stand under nothing that is older.
export async function cleared({ open, leave, link, must, slide, choose }) {
  const seen = (page) => page.evaluate(() => {
    const of = (id) => document.getElementById(id);
    const hidden = (id) => getComputedStyle(of(id)).visibility === "hidden";
    const busy = ["view", "graph", "verdict", "equations"].map((id) => of(id).getAttribute("aria-busy"));
    return { words: of("verdict").textContent + of("equations").textContent, title: of("title").textContent, stage: hidden("stage"), plot: hidden("plot"), busy };
  });
  const page = await open(link({ scene: "sledge", tab: "verdict", time: 1 }));
  await sizes(page, async (size, at) => {
    await page.waitForFunction(() => document.getElementById("equations").textContent);
    await slide(page, "phi", 700, false);
    must((await page.$eval("#verdict", (panel) => panel.textContent + panel.getAttribute("aria-busy"))) === "true", `a number moves, the verdict stays ${at}`);
    await page.waitForFunction(() => document.getElementById("equations").textContent);
    const before = await seen(page);
    must(before.words && !before.stage && before.busy.every((busy) => busy !== "true"), `not at rest: ${JSON.stringify(before.busy)} ${at}`);
    const at_once = await page.evaluate(() => {
      const select = document.getElementById("scene");
      select.value = "bicycle";
      select.dispatchEvent(new Event("change"));
      return [document.getElementById("verdict").textContent, document.getElementById("view").getAttribute("aria-busy")];
    });
    must(at_once[0] === "" && at_once[1] === "true", `a verdict stays: ${at_once} ${at}`);
    const fresh = await seen(page);
    must(fresh.words === "" && (fresh.stage || fresh.title.includes("icycle")), `the old picture stays ${at}`);
    await choose(page, "sledge");
  }, SIZES.slice(0, 2));
  // what runs long says so, and is stopped
  await choose(page, "bicycle");
  await page.waitForSelector("#deciding:not([hidden])", { timeout: 60000 });
  must((await seen(page)).busy[2] === "true", "a decision does not say that it runs");
  await page.click("#undecided");
  await page.waitForFunction(() => document.getElementById("verdict").textContent === "The decision was stopped.", { timeout: 5000 });
  const over = page.waitForSelector("#deciding", { hidden: true, timeout: 20000 });
  must(await over.then(() => true, () => false), "a stopped decision runs on");
  await leave(page);
}

// A number that is refused ends the motion that was shown, and it is said why.
export async function refusals({ open, leave, link, must, after, type, OWN }) {
  const page = await open(link({ scene: "sledge" }), { features: LIVELY });
  await sizes(page, async (size, at) => {
    for (const [name, x, words] of [["duration", -1, "duration"], ["k", 0, ""]]) {
      await set(page, name, x);
      await page.waitForSelector("#refused:not([hidden])", { timeout: 20000 });
      const { message, box, playing, hidden } = await page.evaluate(() => {
        const element = document.getElementById("refused");
        element.scrollIntoView();
        const { top, bottom, width } = element.getBoundingClientRect();
        const playing = document.getElementById("play").getAttribute("aria-label") === "pause";
        const hidden = getComputedStyle(document.getElementById("stage")).visibility === "hidden";
        return { message: element.textContent, box: [top, bottom, width], playing, hidden };
      });
      must(message.includes(words) && message.length > 10, `refused without a word: ${message} ${at}`);
      must(!playing && hidden, `the old motion plays on ${at}`);
      must(box[0] >= 0 && box[1] <= size.height + 1 && box[2] > 100, `the message is not seen: ${box} ${at}`);
      await after(page, () => page.$eval("#all", (all) => all.click()));
      must(await page.$eval("#refused", (element) => element.hidden), `a refusal stays ${at}`);
    }
  });
  await leave(page);
}

// No part lies over another one, and nothing is wider than the window.
export async function overlaps({ open, leave, link, must, pictures }) {
  for (const scene of ["sledge", "trailer", "ball-in-cone"]) {
    const page = await open(link({ scene, time: 1 }));
    await sizes(page, async (size, at) => {
      const wrong = await page.evaluate(() => {
        const boxes = ["title", "legend", "frame", "clock", "said", "graph"].map((id) => [id, document.getElementById(id).getBoundingClientRect()]);
        const over = boxes.flatMap(([one, a], i) => boxes.slice(i + 1).filter(([, b]) => b.top < a.bottom - 1 && b.height > 0).map(([two]) => `${two} over ${one}`));
        return [...over, ...(document.documentElement.scrollWidth > innerWidth ? ["too wide"] : [])];
      });
      must(wrong.length === 0, `${scene}: ${wrong.join(", ")} ${at}`);
      await page.screenshot({ path: join(pictures, `${scene}-${size.width}x${size.height}.png`) });
    });
    await leave(page);
  }
}

// A text of one's own is there again after another scene, and the way back leads to it.
export async function wayBack({ open, leave, link, must, after, choose, type, OWN }) {
  const page = await open(link({ scene: "disc", tab: "text" }));
  await after(page, () => type(page, OWN));
  await choose(page, "sledge");
  must(!(await page.$eval("#area", (area) => area.value)).includes("Skate"), "the scene that was chosen has no text");
  await choose(page, "own");
  must((await page.$eval("#area", (area) => area.value)) === OWN, "a text of one's own is lost on choosing another scene");
  const back = async (words) => {
    await after(page, () => page.evaluate(() => history.back()));
    must((await page.title()).includes(words), `the way back leads to ${await page.title()}, not to ${words}`);
  };
  await back("sledge");
  await back("Skate");
  must((await page.$eval("#area", (area) => area.value)) === OWN, "the way back loses a text");
  await back("isc");
  await leave(page);
}

// A link that cannot be read is said to be one, and stays what it is, until something is chosen.
export async function badLinks({ open, leave, link, must, choose, url }) {
  const cut = link({ scene: "disc", set: { g: 2 } }).slice(0, -3);
  for (const address of [cut, `${url}#5`, `${url}#${Buffer.from("5").toString("base64url")}`, link({ scene: "nowhere" }), link({ scene: "disc", set: { g: "x" } })]) {
    const page = await open(address);
    // the address would be written a quarter of a second after something was chosen
    await new Promise((resolve) => setTimeout(resolve, 400));
    must((await page.$eval("#notice:not([hidden])", (notice) => notice.textContent).catch(() => "")).includes("cannot be read"), `nothing is said of ${address.slice(url.length)}`);
    must(page.url() === address, "the address of a link that cannot be read is written over");
    await choose(page, "velocity-pendulum");
    must(await page.$eval("#notice", (notice) => notice.hidden), "a notice stays");
    await leave(page);
  }
}

// Names of a text may be those of what every object has; a number that is set goes with its name; of scripts only that of
// the page runs, and nothing is fetched.
export async function names({ open, link, must, slide, type, after, OWN }) {
  const named = OWN.replace("[coordinates]", "[parameters]\nconstructor = 1\n__proto__ = 0.5\ntoString = 0.6\n[coordinates]")
    .replace("0.3*x", "constructor*toString*__proto__*x");
  const page = await open(link({ scene: "own", text: named }));
  const labels = await page.$$eval("#numbers label", (all) => all.map(({ textContent }) => textContent));
  must(["constructor", "toString"].every((name) => labels.includes(name)), `parameters are called ${labels}`);
  for (const name of ["__proto__", "constructor"]) {
    const before = await page.evaluate(() => window.explored.samples.motions[0].numbers.at(-1));
    await after(page, () => slide(page, name, 900));
    must((await page.evaluate(() => window.explored.samples.motions[0].numbers.at(-1))) !== before, `the slider of ${name} changes nothing`);
  }
  await page.waitForFunction(() => location.hash.includes("__") || location.hash.length > 100);
  await after(page, () => type(page, named.replaceAll("constructor", "push")));
  must(await page.$eval("#faults", (faults) => faults.hidden), "a text without a name that was set is refused");
  must((await page.$eval("#notice", ({ textContent }) => textContent)).includes("constructor"), "it is not said which name is gone");
  // the browser says what it does not run
  page.removeAllListeners("console");
  const ran = await page.evaluate(async () => {
    const script = document.createElement("script");
    script.textContent = "window.foreign = true";
    document.body.append(script);
    const fetched = await fetch("https://example.com/").then(() => true, () => false);
    return [window.foreign ?? false, fetched, document.querySelector("[http-equiv=Content-Security-Policy]").content.includes("sha256-")];
  });
  must(JSON.stringify(ran) === "[false,false,true]", `foreign scripts and addresses: ${ran}`);
  await page.close();
}

// The table has every pair with the verdict that was decided, from when and by how much, in units; and one sentence of why.
export async function table({ open, leave, link, must, pictures }) {
  for (const [state, verdicts] of [[{ scene: "sledge" }, ["different", "different", "different"]], [{ scene: "velocity-pendulum" }, ["same", "same", "same"]]]) {
    const page = await open(link({ ...state, tab: "verdict" }));
    const { pairs, sentence } = await page.evaluate(() => window.decided);
    const seen = await page.evaluate(() => [...document.querySelectorAll("#verdict tbody tr")].map((row) => [...row.children].map(({ innerText }) => innerText)));
    must(pairs.length === verdicts.length && seen.length === pairs.length, `${seen.length} rows of ${pairs.length} pairs`);
    for (const [i, [names, verdict, from, by]] of seen.entries()) {
      const pair = pairs[i];
      must(pair.verdict === verdicts[i], `${state.scene}: ${names} is ${pair.verdict}`);
      must(names === `${pair.first} – ${pair.second}`, `a row is called ${names}`);
      must(verdict.includes(pair.verdict === "same" ? "the same" : pair.verdict), `${names} is said to be ${verdict}`);
      if (pair.verdict === "different") {
        must(Math.abs(parseFloat(from) / pair.visible - 1) < 0.01 && from.endsWith(" s"), `${names}: from ${from}, not ${pair.visible}`);
        const largest = Math.max(...pair.coordinates.filter(({ unit }) => unit === "m").map(({ by }) => by));
        const metres = /([\d.e-]+) m$/m.exec(by)?.[1];
        must(Math.abs(metres / largest - 1) < 0.01, `${names}: by ${by}, not ${largest} m`);
      } else {
        must(from === "–" && by === "–", `${names}: ${from}, ${by} of motions that are the same`);
      }
    }
    must(sentence.includes(verdicts[0] === "same" ? "are the same because" : "diverge because"), `why: ${sentence}`);
    must((await page.$eval("#verdict .sentence", ({ textContent }) => textContent)) === sentence, "the sentence is not shown");
    must((await page.$eval("#said", ({ textContent }) => textContent)) === sentence, "the sentence is not below the picture");
    await page.screenshot({ path: join(pictures, `table-${state.scene}.png`) });
    await leave(page);
  }
  // what was hidden in hints is text
  const page = await open(link({ scene: "sledge", on: ["removed constraint (along-x)"], tab: "verdict" }));
  const words = await page.$eval("#verdict", ({ innerText }) => innerText);
  const { notes, causes } = await page.evaluate(() => ({
    notes: window.explored.scenes.find(({ name }) => name === "sledge").text.match(/^notes = "(.*)"$/m)[1],
    causes: window.explored.answer.motions.map((motion) => motion.refused ?? motion.cause).filter(Boolean),
  }));
  must(causes.length > 0, "no motion ends early");
  for (const text of [notes, ...causes]) must(words.includes(text), `is not to be read: ${text}`);
  must(!(await page.$("#title[title], #legend [title]")), "something is said in a hint only");
  await leave(page);
}
