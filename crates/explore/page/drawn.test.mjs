// Arrows say what was computed: velocities, reactions, virtual displacements, down, and the scale.

import { join } from "node:path";

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const size = (a) => Math.hypot(...a);

// Rows of a motion: coordinates, velocities, first multiplier, and what the arrows are.
const rows = (page, label) => page.evaluate((label) => {
  const motion = window.explored.samples.motions.find((motion) => motion.label === label);
  const of = (group) => Object.values(motion.columns[group]);
  return Array.from({ length: 9 }, (_, i) => {
    const row = Math.round(((motion.rows - 1) * i) / 8);
    const all = (group) => of(group).map((place) => motion.value(row, place));
    return { q: all("coordinate"), v: all("velocity"), multipliers: all("multiplier"), ...motion.arrows(row) };
  });
}, label);

// The sledge of unit mass on a slope of 0.4: everything is known from its numbers.
export async function forces({ open, leave, link, must, pictures, after }) {
  const page = await open(link({ scene: "sledge", time: 1 }));
  const picture = () => page.$eval("#stage", (canvas) => canvas.toDataURL());
  const before = await picture();
  must((await page.$eval("#key", ({ textContent }) => textContent)) === "", "forces are told unasked");
  await after(page, () => page.click("#forces"));
  must((await picture()) !== before, "forces are not drawn");
  const [c, s] = [Math.cos(0.4), Math.sin(0.4)];
  const place = ([x, y]) => [c * x, y, -s * x];
  for (const { q, v, multipliers, velocity, rest, directions, contacts } of await rows(page, "Chetaev")) {
    const [phi, force] = [q[2], contacts[0].force];
    const [along, across] = [place([Math.cos(phi), Math.sin(phi)]), place([-Math.sin(phi), Math.cos(phi)])];
    must(size(velocity.map((x, i) => x - place(v)[i])) < 1e-6 * (1 + size(v)), `velocity ${velocity}, not ${place(v)}`);
    must(size(force.map((x, i) => x - multipliers[0] * across[i])) < 1e-4 * (1 + size(force)), `reaction ${force}, not ${multipliers[0]} across`);
    must(rest < 1e-4, `${rest} of Chetaev's reaction is no force`);
    must(directions.length === 1 && Math.abs(Math.abs(dot(directions[0], along)) - 1) < 1e-6, `virtual displacements along ${directions}`);
    must(size(contacts[0].place.map((x, i) => x - place(q)[i])) < 1e-9, `the contact is at ${contacts[0].place}`);
  }
  // the vakonomic sledge is pushed along its blade, or turned: no blade does that
  const pushed = (await rows(page, "vakonomic")).some(({ q, rest, contacts }) => {
    const along = dot(contacts[0].force, place([Math.cos(q[2]), Math.sin(q[2])]));
    return Math.abs(along) > 0.1 * size(contacts[0].force) || rest > 0.1;
  });
  must(pushed, "the vakonomic reaction is that of a blade");
  const [key, speed] = await page.evaluate(() => {
    const [motion] = window.explored.samples.motions;
    return [document.getElementById("key").textContent, Math.hypot(...motion.arrows(motion.locate(1)[0]).velocity)];
  });
  must(Math.abs(Number(/^Chetaev: speed ([\d.]+) m\/s, reaction [\d.]+ N/.exec(key)?.[1]) / speed - 1) < 0.01, `the key says ${key}, the speed is ${speed}`);
  await page.screenshot({ path: join(pictures, "forces.png") });
  // the address is written a little later
  const isWritten = () => atob(location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/")).includes('"forces":true');
  await page.waitForFunction(isWritten, { timeout: 5000 }).catch(() => must(false, "the forces are not in the address"));
  await page.evaluate(() => location.reload());
  await page.waitForFunction(() => window.explored?.samples.contacts, { timeout: 60000 }).catch(() => must(false, "an address does not remember the forces"));
  await leave(page);
}

// Down is where the weight draws; the scale is that of the picture.
export async function down({ open, leave, link, must, after, choose }) {
  const page = await open(link({ scene: "sledge", time: 1 }));
  const seen = () => page.evaluate(() => {
    const { stage, samples } = window.explored;
    const drawn = new DOMParser().parseFromString(stage.svg("a picture"), "image/svg+xml");
    const texts = [...drawn.querySelectorAll("text")].map(({ textContent }) => textContent);
    const [scale] = texts.map((text) => /^([\d.e-]+) m$/.exec(text)).filter(Boolean);
    // the last stroke but those of the arrow down: the bar, from its left tick to its right one
    const bars = [...drawn.querySelectorAll("path")].map((path) => /^M([\d.]+) ([\d.]+)L\1 [\d.]+M([\d.]+) \2L\3 [\d.]+M\1 ([\d.]+)L\3 \4$/.exec(path.getAttribute("d"))).filter(Boolean);
    return { down: samples.down, texts, metres: Number(scale?.[1]), pixels: bars[0] && bars[0][3] - bars[0][1], scale: stage.projection().scale };
  });
  const expected = { sledge: [0, 0, -1], "velocity-pendulum": [0, -1, 0], disc: undefined };
  for (const [scene, axis] of Object.entries(expected)) {
    if (scene !== "sledge") await choose(page, scene);
    const found = await seen();
    must(JSON.stringify(found.down) === JSON.stringify(axis), `${scene}: down is ${found.down}`);
    must(found.texts.includes("down") === (axis !== undefined), `${scene}: ${found.texts}`);
    must(found.texts.includes("x") && found.texts.includes("y"), `${scene}: no axes among ${found.texts}`);
    must(Math.abs(found.pixels / (found.metres * found.scale) - 1) < 0.02, `${scene}: ${found.metres} m are ${found.pixels} pixels at ${found.scale} a metre`);
  }
  await leave(page);
}
