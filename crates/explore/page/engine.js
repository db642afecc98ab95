// The program in workers: one for motions, one for what takes longer, so that sliders never wait for it.

// Milliseconds after which a question is cancelled for a newer one of its kind.
const PATIENCE = 3000;

// Unzips data of the page from the base64 of its bytes.
async function unzipped(base64, type) {
  const { body } = await fetch(`data:application/octet-stream;base64,${base64.trim()}`);
  return new Response(body.pipeThrough(new DecompressionStream("gzip")), { headers: { "content-type": type } });
}

// The program, compiled while it is unzipped.
export const compile = async (base64) => WebAssembly.compileStreaming(unzipped(base64, "application/wasm"));

export const textOf = async (base64) => (await unzipped(base64, "text/plain")).text();

// A module of the page that is not needed at first.
export async function load(base64) {
  const url = URL.createObjectURL(await (await unzipped(base64, "text/javascript")).blob());
  return import(url);
}

export class Engine {
  constructor(module, source) {
    this.module = module;
    this.url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    this.count = 0;
    this.waiting = new Map();
  }

  spawn() {
    this.worker = new Worker(this.url);
    this.worker.postMessage({ module: this.module });
    this.worker.onmessage = ({ data }) => this.arrived(data);
  }

  // The newest question of a kind takes the place of one that waits; the promise of that gives null.
  ask(kind, question) {
    return new Promise((resolve) => {
      this.waiting.get(kind)?.resolve(null);
      this.waiting.set(kind, { kind, question, resolve });
      const slow = this.current && this.current.kind === kind && performance.now() - this.current.began > PATIENCE;
      if (slow) this.stop();
      this.next();
    });
  }

  next() {
    if (this.current || !this.waiting.size) return;
    const [kind, asked] = this.waiting.entries().next().value;
    this.waiting.delete(kind);
    // not before it is needed: the first motion does not wait for a second worker
    if (!this.worker) this.spawn();
    this.current = { ...asked, id: ++this.count, began: performance.now() };
    this.worker.postMessage({ id: this.count, question: JSON.stringify(asked.question) });
  }

  arrived({ id, ...reply }) {
    const { resolve } = this.current;
    if (id !== this.current.id) return;
    this.current = null;
    resolve(reply);
    this.next();
  }

  // Ends what is under way.
  stop() {
    if (!this.current) return;
    this.worker.terminate();
    this.worker = null;
    const { resolve } = this.current;
    this.current = null;
    resolve(null);
    this.next();
  }

  // Ends that, and what waits for it.
  forget() {
    for (const { resolve } of this.waiting.values()) resolve(null);
    this.waiting.clear();
    this.stop();
  }
}
