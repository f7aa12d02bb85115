// The view of the selected hand: pose, slider, play button.

import { make, format } from "./dom.js";
import { canShow, motionOf } from "./motion.js";

const DEG = 180 / Math.PI;
const SPEED = 40 / DEG; // turn of the tool while playing [rad/s]

let players = 0; // each has its own group of radio buttons

export class Player {
  constructor(host, state, stage) {
    Object.assign(this, { state, stage, pose: 0, playing: false, direction: 1 });
    const { poses, meshes } = state.run;
    const group = `pose-${players++}`;
    const radio = ({ name }, i) => make("label", { class: "chip" },
      make("input", { type: "radio", name: group, value: i, checked: i === 0, onchange: () => this.#setPose(i) }), name);
    this.slider = make("input", { type: "range", min: "0", step: "1", "aria-label": "Tool along its path",
      oninput: () => (this.pause(), this.show(+this.slider.value)) });
    this.button = make("button", { type: "button", class: "play", onclick: () => (this.playing ? this.pause() : this.play()) }, "Play");
    this.parts = make("input", { type: "checkbox", onchange: () => stage?.setParts(this.parts.checked, state.selected) });
    this.told = make("p", { class: "told", "aria-live": "off" });
    const reset = make("button", { type: "button", onclick: () => stage?.reset() }, "Reset view");
    const printed = meshes.length ? [make("label", { class: "chip" }, this.parts, "printed parts (chosen hand)")] : [];
    host.append(
      make("fieldset", { class: "chips" }, make("legend", { class: "hidden" }, "Pose"), ...poses.map(radio), ...printed),
      make("div", { class: "transport" }, this.button, this.slider, reset), this.told,
    );
    this.#enable(false);
    state.on("select", () => this.showSelected());
    this.showSelected();
  }

  #enable(moving) {
    this.slider.disabled = this.button.disabled = !moving;
    this.parts.disabled = !this.state.run.isWhole;
  }

  /** Shows the selected hand, as soon as the page holds what that takes. */
  showSelected() {
    const { run, selected: row } = this.state;
    this.pause();
    if (row === null) return;
    if (!canShow(run, row)) return void (this.told.textContent = "Reading the page …");
    this.stage?.showHand(row);
    this.#load();
  }

  #setPose(index) {
    this.pause();
    this.pose = index;
    this.#load();
  }

  /** Shows the same hand's path, now that it is known. */
  reload() {
    if (this.motion === undefined) this.showSelected();
    else if (!this.playing) this.#load();
  }

  #load() {
    this.motion = motionOf(this.state.run, this.state.selected, this.pose);
    this.stage?.placeTool(this.motion);
    this.slider.max = this.motion.count - 1;
    this.#enable(this.motion.count > 1);
    this.show(this.motion.start);
  }

  /** Shows the same frame in the colours of now. */
  redraw() {
    if (this.motion) this.show(this.frame);
  }

  show(frame) {
    this.frame = frame;
    const at = this.motion.at(frame), pose = this.state.run.poses[this.pose];
    this.slider.value = frame;
    const turned = `tool at ${format(at.turn * DEG)}°`;
    this.slider.setAttribute("aria-valuetext", turned);
    this.told.textContent = `${turned}. ${KINDS[this.motion.kind](at)}`;
    this.stage?.showFrame(pose, at);
    this.stage?.describe(`Hand ${this.state.run.candidates.id[this.state.selected]}, ${pose.name}, ${turned}`);
  }

  play() {
    this.playing = true;
    this.button.textContent = "Pause";
    let last = performance.now(), turn = this.motion.at(this.frame).turn;
    const step = (now) => {
      if (!this.playing) return;
      turn += (this.direction * SPEED * Math.min(now - last, 100)) / 1000;
      last = now;
      this.#advance(turn);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /** Shows the frame at a tool angle, and turns round at the ends. */
  #advance(turn) {
    let frame = this.frame;
    const { count } = this.motion;
    const ahead = (i) => this.direction * (turn - this.motion.at(i).turn) > 0;
    while (frame + this.direction >= 0 && frame + this.direction < count && ahead(frame)) frame += this.direction;
    if (frame === 0 || frame === count - 1) this.direction = frame === 0 ? 1 : -1;
    this.show(frame);
  }

  pause() {
    this.playing = false;
    this.button.textContent = "Play";
  }
}

const KINDS = {
  path: () => "Every stored state of the path.",
  keyframes: ({ forces }) => `Keyframes of the path, interpolated${forces ? "" : "; forces are shown at the pose only"}.`,
  pose: () => "The pose alone: this page holds no path of this hand, the live view does.",
};
