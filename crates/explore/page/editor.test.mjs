// The editor: numbered lines, marks where faults and notes are, names completed by keys, functions and examples, bodies.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const text = (page) => page.$eval("#area", ({ value }) => value);
const settled = (page) => page.waitForFunction(() => document.getElementById("view").getAttribute("aria-busy") === "false" && document.getElementById("faults").hidden, { timeout: 60000 });
const offers = (page) => page.$$eval("#offers button", (all) => all.map(({ textContent }) => textContent));

// Puts the caret behind the first place of some words.
const behind = (page, words) => page.evaluate((words) => {
  const area = document.getElementById("area");
  area.focus();
  area.selectionStart = area.selectionEnd = area.value.indexOf(words) + words.length;
}, words);

export async function editor({ open, leave, link, must, type, after, deltaq, pictures, OWN }) {
  const page = await open(link({ scene: "sledge", tab: "text", time: 1 }));
  const sledge = await text(page);
  const count = await page.$eval("#marks", (marks) => [marks.children.length, getComputedStyle(marks.lastChild, "::before").content, getComputedStyle(marks.lastChild, "::before").counterIncrement]);
  must(count[0] === sledge.split("\n").length && count[1].includes("counter(line)") && count[2] === "line 1", `lines are numbered by ${count}`);
  const level = await page.evaluate(() => {
    const [area, marks] = ["area", "marks"].map((id) => document.getElementById(id));
    area.scrollTop = 60;
    area.dispatchEvent(new Event("scroll"));
    const inner = area.getBoundingClientRect().left;
    return [marks.scrollTop - area.scrollTop, Math.abs(inner - marks.getBoundingClientRect().left - 2.6 * 15) < 2, area.scrollHeight - marks.scrollHeight];
  });
  must(level[0] === 0 && level[1] && Math.abs(level[2]) < 20, `numbers do not go with the lines: ${level}`);

  // a word goes on by the tab key, which leaves the text when nothing is offered
  await behind(page, "sin(phi)");
  await page.keyboard.type("*al");
  must((await offers(page))[0] === "alpha", `al goes on with ${await offers(page)}`);
  await page.keyboard.press("Tab");
  must((await text(page)).includes("sin(phi)*alpha") && (await page.evaluate(() => document.activeElement.id)) === "area", "the tab key does not complete a name");
  await page.keyboard.type("*sq");
  must((await offers(page)).includes("sqrt("), `sq goes on with ${await offers(page)}`);
  await page.keyboard.press("Escape");
  must((await offers(page)).length === 0, "escape does not end what is offered");
  await page.keyboard.press("Tab");
  must((await page.evaluate(() => document.activeElement.id)) !== "area", "the tab key is caught in the text");
  await type(page, `${sledge}\n[observables]\n`);
  await behind(page, "[observables]\n");
  await page.keyboard.type("a = \"co");
  must((await offers(page)).includes("cos("), `co goes on with ${await offers(page)}`);
  await page.keyboard.type("n");
  must((await offers(page)).includes("constraints"), `con goes on with ${await offers(page)}`);
  await page.keyboard.type(" # gra");
  must((await offers(page)).length === 0, `in a comment is offered ${await offers(page)}`);

  // what is wrong is marked where it is; its message leads there
  await type(page, sledge.replace("cos(phi)", "cos(phj)"));
  await page.waitForSelector("#faults:not([hidden])");
  must((await page.$$eval("#marks .bad u", (all) => all.map(({ textContent }) => textContent))).join() === "phj", "the faulty word is not marked");
  await page.screenshot({ path: join(pictures, "editor-fault.png") });
  await page.click("#faults button");
  must((await page.$eval("#area", (area) => area.value.slice(area.selectionStart, area.selectionEnd))) === "phj", "a message does not lead to its place");

  // notes are those of the check
  const odd = sledge.replace("[coordinates]", "unused = 2.0\n[coordinates]");
  await type(page, odd);
  await page.waitForSelector("#notes:not([hidden])", { timeout: 60000 });
  const [note] = await page.$$eval("#notes li", (all) => all.map(({ textContent }) => textContent));
  const [, line, message] = /line (\d+), column \d+: (.*)/.exec(note);
  const said = execFileSync(deltaq, ["check", "-"], { input: odd, encoding: "utf8" });
  must(said.includes(message) && odd.split("\n")[line - 1] === "unused = 2.0", `the note is ${note}, that of the check:\n${said}`);
  must((await page.$$("#marks .note u")).length === 1, "a note is not marked");

  // every example makes a scene that can be read, and so does every function that is listed
  const names = await page.$$eval("#example option", (all) => all.map(({ value, textContent }) => [value, textContent]).slice(1));
  must(names.length >= 6 && names.some(([, name]) => name.includes("bodies")), `examples are ${names}`);
  for (const [value, name] of names) {
    await after(page, () => type(page, sledge));
    const before = await text(page);
    await after(page, () => page.select("#example", value));
    await settled(page);
    must((await text(page)) !== before && (await page.$eval("#refused", ({ hidden }) => hidden)), `${name} is refused`);
    if (name.includes("bodies")) await page.screenshot({ path: join(pictures, "editor-bodies.png") });
  }
  await page.$eval("#functions", (list) => (list.parentElement.open = true));
  const before = await text(page);
  await page.evaluate(() => document.getElementById("area").setSelectionRange(0, 0));
  await page.click("#functions button");
  must((await text(page)) === `sin(x)${before}`, "a function is not put where the caret is");
  await page.screenshot({ path: join(pictures, "editor-functions.png") });
  await leave(page);
}

// A scene of bodies that is typed in moves as natively, also with another mass and another parameter; a fault in a body has its line.
export async function robot({ open, leave, link, must, type, after, slide, rows, native, deltaq, pictures }) {
  const page = await open(link({ scene: "sledge", tab: "text", time: 1 }));
  const folder = mkdtempSync(join(tmpdir(), "robot-"));
  execFileSync(deltaq, ["new", "--bodies", join(folder, "robot.toml")]);
  const bodies = readFileSync(join(folder, "robot.toml"), "utf8");
  rmSync(folder, { recursive: true });
  const moved = async (text) => {
    await after(page, () => type(page, text));
    const ours = (await rows(page, "Chetaev")).filter((_, i) => i % 16 === 0).map((row) => row.slice(0, 4));
    const theirs = native(text, "chetaev", ours.map(([t]) => t));
    const largest = Math.max(...ours.flatMap((row, i) => row.map((x, j) => Math.abs(x - theirs[i][j]))));
    must(ours.length > 20 && largest <= 1e-12, `of ${ours.length} rows the native ones differ by ${largest}`);
    return JSON.stringify(ours.at(-1));
  };
  const light = await moved(bodies);
  await page.screenshot({ path: join(pictures, "robot.png") });
  const heavy = bodies.replace("mass = 3\n", "mass = 6\n");
  must((await moved(heavy)) !== light, "another mass changes nothing");
  const before = JSON.stringify((await rows(page, "Chetaev")).at(-1));
  await after(page, () => slide(page, "drive", 800));
  must(JSON.stringify((await rows(page, "Chetaev")).at(-1)) !== before, "the slider of the torque changes nothing");
  const wrong = bodies.replace('on = "robot"', 'on = "robo"');
  await type(page, wrong);
  await page.waitForSelector("#faults:not([hidden])");
  const message = await page.$eval("#faults", (faults) => faults.dataset.message);
  const { stderr } = spawnSync(deltaq, ["check", "-"], { input: wrong, encoding: "utf8" });
  const line = wrong.split("\n").indexOf('on = "robo"') + 1;
  must(message.startsWith(`own:${line}:6: there is no body`) && stderr.includes(message.replaceAll("own:", "stdin:")), `a fault in a body:\n${message}\nnative:\n${stderr}`);
  must((await page.$$eval("#marks .bad u", (all) => all.map(({ textContent }) => textContent))).join() === '"robo"', "the body's line is not marked");
  await leave(page);
}

// Puts equations beside the scene and has them reviewed.
export async function yours(page, theirs) {
  await page.$eval("#theirs", (area, theirs) => {
    area.value = theirs;
    area.dispatchEvent(new Event("input"));
  }, theirs);
  await page.click("#judge");
  await page.waitForFunction(() => document.querySelector("#judged :not(.hint)"), { timeout: 60000 });
}

// Equations beside a scene are right as the native program says, or their wrong term is marked; a changed text clears that.
export async function reviewed({ open, leave, link, must, after, choose, deltaq, pictures }) {
  const page = await open(link({ scene: "sleigh", tab: "review", time: 1 }));
  const right = `m*x'' - m*a*(phi''*sin(phi) + phi'^2*cos(phi)) = -N*sin(phi)
m*y'' + m*a*(phi''*cos(phi) - phi'^2*sin(phi)) =  N*cos(phi)
(I + m*a^2)*phi'' = m*a*(x''*sin(phi) - y''*cos(phi))
y'*cos(phi) = x'*sin(phi)`;
  const marked = () => page.$$eval("#under .bad u", (all) => all.map(({ textContent }) => textContent).join());
  const said = () => page.$eval("#judged", ({ innerText }) => innerText);
  await yours(page, right);
  must((await said()).startsWith("These equations are right") && (await marked()) === "", `right equations are said to be: ${await said()}`);
  for (const [from, to, term] of [["+ phi'^2*cos", "- phi'^2*cos", "phi'^2*cos(phi)"], ["y''*cos", "2*y''*cos", "2*y''*cos(phi)"], ["= x'*sin", "= -x'*sin", "x'*sin(phi)"], ["m*a^2", "m*a", ""]]) {
    const wrong = right.replace(from, to);
    await yours(page, wrong);
    const words = await said();
    must(words.startsWith("These equations are wrong.") && (await marked()).includes(term), `${to}: marked is ${await marked()}, said ${words}`);
    const native = spawnSync(deltaq, ["review", "sleigh", "-"], { input: wrong, encoding: "utf8" }).stdout;
    const [, first] = /exactly the equations of: (.*)\./.exec(native) ?? [];
    must(first && words.includes(first), `${to}: the native program says ${first}, the page ${words}`);
  }
  await yours(page, right.replace("sin(phi) +", "sin(phi +"));
  must((await said()).includes("cannot be read") && (await page.$$("#under .bad")).length === 1, `a bracket that is not closed: ${await said()}`);
  await yours(page, right.replace("+ phi'^2*cos", "- phi'^2*cos"));
  await page.screenshot({ path: join(pictures, "review.png") });
  await choose(page, "sledge");
  must((await said()) === "" && (await marked()) === "", "another scene stands beside the review of the one before");
  await leave(page);
}
