// Pages of a browser: opened, waited for, and left for who comes next, as a new one takes the browser twice as long as one
// that is there. What they complain of is kept.

import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

// Who does not like things to move. Most checks ask as this one: what runs by itself is drawn sixty times a second, a quarter of
// the work of all checks, and shows them nothing. LIVELY are those that are about motion, or measure what everybody gets.
const STILL = [{ name: "prefers-reduced-motion", value: "reduce" }];
export const LIVELY = [];

export class Pages {
  // `complain` receives messages that a page should not print. Settings of network and appearance go to
  // Chromium only.
  constructor(browser, isChromium, complain) {
    Object.assign(this, { browser, isChromium, complain, left: new Map(), used: [] });
  }

  async made(context) {
    const page = await context.newPage();
    if (this.isChromium) await page.setOfflineMode(true);
    page.on("console", (message) => ["error", "warn"].includes(message.type()) && this.complain(`console: ${message.text()}`));
    page.on("pageerror", (error) => this.complain(`error: ${error.stack ?? error.message}`));
    page.on("request", (request) => /^(file|data|blob|about):/.test(request.url()) || this.complain(`asks for ${request.url()}`));
    return page;
  }

  // A page at an address, loaded anew, which has shown its motions in full, and what is decided, or what it is waited for
  // until. `alone`, it is one that was never used, and no other one is there.
  async open(address, { width = 1280, height = 900, scheme = "light", context = this.browser.defaultBrowserContext(), features = STILL, until = null, alone = false } = {}) {
    const left = this.left.get(context) ?? [];
    if (alone) await Promise.all(left.splice(0).map((page) => page.close()));
    const page = left.pop() ?? (await this.made(context));
    this.used.push(page);
    await page.bringToFront();
    await page.setViewport({ width, height });
    await this.look(page, scheme, features);
    await page.goto(address);
    if (until) await page.waitForSelector(until, { timeout: 60000 });
    else await page.waitForFunction(() => window.decided, { timeout: 60000 });
    return page;
  }

  async look(page, scheme, features = STILL) {
    if (this.isChromium) await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }, ...features]);
  }

  // Leaves a page: nothing of it runs on, and who opens one next has it, in the same context. The one that was used before
  // it is in front again: what lies behind is not drawn.
  async leave(page) {
    await page.goto("about:blank");
    await page.mouse.reset();
    const context = page.browserContext();
    this.left.set(context, [...(this.left.get(context) ?? []), page]);
    this.used = this.used.filter((other) => other !== page && !other.isClosed());
    await this.used.at(-1)?.bringToFront();
  }

  // Forgets a context and all of its pages.
  async forget(context) {
    this.left.delete(context);
    await context.close();
  }
}

// Another size, or look, of a page that is there, and drawn.
export async function resize(page, { width, height }) {
  await page.setViewport({ width, height });
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

// Waits for newer motions than there are, in full: those at a glance have no error.
export async function after(page, act) {
  const before = await page.evaluate(() => window.explored.drawn);
  await act();
  const isNewer = (before) => window.explored.drawn > before && window.explored.answer.motions.every((m) => m.refused || m.error !== null);
  await page.waitForFunction(isNewer, { timeout: 60000 }, before);
}

// Milliseconds of processor that all pages and their workers have taken so far. Other programs make a page slow; they do not
// make it take more of this.
export async function processor(browser) {
  const session = await browser.target().createCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  return processInfo.filter(({ type }) => type === "renderer").reduce((sum, { cpuTime }) => sum + 1000 * cpuTime, 0);
}

// Chooses a built-in scene, and waits for its motions.
export const choose = (page, name) => after(page, () => page.select("#scene", name));

// Files that the buttons write, by kind.
export async function taken(page, kinds) {
  const folder = mkdtempSync(join(tmpdir(), "taken-"));
  const client = await page.createCDPSession();
  await client.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder, browserContextId: page.browserContext().id });
  const files = {};
  await page.click("#take");
  for (const kind of kinds) {
    const before = new Set(readdirSync(folder));
    await page.click(`[data-take=${kind}]`);
    // what is written waits for what is decided before it
    for (let i = 0; i < 3000 && !files[kind]; i++) {
      await new Promise((resolve) => setTimeout(resolve, 20));
      const fresh = readdirSync(folder).find((name) => !before.has(name) && !name.endsWith(".crdownload"));
      // the name is there, and empty, before what is written is
      const bytes = fresh && existsSync(join(folder, fresh)) ? readFileSync(join(folder, fresh)) : "";
      if (bytes.length > 0) files[kind] = { name: fresh, bytes };
    }
    files[kind] ??= { name: "nothing", bytes: Buffer.alloc(0) };
  }
  await page.click("#taking form button");
  await client.detach();
  rmSync(folder, { recursive: true, force: true });
  return files;
}
