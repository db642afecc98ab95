// How the picture is looked at: the camera rests or goes with a motion, and differences are drawn as they are or larger.

import { REST } from "./stage.js";
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
    const labels = ["", REST, ...motions.map(({ label }) => label)];
    const names = { "": "on the bodies", [REST]: "at rest" };
    if (labels.join("\n") !== [...this.follow.options].map(({ value }) => value).join("\n")) {
      this.follow.replaceChildren(...labels.map((label) => new Option(names[label] ?? `with ${label}`, label)));
    }
    this.follow.value = labels.includes(state.follow) ? state.follow : "";
  }

  // What the state says.
  put() {
    this.by.value = String(state.by);
    this.stage.look(state.follow, state.by);
  }
}
