// What a link carries: everything that was chosen, in the fragment of the address; and the way back through it.

import { byName } from "./names.js";

const EMPTY = { scene: "sledge", text: null, set: {}, off: [], on: [], time: 0, tab: "numbers", curve: "path",
  step: 0, guess: -1, forces: false, follow: "", by: 1, grips: false };
// Behind the state, what alone is to be seen: &only=stage, for slides.
const ONLY = "&only=";

export const state = { ...EMPTY };
let only = "";

const bytesOf = (text) => new TextEncoder().encode(text);

// JSON without what is as at the beginning, in base64 for addresses.
export function encode() {
  const kept = Object.entries(state).filter(([key, value]) => JSON.stringify(value) !== JSON.stringify(EMPTY[key]));
  const bytes = bytesOf(JSON.stringify(Object.fromEntries(kept)));
  const base64 = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return base64.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

// What alone is to be seen, "stage" or nothing.
export const shownOnly = () => only;

// Takes over what a fragment says, which may be the name of a scene only, scene=NAME; one that says nothing
// readable is as nothing at all, and why comes back; else null.
export function decode(address, otherwise = {}) {
  const [fragment, view = ""] = address.split(ONLY);
  only = view === "stage" ? view : "";
  const named = /^#scene=([\w-]+)$/.exec(fragment);
  let said = named ? { scene: named[1] } : {};
  let fault = null;
  try {
    const base64 = (named ? "" : fragment).replace(/^#/, "").replaceAll("-", "+").replaceAll("_", "/");
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    if (bytes.length) said = JSON.parse(new TextDecoder().decode(bytes));
    if (typeof said !== "object" || said === null) throw new TypeError("no object");
  } catch {
    [said, fault] = [{}, "it is cut off or damaged"];
  }
  Object.assign(state, structuredClone(EMPTY), fragment.length > 1 && !fault ? {} : otherwise);
  for (const key of Object.keys(EMPTY)) {
    if (key in said && (EMPTY[key] === null || typeof said[key] === typeof EMPTY[key])) state[key] = said[key];
  }
  const numbers = Object.entries(state.set).filter(([, x]) => Number.isFinite(x));
  if (numbers.length < Object.keys(state.set).length) fault = "one of its numbers is not a number";
  state.set = byName(numbers);
  return fault;
}

let timer = null;
// Places of the history: this one, and the last one there is.
let [place, last] = [history.state?.place ?? 0, history.state?.place ?? 0];

const address = () => `#${encode()}${only && ONLY + only}`;
const write = () => history.replaceState({ place }, "", address());

// Writes the state into the address, a little later.
export function remember() {
  clearTimeout(timer);
  timer = setTimeout(() => {
    timer = null;
    write();
  }, 250);
}

// Nothing is written any more.
export function forget() {
  clearTimeout(timer);
  timer = null;
}

// Writes what is to be written, before something changes.
export function settle() {
  if (timer !== null) write();
  forget();
}

// The state as it is now has a place of its own in the history: the way back leads to what was before.
export function push() {
  forget();
  place += 1;
  last = place;
  history.pushState({ place }, "", address());
}

// `change` makes something else of the state, which has a place of its own.
export function turn(change) {
  forget();
  write();
  change();
  push();
}

// After the way back or forth: whether there is more of either.
export function arrived() {
  place = history.state?.place ?? 0;
  last = Math.max(last, place);
}

export const ways = () => ({ back: place > 0, forth: place < last });
