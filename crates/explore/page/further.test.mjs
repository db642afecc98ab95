// Integrals and derivatives are those of the native program; the sledge's are known in closed form, too.

import { execFileSync } from "node:child_process";

const shown = (page, panel) => page.waitForSelector(`#${panel}[aria-busy=false] table`, { timeout: 60000 });
const cells = (page, panel) => page.$$eval(`#${panel} details[open] tbody tr, #${panel} .said tr`, (rows) => rows.map((row) => [...row.cells].map(({ textContent }) => textContent)));

// Lines of `deltaq integrals`; the last digits of a drift depend on the machine.
function native(deltaq, degree) {
  const lines = execFileSync(deltaq, ["integrals", "sledge", "--degree", String(degree)], { encoding: "utf8" }).trim().split("\n").slice(2);
  return lines.map((line) => [line.slice(0, 14).trim(), line.slice(14)]);
}
const DRIFT = /\(drift ([^)]*)\)/;
const still = (lines) => JSON.stringify(lines.map(([about, words]) => [about, words.replace(DRIFT, "")]));

export async function integrals({ open, leave, link, must, after, slide, deltaq }) {
  const page = await open(link({ scene: "sledge", tab: "integrals" }));
  await shown(page, "integrals");
  for (const degree of [1, 2]) {
    if (degree === 2) {
      await page.click("#integrals button");
      await page.waitForFunction(() => !document.querySelector("#integrals button"), { timeout: 60000 });
    }
    const [here, there] = [await cells(page, "integrals"), native(deltaq, degree)];
    must(still(here) === still(there), `integrals to degree ${degree}: ${still(here)}, native ${still(there)}`);
    for (const [, words] of here) must(!(Number(DRIFT.exec(words)?.[1]) > 1e-9), `no integral: ${words}`);
  }
  // what is shown belongs to the numbers that are set
  await after(page, () => slide(page, "k", 400));
  await shown(page, "integrals");
  must(await page.$("#integrals button"), "integrals of before are shown");
  await leave(page);
}

// A question that was stopped is asked again when its panel is opened again, and one that waited behind it goes on.
export async function halted({ open, leave, link, must }) {
  const page = await open(link({ scene: "snakeboard", tab: "integrals" }));
  const waits = () => page.$eval("#deciding", ({ hidden }) => !hidden);
  await shown(page, "integrals");
  await page.click("#integrals button");
  await page.click("[data-tab=derivatives]");
  must(await waits(), "two questions are asked, and nothing says so");
  await page.click("#undecided");
  await page.waitForFunction(() => document.getElementById("integrals").textContent === "That was stopped.", { timeout: 5000 });
  must(await waits(), "one of two questions is stopped, and nothing says that the other goes on");
  await shown(page, "derivatives");
  must(!(await waits()), "nothing is asked, and the page says that it decides");
  await page.click("[data-tab=integrals]");
  await shown(page, "integrals");
  await leave(page);
}

export async function derivatives({ open, leave, link, must }) {
  const page = await open(link({ scene: "sledge", tab: "derivatives" }));
  await shown(page, "derivatives");
  const rows = Object.fromEntries((await cells(page, "derivatives")).map(([name, ...numbers]) => [name.replace(/,.*/, ""), numbers.map(Number)]));
  // x' and y' are forced through (cos φ, sin φ), φ = φ₀ + ω t
  for (const [name, column, value] of [["x", 0, 1], ["x", 1, 0], ["y", 1, 1], ["φ", 2, 1], ["φ′", 2, 10], ["x′", 2, 0], ["α", 2, 0], ["k", 0, 0]]) {
    must(Math.abs(rows[name]?.[column] - value) < 1e-3, `by ${name}, column ${column}: ${rows[name]}, not ${value}`);
  }
  // the speed u along the blade obeys u' = g sin α cos φ; of it comes x
  const [g, alpha, phi, omega, T] = [9.81, 0.4, 0.3, 1.1, 10];
  const n = 20000;
  let [u, x] = [0, 0];
  for (let i = 0; i < n; i++) {
    const angle = phi + (omega * T * (i + 0.5)) / n;
    const rate = Math.sin(alpha) * Math.cos(angle);
    x += ((u + (rate * T) / (2 * n)) * Math.cos(angle) * T) / n;
    u += (rate * T) / n;
  }
  must(Math.abs(rows.g?.[0] / x - 1) < 5e-3, `by g, x: ${rows.g}, not ${x}`);
  must(g * x !== 0 && (await page.$$("#derivatives details")).length === 3, "not a table for each motion that is shown");
  await leave(page);
}
