// The program in workers: one for motions, one for what takes longer, so that sliders never wait for it.

// After so many milliseconds a question is given up for a newer one of its kind.
const PATIENCE = 3000;

// The program, compiled, from the base64 of its gzipped bytes.
export async function compile(base64) {
  const zipped = await (await fetch(`data:application/octet-stream;base64,${base64.trim()}`)).arrayBuffer();
  const stream = new Blob([zipped]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}

export class Engine {
  constructor(module, source) {
    this.module = module;
    this.url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    this.count = 0;
    this.waiting = new Map();
    this.spawn();
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
    this.spawn();
    const { resolve } = this.current;
    this.current = null;
    resolve(null);
    this.next();
  }
}
