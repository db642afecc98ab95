// What a link carries: everything that was chosen, in the fragment of the address.

const EMPTY = { scene: "sledge", text: null, set: {}, off: [], on: [], time: 0, tab: "numbers", curve: "gap" };

export const state = { ...EMPTY };

const bytesOf = (text) => new TextEncoder().encode(text);

// JSON without what is as at the beginning, in base64 for addresses.
export function encode() {
  const kept = Object.entries(state).filter(([key, value]) => JSON.stringify(value) !== JSON.stringify(EMPTY[key]));
  const bytes = bytesOf(JSON.stringify(Object.fromEntries(kept)));
  const base64 = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return base64.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

// Takes over what a fragment says, which may be the name of a scene only, scene=NAME; one that says nothing
// readable is as nothing at all, and why comes back; else null.
export function decode(fragment, otherwise = {}) {
  const named = /^#scene=([\w-]+)$/.exec(fragment);
  let said = named ? { scene: named[1] } : {};
  let fault = null;
  try {
    if (named) fragment = "";
    const base64 = fragment.replace(/^#/, "").replaceAll("-", "+").replaceAll("_", "/");
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    if (bytes.length) said = JSON.parse(new TextDecoder().decode(bytes));
    if (typeof said !== "object" || said === null) throw new TypeError("no object");
  } catch {
    [said, fault] = [{}, "it is cut off or damaged"];
  }
  Object.assign(state, structuredClone(EMPTY), otherwise);
  for (const key of Object.keys(EMPTY)) {
    if (key in said && (EMPTY[key] === null || typeof said[key] === typeof EMPTY[key])) state[key] = said[key];
  }
  const numbers = Object.entries(state.set).filter(([, x]) => Number.isFinite(x));
  if (numbers.length < Object.keys(state.set).length) fault = "a number in it is none";
  state.set = Object.fromEntries(numbers);
  return fault;
}

let timer;

const write = () => history.replaceState(null, "", `#${encode()}`);

// Writes the state into the address, a little later.
export function remember() {
  clearTimeout(timer);
  timer = setTimeout(write, 250);
}

// Nothing is written any more.
export const forget = () => clearTimeout(timer);

// What `change` makes of the state has a place of its own in the history: the way back leads to what was before.
export function turn(change) {
  clearTimeout(timer);
  write();
  change();
  history.pushState(null, "", `#${encode()}`);
}
