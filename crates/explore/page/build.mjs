// node build.mjs PROGRAM.wasm DELTAQ OUT.html DIGEST: one page of everything.

import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

import { build } from "esbuild";

import { EXAMPLES } from "./examples.js";

const [program, deltaq, out, digest] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const read = (name) => readFileSync(join(here, name), "utf8");

async function bundled(entry, more = {}) {
  const options = { entryPoints: [join(here, entry)], bundle: true, minify: true, write: false, charset: "utf8", legalComments: "none" };
  const { outputFiles } = await build({ format: "iife", target: "es2022", ...options, ...more });
  return outputFiles[0].text;
}

// What stands within an element of the page cannot end that element.
const script = (text) => text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const markup = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

const said = (...words) => execFileSync(deltaq, words, { encoding: "utf8", maxBuffer: 1 << 26 });
const { scenes } = JSON.parse(said("list", "--format", "json"));
// Every word that the schema of scenes knows as a key.
const keysOf = (schema) => Object.entries(schema ?? {}).flatMap(([key, value]) => [
  ...(key === "properties" ? Object.keys(value) : []), ...(typeof value === "object" ? keysOf(value) : [])]);
const keys = [...new Set(keysOf(JSON.parse(said("new", "--schema"))))].sort();
const examples = [
  { name: "A system in formulas, instead of this text", whole: true, text: said("new") },
  { name: "A robot of bodies, instead of this text", whole: true, text: said("new", "--bodies") }, ...EXAMPLES];
const texts = scenes.map(({ name, title, source, group }) => ({ name, title, source, group, text: said("show", name, "--source") }));

const parts = ["uplot", "katex"].map((name) => {
  const { version, license } = JSON.parse(read(`node_modules/${name}/package.json`));
  return `${name} ${version} (${license})\n\n${read(`node_modules/${name}/LICENSE`)}`;
});

// A program without its sections of names and notes, which it does not need to run.
function bare(bytes) {
  const parts = [bytes.subarray(0, 8)];
  for (let at = 8, end; at < bytes.length; at = end) {
    let [length, place, shift] = [0, at + 1, 0];
    do length += (bytes[place] & 127) * 2 ** shift; while (((shift += 7), bytes[place++] & 128));
    end = place + length;
    if (bytes[at] !== 0) parts.push(bytes.subarray(at, end));
  }
  return Buffer.concat(parts);
}

const zipped = (bytes) => gzipSync(bytes, { level: 9 }).toString("base64");

const pieces = {
  digest,
  style: await bundled("style.css", { format: undefined, external: [] }),
  licences: markup(parts.join("\n\n")),
  scenes: zipped(JSON.stringify({ scenes: texts, keys, examples })),
  worker: script(await bundled("worker.js")),
  program: zipped(bare(readFileSync(program))),
  words: zipped(await bundled("words.js", { format: "esm" })),
  script: script(await bundled("main.js")),
};
// Of scripts only this one and what it makes run; nothing is fetched but what stands in the page.
pieces.policy = ["default-src 'none'", `script-src 'sha256-${createHash("sha256").update(pieces.script).digest("base64")}' 'wasm-unsafe-eval' blob:`,
  "worker-src blob:", "connect-src data:", "style-src 'unsafe-inline'", "img-src data: blob:", "font-src data:", "base-uri 'none'", "form-action 'none'"].join("; ");
const page = read("index.html").replace(/\{\{(\w+)\}\}/g, (_, name) => pieces[name]);
writeFileSync(out, page);
console.log(`${(page.length / 1e6).toFixed(2)} MB, of which ${(pieces.program.length / 1e6).toFixed(2)} MB program`);
