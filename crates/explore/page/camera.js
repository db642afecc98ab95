// How the picture is looked at: the camera rests or goes with a motion, and differences are drawn as they are or larger.

import { state } from "./state.js";

export class Camera {
  // `changed` is called where a hand has chosen something.
  constructor({ follow, by }, stage, changed) {
    Object.assign(this, { follow, by, stage });
    const choose = (key, value) => {
      state[key] = value;
      this.put();
      changed();
    };
    follow.addEventListener("change", () => choose("follow", follow.value));
    by.addEventListener("change", () => choose("by", Number(by.value)));
  }

  // The motions that it can go with.
  show({ motions }) {
    const labels = ["", ...motions.map(({ label }) => label)];
    if (labels.join("\n") !== [...this.follow.options].map(({ value }) => value).join("\n")) {
      this.follow.replaceChildren(...labels.map((label) => new Option(label ? `with ${label}` : "at rest", label)));
    }
    this.follow.value = labels.includes(state.follow) ? state.follow : "";
  }

  // What the state says.
  put() {
    this.by.value = String(state.by);
    this.stage.look(state.follow, state.by);
  }
}
