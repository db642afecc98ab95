// Ten things that people come for, each done by keys alone, and timed.

import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

// The tab key leads to what is looked for, as it does for everybody.
async function go(page, selector) {
  for (let i = 0; i < 120; i++) {
    if (await page.evaluate((selector) => document.activeElement.matches(selector), selector)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`the tab key does not lead to ${selector}`);
}

async function press(page, selector, key = "Enter") {
  await go(page, selector);
  await page.keyboard.press(key);
}

// A scene by the first word of its title, typed where scenes are chosen.
async function scene(page, word, title = word) {
  await go(page, "#scene");
  // what was typed a second ago still counts in a list
  await new Promise((resolve) => setTimeout(resolve, 1200));
  await page.keyboard.type(word);
  await page.waitForFunction((title) => document.title.startsWith(title) && !document.querySelector(".void"), { timeout: 60000 }, title);
}

async function panel(page, name) {
  await go(page, "[role=tab][tabindex='0']");
  for (let i = 0; i < 12 && (await page.evaluate(() => document.activeElement.dataset.tab)) !== name; i++) await page.keyboard.press("ArrowRight");
}

const decidedAnew = (page) => page.waitForFunction(() => document.getElementById("verdict").getAttribute("aria-busy") === "false" && document.getElementById("verdict").textContent, { timeout: 60000 });

const TASKS = {
  async "what is compared"(page) {
    const names = await page.$$eval("#legend label", (all) => all.map((label) => label.innerText.trim()));
    await press(page, "#legend label:nth-child(2) input", "Space");
    await page.waitForFunction(() => window.explored.answer.motions.every(({ label }) => label !== "vakonomic"), { timeout: 20000 });
    return names.includes("Chetaev") && names.includes("vakonomic");
  },
  async "which formulation nature follows"(page) {
    await panel(page, "tour");
    for (let step = 1; step < 5; step++) await press(page, "#next");
    await press(page, "[data-answer='0']");
    await page.waitForFunction(() => document.querySelector("#tour .reveal").textContent.includes("friction chooses Chetaev"), { timeout: 60000 });
    return true;
  },
  async "a link to this state"(page) {
    await press(page, "[data-name=phi] input[type=range]", "ArrowRight");
    await press(page, "#link");
    await page.waitForFunction(() => document.getElementById("link").textContent !== "Copy link", { timeout: 5000 });
    return page.evaluate(() => location.hash.length > 20);
  },
  async "the curve taken along"(page, folder) {
    await press(page, "#take");
    await press(page, "[data-take=csv]");
    for (let i = 0; i < 50 && !existsSync(join(folder, "sledge.csv")); i++) await new Promise((resolve) => setTimeout(resolve, 100));
    return readdirSync(folder).includes("sledge.csv") && readFileSync(join(folder, "sledge.csv"), "utf8").startsWith("motion,t,x,y,phi");
  },
  async "a system of one's own"(page) {
    await panel(page, "text");
    await go(page, "#area");
    await page.keyboard.down("Control");
    await page.keyboard.press("Home");
    await page.keyboard.up("Control");
    for (let i = 0; i < 9; i++) await page.keyboard.press("ArrowRight");
    await page.keyboard.type("My ");
    await page.waitForFunction(() => document.title.startsWith("My Ice sledge"), { timeout: 20000 });
    return true;
  },
  async "is the disc's vakonomic motion Chetaev's"(page) {
    await scene(page, "Upright");
    await panel(page, "verdict");
    await decidedAnew(page);
    return /Is the motion of Chetaev one of vakonomic\?\s*For μ₀ = \(-?[\d.]+, -?[\d.]+\)/.test(await page.$eval("#verdict", ({ innerText }) => innerText));
  },
  async "the view turned"(page) {
    await go(page, "#stage");
    const before = await page.$eval("#stage", (canvas) => canvas.toDataURL());
    await page.keyboard.press("a");
    return before !== (await page.$eval("#stage", (canvas) => canvas.toDataURL()));
  },
  async "the reaction force"(page) {
    await press(page, "#forces", "Space");
    await page.waitForFunction(() => /Chetaev: speed [\d.]+ m\/s, reaction [\d.]+ N/.test(document.getElementById("key").textContent), { timeout: 20000 });
    return true;
  },
  async "a long computation stopped"(page) {
    await scene(page, "Carvallo");
    await page.waitForSelector("#deciding:not([hidden])", { timeout: 60000 });
    await press(page, "#undecided");
    await page.waitForFunction(() => document.getElementById("verdict").textContent === "The decision was stopped.", { timeout: 5000 });
    return true;
  },
  async "a text found again"(page) {
    await panel(page, "text");
    await go(page, "#area");
    await page.keyboard.type("# mine\n");
    await page.waitForFunction(() => document.getElementById("scene").value === "own", { timeout: 20000 });
    await scene(page, "Upright");
    await scene(page, "own", "Ice sledge");
    return (await page.$eval("#area", ({ value }) => value)).includes("# mine");
  },
};

export async function tasks({ open, leave, forget, fresh, link, must, said }) {
  const [folder, times] = [mkdtempSync(join(tmpdir(), "tasks-")), []];
  const context = await fresh();
  for (const [name, task] of Object.entries(TASKS)) {
    const page = await open(link({ scene: "sledge", time: 1 }), { context });
    const client = await page.createCDPSession();
    await client.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder, browserContextId: context.id });
    const began = performance.now();
    must(await task(page, folder).catch((error) => must(false, `${name}: ${error.message}`)), `by keys: ${name}`);
    times.push(`${name} ${((performance.now() - began) / 1000).toFixed(1)} s`);
    await client.detach();
    await leave(page);
  }
  await forget(context);
  rmSync(folder, { recursive: true, force: true });
  said.push(`ten tasks by keys: ${times.join(", ")}`);
}
