// Whether a page grows while sliders are moved: its heap, what it has in the document, its workers and their memory.

// What may come and go, in bytes: what is measured after a collection still depends on what is under way.
const ROOM = 2e6;
// Rounds that are left out first, in which the browser compiles, and buffers and memories find their size. In each round
// every slider is moved up and down, once: what a busy machine does in a longer time is the same.
const WARM = 2;
const MOVES = 6;

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

const place = (sorted, part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];

// Times between frames while the sledge runs, over and over, and a hand is on a slider in every other second.
export async function frames({ open, link, must, said }, seconds) {
  const page = await open(link({ scene: "sledge" }), { alone: true });
  const took = await page.evaluate(async (seconds) => {
    const slider = document.querySelector('[data-name="alpha"] input[type=range]');
    const [took, began] = [[], performance.now()];
    for (let before = began, i = 0; before - began < 1000 * seconds; i++) {
      const now = await new Promise(requestAnimationFrame);
      if (i > 0) took.push(now - before);
      before = now;
      const play = document.getElementById("play");
      if (play.getAttribute("aria-label") === "play") play.click();
      if (Math.floor((now - began) / 1000) % 2) continue;
      slider.value = 300 + 200 * Math.sin(i / 20);
      slider.dispatchEvent(new Event("input"));
    }
    return took;
  }, seconds);
  const third = Math.floor(took.length / 3);
  const sorted = (list) => [...list].sort((a, b) => a - b);
  const [all, first, last] = [took, took.slice(0, third), took.slice(-third)].map(sorted);
  const [before, after] = [place(first, 0.5), place(last, 0.5)];
  must(third > 10 && place(all, 0.5) < 1000 / 20, `half of ${all.length} frames take more than ${place(all, 0.5).toFixed(1)} ms`);
  must(after < 1.5 * before + 5, `frames become slower: ${before.toFixed(1)} ms at first, ${after.toFixed(1)} ms at last`);
  const late = took.filter((x) => x > 50).length;
  said.push(`${took.length} frames in ${seconds} s: median ${place(all, 0.5).toFixed(1)} ms (${before.toFixed(1)} in the first third, ${after.toFixed(1)} in the last), 99 of 100 within ${place(all, 0.99).toFixed(1)} ms, ${late} over 50 ms, longest ${all.at(-1).toFixed(0)} ms`);
  await page.close();
}
