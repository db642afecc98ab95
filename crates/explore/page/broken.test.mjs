// Where the program of the page breaks off, the worker says so and answers the next question with a new instance.

import { readFileSync } from "node:fs";
import { createContext, runInContext } from "node:vm";

// A module with the exports of the program. Every question is answered by {}, but one that begins with "x": there it stores a
// mark, by which from then on its text is what SAID says, and traps. A new instance has no mark.
const MODULE =
  "AGFzbQEAAAABDQNgAAF/YAF/AX9gAAADBwYBAgAAAAAFAwEAAQdUBwZtZW1vcnkCAAtxdWVzdGlvbl9hdAAAA2FzawABB3RleHRfYXQAAgt0ZXh0X2xlbmd0aAAD" +
  "Cm51bWJlcnNfYXQABA5udW1iZXJzX2xlbmd0aAAFCksGBQBBgAgLFwBBgQgtAABB+ABGBEBBAEEBNgIAAAsLEABBACgCAAR/QRAFQYACCwsQAEEAKAIABH9BwAAF" +
  "QQILCwQAQQgLBABBAAsLTgIAQRALQGJyb2tlbiwgYXQgeC5yczoxOjE6IHRoaXMgaXMgYSBmYXVsdCBvZiBkZWx0YXE7IHBsZWFzZSByZXBvcnQgaXQAQYACCwJ7fQ==";
const SAID = "broken, at x.rs:1:1: this is a fault of deltaq; please report it";

export async function broken({ must }) {
  const replies = [];
  const worker = createContext({
    WebAssembly, TextEncoder, TextDecoder, Uint8Array, Float64Array, performance,
    postMessage: ({ answer }) => replies.push(answer),
  });
  runInContext(readFileSync(new URL("worker.js", import.meta.url), "utf8"), worker);
  worker.onmessage({ data: { module: new WebAssembly.Module(Buffer.from(MODULE, "base64")) } });
  for (const question of ['"a"', '"x"', '"a"']) worker.onmessage({ data: { id: 1, question } });
  const [before, said, after] = replies.map((answer) => JSON.stringify(answer));
  must(said === JSON.stringify({ refused: `the computation broke off: ${SAID}` }), `a computation that breaks off says ${said}`);
  must(before === "{}" && after === "{}", `after one that broke off another one says ${after}`);
}
