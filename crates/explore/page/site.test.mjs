// node site.test.mjs BROWSER SITE PICTURES: the pages of the site, served under a path below that of a server: no error in the
// console, nothing asked for from elsewhere, no page wider than a phone, nothing serious by axe. Some pages also in the dark
// and as wide as a desk, with pictures.

import { existsSync, mkdirSync, readFileSync, readdirSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { extname, join } from "node:path";

import puppeteer from "puppeteer-core";

const [executablePath, site, pictures] = process.argv.slice(2);
const BELOW = "/some/project/";
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".json": "application/json" };
// References made by cargo have a look of their own, the explorer checks of its own.
const OTHERS = ["rust", "explore", "explore.html", "_static", "_downloads", "_sources", "_images"];
const PICTURED = ["index", "README", "docs/guide", "docs/fitting", "docs/python", "docs/install", "docs/tour", "python", "python/System", "reports/README", "reports/evidence/stability", "reports/scenes/sledge", "search"];
const LOOKS = [["light", 1280, "light"], ["dark", 1280, "dark"], ["phone", 400, "light"]];
const NARROW = ["narrow", 320, "light"];

function pagesIn(folder, before = "") {
  return readdirSync(join(folder, before), { withFileTypes: true }).flatMap((entry) => {
    if (OTHERS.includes(entry.name)) return [];
    if (entry.isDirectory()) return pagesIn(folder, `${before}${entry.name}/`);
    return entry.name.endsWith(".html") ? [before + entry.name] : [];
  });
}

const server = createServer(({ url }, answer) => {
  const { pathname } = new URL(url, "http://localhost");
  let place = pathname.startsWith(BELOW) ? join(site, decodeURIComponent(pathname.slice(BELOW.length))) : "";
  if (existsSync(place) && statSync(place).isDirectory()) place = join(place, "index.html");
  const found = existsSync(place);
  answer.writeHead(found ? 200 : 404, { "content-type": TYPES[extname(place)] ?? "application/octet-stream" });
  answer.end(found ? readFileSync(place) : "");
});
await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
const root = `http://127.0.0.1:${server.address().port}${BELOW}`;
const rules = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const browser = await puppeteer.launch({ executablePath, headless: true, args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking"] });
mkdirSync(pictures, { recursive: true });
const page = await browser.newPage();
const [complaints, counts] = [[], { pages: 0, rules: 0 }];
let at = "";
const complain = (what) => complaints.push(`${at}: ${what}`);
page.on("console", (message) => ["error", "warn"].includes(message.type()) && complain(message.text()));
page.on("pageerror", (error) => complain(error.message));
page.on("request", (request) => request.url().startsWith(root) || /^(data|blob):/.test(request.url()) || complain(`asks for ${request.url()}`));

// What a page has to have, by selectors: to use it begins with installing it; a notebook has equations in rows, tables, pictures
// and what was printed; the reference of Python has each class on a page.
const HAVE = {
  "index.html": ['.doors a[href="docs/install.html"]', '.sidebar-tree .caption + ul > li:first-child > a[href="docs/install.html"]'],
  "docs/tour.html": ["article math mtr + mtr", "article table td", 'article img[src$=".png"]', 'article img[src$=".svg"]', 'a[href$="/tour.ipynb"]'],
  "docs/films.html": ['article img[src$=".png"]', ".highlight-text"],
  "python.html": ['a[href="python/System.html"]', 'a[href="python/functions.html"]', 'a[href="python/errors.html"]'],
  "python/System.html": ["#deltaq\\.System", "#deltaq\\.System\\.solve"],
};

async function looked(path, [name, width, scheme]) {
  at = `${path}, ${name}`;
  await page.setViewport({ width, height: 860 });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await page.goto(root + path, { waitUntil: "load" });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  if (wide > width) complain(`${wide} px wide`);
  for (const part of HAVE[path] ?? []) if (!(await page.$(part))) complain(`has no ${part}`);
  await page.evaluate(rules);
  const { violations, passes } = await page.evaluate(() => window.axe.run({ resultTypes: ["violations"] }));
  for (const { id, impact, nodes } of violations) {
    if (["serious", "critical"].includes(impact)) complain(`${id}, ${nodes.length} times: ${nodes[0].html.slice(0, 160)}`);
  }
  counts.pages += 1;
  counts.rules += passes.length;
}

for (const path of pagesIn(site)) {
  await looked(path, NARROW);
  const name = path.replace(/\.html$/, "");
  for (const look of PICTURED.includes(name) ? LOOKS : []) {
    await looked(path, look);
    await page.screenshot({ path: join(pictures, `${name.replaceAll("/", "-")}-${look[0]}.png`) });
  }
}
await browser.close();
server.close();
console.log(`${counts.pages} looks at pages, ${counts.rules} rules of axe hold`);
if (complaints.length || counts.pages < PICTURED.length * (1 + LOOKS.length)) {
  console.error([...new Set(complaints)].join("\n"));
  process.exit(1);
}
