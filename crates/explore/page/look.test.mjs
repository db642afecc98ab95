// A camera that goes with a body, differences drawn larger, zoomed curves: the drawing shows what was
// computed.

import { join } from "node:path";

const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

// The body that the camera goes with stays in the middle, at every time; at rest it does not.
export async function camera({ open, leave, link, must, pictures }) {
  for (const [scene, label, size] of [["sledge", "vakonomic", {}], ["trailer", "Chetaev", { width: 400, height: 860 }]]) {
    const page = await open(link({ scene, time: 0.5 }), size);
    const off = () => page.evaluate((label) => [0, 0.3, 1].map((part) => {
      const { stage, samples } = window.explored;
      const motion = samples.motions.find((motion) => motion.label === label);
      const t = samples.start + part * (samples.end - samples.start);
      stage.draw(t);
      const [x, y] = stage.projection().project(motion.trackAt(t));
      return Math.hypot(x - stage.canvas.width / 2, y - stage.canvas.height / 2);
    }), label);
    must(Math.max(...(await off())) > 20, `${scene}: the body stays in the middle of a camera at rest`);
    await page.select("#follow", label);
    must(Math.max(...(await off())) < 1e-6, `${scene}: the camera does not go with ${label}: ${await off()} px`);
    await new Promise((resolve) => setTimeout(resolve, 400));
    const again = await open(await page.evaluate(() => location.href), size);
    must((await again.$eval("#follow", ({ value }) => value)) === label, "a link does not bring the camera back");
    await again.screenshot({ path: join(pictures, `camera-${scene}.png`) });
    await leave(again);
    await leave(page);
  }
}

// Differences in position and attitude are magnified by the chosen factor; those of the first motion are
// zero.
export async function differences({ open, leave, link, must, pictures }) {
  const page = await open(link({ scene: "three-cylinders", time: 0.5 }));
  const drawn = () => page.evaluate(() => {
    const { stage, samples } = window.explored;
    const motions = samples.motions.slice(0, 2);
    const turn = (r) => [0, 1, 2].map((i) => r.map((row) => row[i]));
    const of = (motion) => [...stage.apart.posesAt(motion, 0.5)].map(([{ at, rotation }]) => [at, rotation]);
    const [first, second] = motions.map(of);
    const angle = (a, b) => {
      const [x, y] = [turn(a), turn(b)];
      return Math.acos(Math.min(1, (x.reduce((sum, column, i) => sum + column.reduce((s, v, j) => s + v * y[i][j], 0), 0) - 1) / 2));
    };
    return { first, apart: second.map(([at], i) => at.map((x, j) => x - first[i][0][j])), angles: second.map(([, r], i) => angle(first[i][1], r)), note: document.getElementById("note").textContent };
  });
  const as_it_is = await drawn();
  for (const by of [10, 100]) {
    await page.select("#by", String(by));
    const now = await drawn();
    must(JSON.stringify(now.first) === JSON.stringify(as_it_is.first), "the first motion is drawn elsewhere");
    for (const [i, apart] of now.apart.entries()) {
      const off = distance(apart, as_it_is.apart[i].map((x) => by * x));
      must(off < 1e-9, `body ${i} is ${apart} apart, not ${by} times ${as_it_is.apart[i]}`);
      // where rows are far apart, rotations between them are good to the square of that
      must(Math.abs(now.angles[i] - by * as_it_is.angles[i]) < 0.02 * by * as_it_is.angles[i] + 1e-5, `body ${i} is turned by ${now.angles[i]}, not ${by} times ${as_it_is.angles[i]}`);
    }
    must(Math.max(...as_it_is.apart.flat().map(Math.abs)) > 1e-6, "there is no difference to be drawn");
    must(now.note.includes(`${by} times as large`), `nothing says that they are larger: ${now.note}`);
  }
  await page.screenshot({ path: join(pictures, "differences.png") });
  await leave(page);
}

const seen = (page) => page.evaluate(() => {
  const { scales } = window.explored.curves.plot;
  return { x: [scales.x.min, scales.x.max], y: [scales.y.min, scales.y.max], cut: document.getElementById("cut").textContent, whole: document.getElementById("whole").hidden };
});
const width = ([a, b]) => b - a;

// Wheel, buttons and fingers show less of the time, about what they point at; the heights go with what is seen.
export async function zoom({ open, leave, link, must, pictures }) {
  const page = await open(link({ scene: "sledge", curve: "coordinate:phi", time: 4 }));
  const all = await seen(page);
  must(all.x.join() === "0,10", `all of the time is ${all.x}`);
  await page.click("#closer");
  const closer = await seen(page);
  must(Math.abs(width(closer.x) - 5) < 1e-9 && closer.x[0] < 4 && closer.x[1] > 4, `closer is ${closer.x}`);
  must(width(closer.y) < 0.8 * width(all.y), `heights ${closer.y} of ${all.y}`);
  const box = await (await page.$(".u-over")).boundingBox();
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 20);
  const before = closer.x[0] + 0.25 * width(closer.x);
  await page.mouse.wheel({ deltaY: -500 });
  await page.evaluate(() => new Promise(requestAnimationFrame));
  const wheeled = await seen(page);
  must(Math.abs(wheeled.x[0] + 0.25 * width(wheeled.x) - before) < 0.05 && width(wheeled.x) < 2, `the wheel leads to ${wheeled.x}, about ${before}`);
  await page.screenshot({ path: join(pictures, "zoom.png") });
  // what is seen goes with the time
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("End");
  must((await seen(page)).x[1] === 10, `at the end ${(await seen(page)).x} is seen`);
  await page.click("#ends");
  must((await seen(page)).x.join() === "0,10", "all of it is not all");
  await leave(page);
  const phone = await open(link({ scene: "sledge", curve: "coordinate:phi", time: 4 }), { width: 400, height: 860 });
  await phone.$eval("#plot", (plot) => plot.scrollIntoView({ block: "end" }));
  const { x, y } = await (await phone.$(".u-over")).boundingBox();
  const client = await phone.createCDPSession();
  const touch = (type, ...places) => client.send("Input.dispatchTouchEvent", { type, touchPoints: places.map((at, id) => ({ x: x + at, y: y + 30, id })) });
  await touch("touchStart", 100, 140);
  for (let i = 1; i <= 5; i++) await touch("touchMove", 100 - 10 * i, 140 + 10 * i);
  await touch("touchEnd");
  must(width((await seen(phone)).x) < 5, `two fingers lead to ${(await seen(phone)).x}`);
  await leave(phone);
}

// A motion that runs away does not flatten the others; what is cut is said, and can be seen.
export async function runaway({ open, leave, link, must, pictures }) {
  const page = await open(link({ scene: "sledge", curve: "coordinate:x", time: 4 }));
  const cut = await seen(page);
  const largest = (label) => page.evaluate((label) => {
    const motion = window.explored.samples.motions.find((motion) => motion.label === label);
    return Math.max(...motion.column(motion.columns.coordinate.x));
  }, label);
  const [near, far] = [await largest("vakonomic"), await largest("removed constraint (arc-length)")];
  must(far > 10 * near, `nothing runs away: ${far} and ${near}`);
  must(cut.y[1] < 2 * near && cut.y[1] > near && cut.cut.startsWith("removed constraint (arc-length)") && !cut.whole, `heights up to ${cut.y[1]}, said: ${cut.cut}`);
  await page.screenshot({ path: join(pictures, "runaway.png") });
  await page.click("#whole");
  const all = await seen(page);
  must(all.y[1] > far && all.cut === "", `all of it goes to ${all.y[1]} of ${far}`);
  await page.click("#whole");
  must(JSON.stringify(await seen(page)) === JSON.stringify(cut), "what was cut is not cut again");
  // of two motions that go alike nothing is cut
  await page.select("#curve", "coordinate:phi");
  must((await seen(page)).cut === "", `cut: ${(await seen(page)).cut}`);
  await leave(page);
}

// Both axes of the gap are logarithms: a slope of three, as the report measures, is three decades a decade.
export async function logarithms({ open, leave, link, must, pictures }) {
  const page = await open(link({ scene: "sledge", curve: "log", time: 1 }));
  const [slope, x] = await page.evaluate(() => {
    const [t, gap] = window.explored.curves.plot.data;
    const at = (time) => t.findIndex((x, i) => x >= time && Number.isFinite(gap[i]));
    const [a, b] = [at(-3), at(-2)];
    return [(gap[b] - gap[a]) / (t[b] - t[a]), window.explored.curves.plot.scales.x.max];
  });
  must(Math.abs(slope - 3) < 0.05, `the gap grows as t^${slope}`);
  must(Math.abs(x - 1) < 1e-9, `the axis ends at 1e${x}, the motion at 10 s`);
  // pointing leads to the time
  const box = await (await page.$(".u-over")).boundingBox();
  await page.mouse.click(box.x + box.width - 1, box.y + 30);
  const reading = await page.$eval("#reading", ({ textContent }) => parseFloat(textContent.slice(4)));
  must(reading > 9.5, `the end of the axis is t = ${reading}`);
  await page.screenshot({ path: join(pictures, "log-log.png") });
  await leave(page);
}
