// The time of the animation: play, scrub, step.

export class Clock {
  // `show` draws a time.
  constructor({ button, bar, reading, speed }, show) {
    Object.assign(this, { button, bar, reading, speed, show });
    [this.start, this.end, this.t] = [0, 1, 0];
    this.playing = false;
    button.addEventListener("click", () => this.toggle());
    bar.addEventListener("input", () => this.go(this.start + (this.end - this.start) * Number(bar.value)));
  }

  span(start, end) {
    [this.start, this.end] = [start, end];
    this.go(this.t);
  }

  // Another run, from its start or a time of it, at a speed at which it takes about ten seconds at most.
  begin({ start, end }, time) {
    const speeds = [...this.speed.options].map(({ value }) => Number(value));
    this.speed.value = String(speeds.find((speed) => (end - start) / speed <= 12) ?? speeds.at(-1));
    this.t = time || start;
  }

  go(t) {
    this.t = Math.min(this.end, Math.max(this.start, t));
    const part = (this.t - this.start) / (this.end - this.start || 1);
    this.bar.value = part;
    this.bar.style.setProperty("--part", `${100 * part}%`);
    this.bar.setAttribute("aria-valuetext", `t = ${this.t.toPrecision(4)} s`);
    this.reading.textContent = `t = ${this.t.toFixed(this.end - this.start < 1 ? 4 : 2)} s`;
    this.show(this.t);
  }

  // Moves the time by this number of hundredths of the run.
  step(hundredths) {
    this.pause();
    this.go(this.t + ((this.end - this.start) * hundredths) / 100);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  pause() {
    this.playing = false;
    this.label();
  }

  play() {
    if (this.t >= this.end) this.t = this.start;
    this.playing = true;
    this.label();
    let before;
    this.rest = 0;
    const frame = (now) => {
      if (!this.playing) return;
      if (before !== undefined) {
        const next = this.t + ((now - before) / 1000) * Number(this.speed.value);
        // a second of rest at the end
        this.rest = next > this.end ? this.rest + now - before : 0;
        this.t = this.rest > 1000 ? this.start : Math.min(next, this.end);
        this.go(this.t);
      }
      before = now;
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  label() {
    this.button.textContent = this.playing ? "❚❚" : "▶";
    this.button.setAttribute("aria-label", this.playing ? "pause" : "play");
  }
}
