// The first seconds: something moves at once, the picture is of bodies, the first curves are the path and the coordinates, and a
// new text stands under nothing that is older.

import { join } from "node:path";

import { processor, resize } from "./pages.test.mjs";

const SIZES = { desk: { width: 1366, height: 768 }, phone: { width: 400, height: 800 } };
const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
const reading = (page) => page.$eval("#reading", ({ textContent }) => parseFloat(textContent.slice(4)));

// Frames from the first motion until something moves, and milliseconds of processor until then: a tenth of a second and one
// second, were there nothing beside it.
const [FRAMES, PROCESSOR] = [6, 1500];

// Notes when frames are drawn.
const frames = (page) => page.evaluateOnNewDocument(() => {
  window.frameTimes = [];
  const note = (time) => {
    window.frameTimes.push(time);
    requestAnimationFrame(note);
  };
  requestAnimationFrame(note);
});

// At half a second and two, of a first visit and of a scene: the time goes on, and pictures of that.
export async function seconds({ browser, leave, forget, fresh, link, must, url, pictures, said, made }) {
  for (const [name, size] of Object.entries(SIZES)) {
    for (const [what, address] of Object.entries({ visit: url, sledge: link({ scene: "sledge" }) })) {
      const context = await fresh();
      const page = await made(context);
      await page.setViewport(size);
      await frames(page);
      const before = await processor(browser);
      await page.goto(address);
      await page.waitForFunction(() => window.explored?.moved, { timeout: 60000 });
      const took = (await processor(browser)) - before;
      const times = [];
      for (const after of [0.5, 1.5]) {
        await wait(1000 * after);
        times.push(await reading(page).catch(() => NaN));
        await page.screenshot({ path: join(pictures, `${what}-${name}-${times.length}.png`) });
      }
      const { count, moved } = await page.evaluate(() => {
        const { first, moved } = window.explored;
        return { count: window.frameTimes.filter((time) => time > first && time < moved).length, moved };
      });
      must(times[1] > times[0] && count <= FRAMES, `${what}, ${name}: t = ${times}, moves ${count} frames after the first motion`);
      must(took < PROCESSOR, `${what}, ${name}: moves after ${took.toFixed(0)} ms of processor, at most ${PROCESSOR}`);
      said.push(`${what}, ${name}: moves after ${moved.toFixed(0)} ms, ${took.toFixed(0)} of processor`);
      await leave(page);
      await forget(context);
    }
  }
}

// The path is that of the coordinates, at one scale; a click leads to the nearest place; the gap in metres comes last, and is
// drawn from its error on.
export async function curves({ open, leave, link, must }) {
  const page = await open(link({ scene: "sledge", time: 1 }));
  const kinds = await page.$$eval("#curve option", (all) => all.map(({ value, textContent }) => [value, textContent]));
  const order = kinds.map(([value]) => value);
  must(order[0] === "path" && order[1] === "coordinate:x" && order.slice(-2).join() === "gap,log", `curves are ${order}`);
  must(kinds.at(-2)[1].endsWith("(m)") && !kinds.some(([, text]) => text.includes("√")), `units: ${kinds.map(([, text]) => text)}`);
  const path = await page.evaluate(() => {
    const { curves, samples } = window.explored;
    const { x, y } = curves.plot.scales;
    const { width, height } = curves.plot.bbox;
    const [first] = samples.motions;
    const row = first.rows >> 1;
    const place = ["y", "x"].map((name) => first.value(row, first.columns.coordinate[name]));
    return { scale: ((x.max - x.min) / width) / ((y.max - y.min) / height), names: samples.plane.names, at: samples.plane.at(first, row), place,
      inside: place[0] > x.min && place[0] < x.max && place[1] > y.min && place[1] < y.max, t: first.time(row), pixel: [curves.plot.valToPos(place[0], "x"), curves.plot.valToPos(place[1], "y")] };
  });
  must(Math.abs(path.scale - 1) < 0.05, `the axes of the path have scales whose ratio is ${path.scale}`);
  must(path.names.join() === "y,x" && path.at.join() === path.place.join() && path.inside, `the path is of ${path.names}: ${path.at}, not ${path.place}`);
  const box = await (await page.$(".u-over")).boundingBox();
  await page.mouse.click(box.x + path.pixel[0], box.y + path.pixel[1]);
  must(Math.abs((await reading(page)) - path.t) < 0.1, `a click on the path at t = ${path.t} leads to ${await reading(page)}`);
  await page.select("#curve", "gap");
  const { lowest, errors, drawn } = await page.evaluate(() => {
    const { curves: { plot }, samples: { gaps } } = window.explored;
    const limits = gaps.map(({ limit }) => limit.filter(Number.isFinite).sort((a, b) => a - b));
    return { lowest: 10 ** plot.scales.y.min, errors: limits.map((list) => list[list.length >> 1]),
      drawn: 10 ** Math.min(...plot.data.slice(1).flat().filter(Number.isFinite)) };
  });
  must(drawn >= Math.min(...errors) * 0.999 && lowest > Math.min(...errors) / 30, `the gap is drawn from ${drawn}, the axis begins at ${lowest}, errors are ${errors}`);
  await leave(page);
}

// As soon as a new text is read its title stands over nothing older.
export async function newText({ open, leave, link, must, type, after, OWN }) {
  const page = await open(link({ scene: "bicycle", tab: "text", time: 1 }), { until: "#said:not(:empty)" });
  const text = await page.evaluate(() => window.explored.scenes.find(({ name }) => name === "ball-in-cone").text);
  await page.evaluate(() => {
    window.seen = [];
    const old = window.explored.samples;
    const look = () => {
      const isVoid = ["view", "graph"].every((id) => document.getElementById(id).classList.contains("void"));
      const title = document.getElementById("title").textContent;
      window.seen.push([title, isVoid || window.explored.samples !== old, document.getElementById("said").textContent, document.getElementById("verdict").textContent]);
      requestAnimationFrame(look);
    };
    look();
  });
  await after(page, () => type(page, text));
  const seen = await page.evaluate(() => window.seen);
  const under = seen.filter(([title]) => title.includes("cone"));
  const old = seen.find(([title]) => title.includes("icycle"));
  must(under.length > 2 && under.every(([, clear]) => clear), `the old scene stands under a new title in ${under.filter(([, clear]) => !clear).length} of ${under.length} frames`);
  must(under[0][2] !== old[2] && under[0][3] === "", `under a new title stands: ${under[0][2]} ${under[0][3]}`);
  must(seen.some(([title, clear]) => title === "" && clear), "a new text does not clear the title of the old one");
  await leave(page);
}

// The picture is of the bodies: as long as the run is, they are seen in it, at least as large as a finger; on a phone the others
// are ghosts. Numbers stand in groups, of which some are closed in a long list.
export async function bodies({ open, leave, link, must, choose }) {
  const page = await open(link({ scene: "sledge", time: 1 }), SIZES.desk);
  for (const scene of ["sledge", "trailer", "ball-in-cone", "heisenberg", "bicycle"]) {
    if (scene !== "sledge") await choose(page, scene);
    for (const size of Object.values(SIZES)) {
      await resize(page, size);
      const found = await page.evaluate(() => {
        const { stage, samples } = window.explored;
        const [first] = samples.motions;
        return [0, 0.4, 0.9].map((part) => {
          stage.draw(samples.start + part * (samples.end - samples.start));
          const { project } = stage.projection();
          const places = [...stage.apart.posesAt(first, stage.t)].flatMap(([pose, body]) => [pose.at, ...body.lines.flat().map((p) => pose.place(p))]).map(project);
          const spread = [0, 1].map((i) => [Math.min(...places.map((p) => p[i])), Math.max(...places.map((p) => p[i]))]);
          const { width, height } = stage.canvas;
          return { inside: spread[0][0] >= 0 && spread[1][0] >= 0 && spread[0][1] <= width && spread[1][1] <= height, size: Math.hypot(...spread.map(([a, b]) => b - a)),
            ghosts: samples.motions.map((motion) => stage.isGhost(motion)).join(), isPoint: first.bodies.every(({ kind }) => kind === "point") };
        });
      });
      const at = `${scene}, ${size.width} px`;
      must(found.every(({ inside }) => inside), `${at}: the body leaves the picture`);
      must(found.every(({ size, isPoint }) => isPoint || size > 24), `${at}: the body is ${found.map(({ size }) => size.toFixed(0))} px large`);
      must(found[0].ghosts.startsWith("false") && found[0].ghosts.includes("true") === size.width < 500, `${at}: ghosts are ${found[0].ghosts}`);
      if (scene !== "bicycle") continue;
      const [rows, seen, groups] = await page.evaluate(() => {
        const rows = [...document.querySelectorAll("#numbers .row")];
        return [rows.length, rows.filter((row) => row.checkVisibility()).length, document.querySelectorAll("#numbers details").length];
      });
      must(rows > 40 && seen < 21 && groups > 6, `${rows} sliders in ${groups} groups, of which ${seen} are open`);
    }
  }
  await leave(page);
}
