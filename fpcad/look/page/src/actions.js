// What can be done with the selected hand: keep it beside, export it, and, live, choose it.

import { unpack } from "./data.js";
import { make } from "./dom.js";
import { exactPaths } from "./motion.js";

export class Actions {
  constructor(host, state, stage, player, compare, exporter) {
    Object.assign(this, { state, stage, player, compare, exporter });
    const button = (text, act) => make("button", { type: "button", onclick: act }, text);
    host.append(button("Keep beside", () => compare.add(state.selected)));
    if (stage) host.append(button("Save PNG", () => this.#png()), button("Save GLB", () => this.#glb()));
    if (!state.run.token) return;
    host.append(button("Select this one", () => this.#choose()));
    state.on("select", (row) => this.#fetchPaths(row));
    if (state.selected !== null) this.#fetchPaths(state.selected);
  }

  get #id() {
    return this.state.run.candidates.id[this.state.selected];
  }

  #say(text) {
    document.getElementById("outcome").textContent = text;
  }

  #png() {
    this.stage.render();
    this.stage.canvas.toBlob((blob) => save(blob, `hand-${this.#id}.png`));
  }

  async #glb() {
    const binary = await this.exporter.parseAsync([this.stage.hand.group, this.stage.inTool], { binary: true, onlyVisible: true });
    save(new Blob([binary], { type: "model/gltf-binary" }), `hand-${this.#id}.glb`);
  }

  /** Asks the live view's server for a hand's paths and shows them when they come. */
  async #fetchPaths(row) {
    const { run } = this.state;
    if (exactPaths(run, row).length) return;
    const answer = await fetch(`paths?id=${run.candidates.id[row]}`);
    const told = await answer.json();
    if (!answer.ok) return this.#say(told.error);
    run.exact.push(...(await unpack({ exact: told.exact }, "traced", told.block)).exact);
    if (this.state.selected === row) this.player.reload();
    this.compare.reload(row);
  }

  async #choose() {
    const id = this.#id;
    if (!confirm(`Make hand ${id} the chosen one, and export its parts and trajectories anew?`)) return;
    this.#say(`Exporting hand ${id} …`);
    const answer = await fetch("select", {
      method: "POST", body: JSON.stringify({ id }), headers: { "X-Fpcad-Token": this.state.run.token },
    });
    const told = await answer.json();
    if (!answer.ok) return this.#say(told.error);
    this.#say(told.chosen === id ? `Hand ${id} is chosen and exported. Reload to see its parts.`
      : `Hand ${id} cannot be made; hand ${told.chosen} is chosen instead.`);
  }
}

function save(blob, name) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
