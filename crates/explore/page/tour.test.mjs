// The guided path: what a step says is what the page computed, nothing gives it away before, and it is left and found again.

import { LIVELY } from "./pages.test.mjs";

const CHETAEV = "Chetaev";
const VAKONOMIC = "vakonomic";

// What is expected of each step: the answer that is right, and what the program has to have found for that. Of a pair its
// verdict; of a motion which of the first two it is nearer to, by the largest gap.
const EXPECTED = [
  { scene: "sledge", right: 1, verdict: "different", says: "There are two motions. They differ by 0.001 m after 0.127 s." },
  { scene: "velocity-pendulum", right: 0, verdict: "same", says: "There is one motion: up to 10 s no difference" },
  { scene: "sledge", right: 1, verdict: "different", answer: "none, proved", says: "deltaq proves it for all μ₀ at once", low: { verdict: "different", answer: "none, proved" }, seen: [CHETAEV, VAKONOMIC] },
  { scene: "sledge", right: 0, verdict: "different", nearer: ["between, κ", CHETAEV], says: "nearer to blue", before: { nearer: ["between, κ", VAKONOMIC] }, low: { nearer: ["between, κ", VAKONOMIC], says: "nearer to orange" }, seen: [CHETAEV, VAKONOMIC, "between, κ"] },
  { scene: "sledge", right: 0, verdict: "different", nearer: ["first order, ε and slip", CHETAEV], says: "friction chooses Chetaev", low: { verdict: "different" }, seen: [CHETAEV, VAKONOMIC] },
  { scene: "own", right: 0, verdict: "same", before: { verdict: "different" }, says: "There is one motion: up to 5 s no difference", low: { verdict: "different", says: "There are two motions." }, seen: [CHETAEV, VAKONOMIC] },
];

const revealed = (page) => page.waitForFunction(() => {
  const reveal = document.querySelector("#tour .reveal");
  return reveal.textContent && reveal.getAttribute("aria-busy") === "false" && reveal.textContent;
}, { timeout: 60000 }).then((handle) => handle.jsonValue());

const found = (page) => page.evaluate(() => window.decided);
const pairOf = ({ pairs }, one, other) => pairs.find(({ first, second }) => [one, other].every((label) => [first, second].includes(label)));

// What the program decided has to be what is expected.
function judge(decided, { verdict, answer, nearer }, must, at) {
  const pair = pairOf(decided, CHETAEV, VAKONOMIC);
  if (verdict) must(pair?.verdict === verdict, `${at}: the two are ${pair?.verdict}`);
  const decision = decided.decisions.find(({ family, motion }) => family === VAKONOMIC && motion === CHETAEV);
  if (answer) must(decision?.answer === answer, `${at}: the answer is ${decision?.answer}`);
  if (!nearer) return;
  const [label, to] = nearer;
  const other = to === CHETAEV ? VAKONOMIC : CHETAEV;
  const [near, far] = [to, other].map((one) => pairOf(decided, label, one).largest);
  must(near < far / 2, `${at}: ${label} is ${near} from ${to}, ${far} from ${other}`);
}

const step = (page) => page.$eval("#tour .steps", ({ textContent }) => textContent);

export async function tour({ open, leave, forget, fresh, link, must, url, pictures, after }) {
  const context = await fresh();
  const page = await open(url, { context, features: LIVELY });
  for (const [i, expected] of EXPECTED.entries()) {
    const at = `step ${i + 1}`;
    must((await step(page)) === `Step ${i + 1} of 6`, `${at} shows ${await step(page)}`);
    must((await page.$eval("#scene", ({ value }) => value)) === expected.scene, `${at} has another scene`);
    const hidden = await page.evaluate(() => {
      const seen = (id) => document.getElementById(id).checkVisibility({ visibilityProperty: true });
      return [document.querySelector("#tour .reveal").textContent, seen("said"), seen("play"), seen("graph")];
    });
    must(hidden.join() === ",false,true,false", `${at} gives away its answer: ${hidden}`);
    const run = () => page.evaluate(() => window.explored.stage.shown().map(({ label }) => label).join());
    must((await run()) === (expected.seen ?? [CHETAEV]).join(), `${at} moves ${await run()} before the answer`);
    const time = () => page.$eval("#reading", ({ textContent }) => textContent);
    const before = await time();
    await new Promise((resolve) => setTimeout(resolve, 400));
    must((await time()) !== before, `nothing moves behind the question of ${at}`);
    const labels = await page.evaluate(() => window.explored.answer.motions.map(({ label }) => label).join());
    must(labels === [CHETAEV, VAKONOMIC, ...(expected.nearer ?? []).slice(0, 1)].join(), `${at} shows ${labels}`);
    if (expected.before) {
      await page.waitForFunction(() => document.getElementById("verdict").getAttribute("aria-busy") === "false", { timeout: 60000 });
      judge(await found(page), expected.before, must, `${at}, before the answer`);
    }
    // right and wrong by turns
    const right = i % 2 === 0;
    await page.click(`[data-answer="${right ? expected.right : 1 - expected.right}"]`);
    const said = await revealed(page);
    const words = right ? "As you said." : "Not quite.";
    must(said.startsWith(words) && said.includes(expected.says), `${at} says: ${said}`);
    judge(await found(page), expected, must, at);
    must((await run()) === labels, `${at} shows ${await run()} after the answer`);
    const text = await page.$eval("#tour", ({ innerText }) => innerText);
    must(!/√kg|undefined|NaN/.test(text), `${at} says ${text}`);
    await page.screenshot({ path: `${pictures}/tour-${i + 1}.png` });
    if (expected.low) {
      const move = (value) => after(page, () => page.$eval("#mover", (mover, value) => {
        mover.value = value;
        for (const event of ["input", "change"]) mover.dispatchEvent(new Event(event));
      }, value));
      await move(0);
      const moved = await revealed(page);
      must(!expected.low.says || moved.includes(expected.low.says), `${at}, slider to the left, says: ${moved}`);
      judge(await found(page), expected.low, must, `${at}, slider to the left`);
    }
    if (i === 2) {
      // the address has the step, the answer and the number
      await new Promise((resolve) => setTimeout(resolve, 400));
      const twin = await open(page.url(), { context });
      must((await step(twin)) === "Step 3 of 6" && (await revealed(twin)) === (await revealed(page)), "an address does not remember the step");
      must((await twin.$eval("#tour output", ({ textContent }) => textContent)).startsWith("-20"), "an address does not remember the number");
      await leave(twin);
    }
    if (i < 5) await after(page, () => page.click("#next"));
  }
  await page.click("#play");
  await page.click("#leave");
  must(await page.$eval("#play", ({ ariaLabel }) => ariaLabel === "pause"), "nothing moves after the tour");
  const at = await page.$eval("[aria-selected=true]", ({ dataset }) => dataset.tab);
  must(at === "numbers", `the tour is left for ${at}`);
  must((await page.$eval("[data-name=\"phi'\"] input[type=number]", ({ value }) => Number(value))) === -1.6, "a number moved in the tour is not that of its row");
  await page.click("[data-tab=tour]");
  must((await step(page)) === "Step 6 of 6", "the tour does not go on where it was left");
  await after(page, () => page.click("#back"));
  must((await step(page)) === "Step 5 of 6", "there is no way back");
  await after(page, () => page.select("#scene", "disc"));
  must(await page.$eval("#tour", ({ hidden }) => hidden), "another scene does not leave the tour");
  await leave(page);
  // who has left it is not asked again
  const again = await open(url, { context });
  must(await again.$eval("#tour", ({ hidden }) => hidden), "a second visit begins with the tour");
  await leave(again);
  await forget(context);
  // a link to a scene is no first visit
  const other = await fresh();
  const named = await open(`${url}#scene=disc`, { context: other });
  must((await named.title()).includes("disc") && await named.$eval("#tour", ({ hidden }) => hidden), "a link leads to the tour");
  await forget(other);
}
