// The start in the hand: what is dragged comes where the hand is, by the numbers that are typed otherwise, and stays on the constraint.

import { join } from "node:path";

import { LIVELY } from "./pages.test.mjs";

// Places of the rings in the page, the numbers that are set, and the start that was computed.
const state = (page) => page.evaluate(() => {
  const middle = (kind) => {
    const { left, top, width, height } = document.querySelector(`[data-grip=${kind}]`).getBoundingClientRect();
    return [left + width / 2, top + height / 2];
  };
  const { samples } = window.explored;
  const [motion] = samples.motions;
  const of = (group) => Object.fromEntries(Object.entries(motion.columns[group]).map(([name, place]) => [name, motion.value(0, place)]));
  const seen = [...document.querySelectorAll(".grip")].filter((grip) => grip.checkVisibility()).map(({ dataset }) => dataset.grip);
  const typed = Object.fromEntries([...document.querySelectorAll("#numbers .row.changed")].map((row) => [row.dataset.name, Number(row.querySelector("input[type=number]").value)]));
  return { seen, ...(seen.length ? { place: middle("place"), heading: middle("heading"), velocity: middle("velocity") } : {}), q: of("coordinate"), v: of("velocity"), typed };
});

const far = ([a, b], [c, d]) => Math.hypot(a - c, b - d);
// The picture is where it was going: no frame is eased to any more, and the rings are drawn there.
const settled = async (page) => {
  await page.waitForFunction(() => window.explored.stage.window === window.explored.stage.target, { timeout: 20000 });
  await page.evaluate(() => new Promise(requestAnimationFrame));
};
const slip = ({ q, v }) => Math.abs(v["y'"] * Math.cos(q.phi) - v["x'"] * Math.sin(q.phi));

async function drag(page, [x, y], [dx, dy]) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 8; i++) {
    await page.mouse.move(x + (dx * i) / 8, y + (dy * i) / 8);
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 60)));
  }
}

export async function hand({ open, leave, link, must, after, pictures }) {
  const page = await open(link({ scene: "sledge", time: 2 }), { features: LIVELY });
  must((await state(page)).seen.length === 0, "rings are there unasked");
  await after(page, () => page.click("#grips"));
  const start = await state(page);
  must(start.seen.join() === "place,heading,velocity", `rings: ${start.seen}`);
  must((await page.$eval("#reading", ({ textContent }) => textContent)) === "t = 0.00 s", "the start is not shown");
  await page.screenshot({ path: join(pictures, "hand.png") });
  // the body is where the blade touches the slope of 0.4, in pixels of the page
  const blade = await page.evaluate((place) => {
    const { stage } = window.explored;
    const { left, top } = stage.canvas.getBoundingClientRect();
    const [x, y] = stage.projection().project(place);
    return [left + x / devicePixelRatio, top + y / devicePixelRatio];
  }, [Math.cos(0.4) * start.q.x, start.q.y, -Math.sin(0.4) * start.q.x]);
  must(far(start.place, blade) < 1.5, `the ring is at ${start.place}, the blade at ${blade}`);

  // the mouse: each ring comes where it is dragged, as far as the constraint leaves it
  await drag(page, start.place, [60, 25]);
  const held = await state(page);
  must(far(held.place, [start.place[0] + 60, start.place[1] + 25]) < 3, `the body is at ${held.place}, ${start.place} before`);
  must(Math.abs(held.q.phi - start.q.phi) < 1e-6, "a body that is moved turns");
  await after(page, () => page.mouse.up());
  await settled(page);
  const moved = await state(page);
  must(Object.keys(moved.typed).sort().join() === "x,y" && Math.abs(moved.typed.x - moved.q.x) < 1e-5 && moved.q.x !== 0, `numbers: ${JSON.stringify(moved.typed)}, ${JSON.stringify(moved.q)}`);

  await drag(page, moved.heading, [20, 30]);
  await after(page, () => page.mouse.up());
  await settled(page);
  const turned = await state(page);
  must(Math.abs(turned.q.phi - moved.q.phi) > 0.1 && turned.q.x === moved.q.x && turned.q.y === moved.q.y, `turned from ${JSON.stringify(moved.q)} to ${JSON.stringify(turned.q)}`);
  must(slip(turned) < 1e-9, `turned, it slips by ${slip(turned)}`);

  const speed = ({ v }) => Math.hypot(v["x'"], v["y'"]);
  const [before, forward] = [speed(turned), [turned.velocity[0] - turned.place[0], turned.velocity[1] - turned.place[1]]];
  await drag(page, turned.velocity, forward);
  await after(page, () => page.mouse.up());
  await settled(page);
  const faster = await state(page);
  must(speed(faster) > 1.3 * before && slip(faster) < 1e-9, `from ${before} to ${speed(faster)} m/s, slip ${slip(faster)}`);
  must(Object.keys(faster.typed).includes("x'") && !Object.keys(faster.typed).includes("phi'"), `numbers: ${JSON.stringify(faster.typed)}`);

  // one drag is one change that is undone
  await after(page, () => page.click("#undo"));
  await settled(page);
  must(Math.abs(speed(await state(page)) - before) < 1e-9, "a drag is not undone at once");

  // keys
  await page.focus("[data-grip=place]");
  const still = await state(page);
  await after(page, () => page.keyboard.press("ArrowRight"));
  const right = await state(page);
  must(right.q.y !== still.q.y && (await page.evaluate(() => document.activeElement.dataset.grip)) === "place", "an arrow key moves nothing");

  // a camera that goes with the body lets it go while it is in the hand
  await page.select("#follow", "Chetaev");
  const middle = await state(page);
  await drag(page, middle.place, [50, 20]);
  must(far((await state(page)).place, [middle.place[0] + 50, middle.place[1] + 20]) < 3, `with the camera, the body is at ${(await state(page)).place}, ${middle.place} before`);
  await after(page, () => page.mouse.up());
  await settled(page);
  must(far((await state(page)).place, middle.place) < 3, "the camera does not go with the body again");

  // elsewhere than at the start there is nothing to hold
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("ArrowRight");
  must((await state(page)).seen.length === 0, "rings are there at another time");
  await leave(page);
}

// Velocities that the constraint forbids are not to be had: a disc only rolls on.
export async function rolling({ open, leave, link, must, after }) {
  const page = await open(link({ scene: "disc", grips: true }));
  await page.waitForFunction(() => window.explored.samples.grips, { timeout: 20000 });
  const before = await state(page);
  await drag(page, before.velocity, [0, -60]);
  await after(page, () => page.mouse.up());
  await settled(page);
  const { q, v, typed } = await state(page);
  must(Object.keys(typed).join() === "psi'", `numbers: ${JSON.stringify(typed)}`);
  must(Math.abs(v["x'"] - 0.5 * v["psi'"] * Math.cos(q.phi)) < 1e-9 && v["psi'"] !== 2, `it slips: ${JSON.stringify(v)}`);
  await leave(page);
}

// Where the start gives a velocity of the body, it is in the hand.
export async function velocities({ open, leave, link, must }) {
  for (const scene of ["appell-hamel", "isokinetic", "sledge", "disc"]) {
    const page = await open(link({ scene, grips: true }));
    await page.waitForFunction(() => window.explored.samples.grips, { timeout: 20000 });
    const { seen } = await state(page);
    must(seen.includes("velocity"), `rings of ${scene}: ${seen}`);
    await leave(page);
  }
}

// A finger does it, too, and does not turn the view.
export async function byFinger({ open, leave, link, must, after, pictures }) {
  const page = await open(link({ scene: "turntable", grips: true }), { width: 400, height: 860 });
  await page.waitForFunction(() => window.explored.samples.grips, { timeout: 20000 });
  const before = await state(page);
  const eye = () => page.evaluate(() => JSON.stringify(window.explored.stage.eye));
  const was = await eye();
  const client = await page.createCDPSession();
  const touch = (type, ...places) => client.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y]) => ({ x, y })) });
  const [x, y] = before.place;
  await touch("touchStart", [x, y]);
  for (let i = 1; i <= 6; i++) {
    await touch("touchMove", [x - 5 * i, y]);
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 60)));
  }
  await after(page, () => touch("touchEnd"));
  await settled(page);
  const now = await state(page);
  must(Math.hypot(now.q.x - before.q.x, now.q.y - before.q.y) > 0.05, `a finger moves it from ${JSON.stringify(before.q)} to ${JSON.stringify(now.q)}`);
  must((await eye()) === was, "a finger on the body turns the view");
  await page.screenshot({ path: join(pictures, "hand-phone.png") });
  await leave(page);
}
