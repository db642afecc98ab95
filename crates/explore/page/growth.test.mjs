// Whether a page grows while sliders are moved: its heap, what it has in the document, its workers and their memory.

// What may come and go, in bytes: what is measured after a collection still depends on what is under way.
const ROOM = 2e6;
// Rounds that are left out first, in which the browser compiles, and buffers and memories find their size. In each round
// every slider is moved up, down and back, once: more moves on the way show nothing else, and more rounds are those of
// `cargo xtask growth`.
const WARM = 2;
const MOVES = 3;

// Bytes of all that WebAssembly has in a worker, which no name of the page leads to.
async function memory(session) {
  const { result: { objectId: prototypeObjectId } } = await session.send("Runtime.evaluate", { expression: "WebAssembly.Memory.prototype" });
  const { objects: { objectId } } = await session.send("Runtime.queryObjects", { prototypeObjectId });
  const functionDeclaration = "function () { return this.reduce((sum, { buffer }) => sum + buffer.byteLength, 0); }";
  const { result: { value } } = await session.send("Runtime.callFunctionOn", { objectId, functionDeclaration, returnByValue: true });
  await session.send("Runtime.releaseObject", { objectId });
  return value;
}

// Bytes after a collection, nodes and listeners of the document, and memory of the program in each worker.
async function measured(page, client) {
  const collected = async (session) => {
    await session.send("HeapProfiler.collectGarbage");
    return (await session.send("Runtime.getHeapUsage")).usedSize;
  };
  const heap = await collected(client);
  const { Nodes: nodes, JSEventListeners: listeners } = await page.metrics();
  const heaps = await Promise.all(page.workers().map(({ client }) => collected(client)));
  const memories = await Promise.all(page.workers().map(({ client }) => memory(client)));
  const sum = (list) => list.reduce((a, b) => a + b, 0);
  return { heap, workers: sum(heaps), program: sum(memories), nodes, listeners };
}

// What is measured while nothing is under way: a question that is cancelled takes its worker with it.
async function atRest(page, measure) {
  for (let tries = 0; ; tries++) {
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 500)));
    await page.waitForSelector("#equations[aria-busy=false]", { timeout: 60000 });
    try {
      return await measure();
    } catch (error) {
      if (tries === 5) throw error;
    }
  }
}

// Moves every slider of the sledge up and down and lets go of it, in rounds, and compares the least of the last third of
// them with that of the first.
export async function growth({ open, link, must, said }, rounds) {
  const page = await open(link({ scene: "sledge" }), { alone: true });
  const client = await page.createCDPSession();
  await client.send("Performance.enable");
  const round = () => page.evaluate(async (MOVES) => {
    const sliders = [...document.querySelectorAll("[data-name] input[type=range]")];
    const from = window.explored.drawn;
    for (const slider of sliders) {
      for (let i = 0; i < MOVES; i++) {
        slider.value = 500 + 200 * Math.sin((2 * Math.PI * i) / MOVES);
        slider.dispatchEvent(new Event("input"));
        if (i === MOVES - 1) slider.dispatchEvent(new Event("change"));
        await new Promise(requestAnimationFrame);
      }
    }
    return [MOVES * sliders.length, window.explored.drawn - from];
  }, MOVES);
  const [samples, count, began] = [[], Math.max(6, rounds), performance.now()];
  let [moves, drawn] = [0, 0];
  for (let i = 0; i < WARM + count; i++) {
    const turned = await round();
    [moves, drawn] = [moves + turned[0], drawn + turned[1]];
    const sample = await atRest(page, () => measured(page, client));
    if (i >= WARM) samples.push(sample);
  }
  const took = (performance.now() - began) / 1000;
  const third = Math.floor(count / 3);
  const least = (name, part) => Math.min(...part.map((sample) => sample[name]));
  const told = [];
  for (const [name, room, unit] of [["heap", ROOM, 1e6], ["workers", ROOM, 1e6], ["program", ROOM, 1e6], ["nodes", 50, 1], ["listeners", 0, 1]]) {
    const [first, last] = [least(name, samples.slice(0, third)), least(name, samples.slice(-third))];
    const words = `${name} ${(first / unit).toFixed(unit > 1 ? 1 : 0)} → ${(last / unit).toFixed(unit > 1 ? 1 : 0)}${unit > 1 ? " MB" : ""}`;
    must(last <= first + room, `grows in ${took.toFixed(0)} s of slider moves: ${words}`);
    told.push(words);
  }
  must(moves > 20 && drawn > moves / 20, `${drawn} motions drawn in ${moves} moves`);
  said.push(`${moves} slider moves in ${took.toFixed(0)} s, ${drawn} motions drawn: ${told.join(", ")}`);
  await page.close();
}

const place = (list, part) => [...list].sort((a, b) => a - b)[Math.floor(part * list.length)];
const mean = (list) => list.reduce((a, b) => a + b, 0) / list.length;
// Seconds that a browser is asked about in one go: it gives no answer after some minutes.
const PART = 10;

// Times between frames while the sledge runs, over and over, and a hand is on a slider in every other second.
export async function frames({ open, link, must, said }, seconds) {
  const page = await open(link({ scene: "sledge" }), { alone: true, features: LIVELY });
  const part = () => page.evaluate(async (PART) => {
    const slider = document.querySelector('[data-name="alpha"] input[type=range]');
    const [took, began] = [[], await new Promise(requestAnimationFrame)];
    for (let before = began, i = 0; before - began < 1000 * PART; i++) {
      const play = document.getElementById("play");
      if (play.getAttribute("aria-label") === "play") play.click();
      if (Math.floor((before - began) / 1000) % 2 === 0) {
        slider.value = 300 + 200 * Math.sin(i / 20);
        slider.dispatchEvent(new Event("input"));
      }
      const now = await new Promise(requestAnimationFrame);
      took.push(now - before);
      before = now;
    }
    return took;
  }, PART);
  const parts = [];
  for (let i = 0; i * PART < seconds; i++) parts.push(await part());
  const third = Math.ceil(parts.length / 3);
  const [all, first, last] = [parts, parts.slice(0, third), parts.slice(-third)].map((parts) => parts.flat());
  must(place(all, 0.5) < 1000 / 20, `half of ${all.length} frames take more than ${place(all, 0.5).toFixed(1)} ms`);
  must(mean(last) < 1.5 * mean(first), `frames become slower: ${mean(first).toFixed(1)} ms at first, ${mean(last).toFixed(1)} ms at last`);
  const late = all.filter((x) => x > 50).length;
  said.push(`${all.length} frames in ${PART * parts.length} s: median ${place(all, 0.5).toFixed(1)} ms, mean ${mean(first).toFixed(1)} in the first third, ${mean(last).toFixed(1)} in the last, 99 of 100 within ${place(all, 0.99).toFixed(1)} ms, ${late} over 50 ms, longest ${Math.max(...all).toFixed(0)} ms`);
  await page.close();
}
