// The selected hand in numbers.

import { make, format } from "./dom.js";

export class Numbers {
  constructor(host, state) {
    Object.assign(this, { host, state });
    state.on("select", () => this.show());
    this.show();
  }

  show() {
    const { run, selected: row } = this.state;
    if (row === null) return this.host.replaceChildren("There is no candidate yet.");
    const { id, front, cluster, measured, makeable, mean } = run.candidates;
    const rank = front[row] ? "on the Pareto front" : makeable[row] ? "dominated" : `cannot be made: ${this.#reason(row)}`;
    const said = [
      row === run.chosen ? "chosen" : null,
      measured[row] ? rank : "not measured yet",
      cluster[row] >= 0 ? `cluster ${cluster[row] + 1}` : null,
      measured[row] ? `mean score ${format(mean[row])}` : null,
    ];
    this.host.replaceChildren(
      make("h3", { id: "selected-title" }, `Hand ${id[row]}`),
      make("p", {}, said.filter(Boolean).join(", ")),
      this.#design(run, row), ...run.poses.map((pose) => this.#pose(run, pose, row)),
    );
  }

  #reason(row) {
    const { words, codes } = this.state.run.candidates.reason;
    return codes.length ? words[codes[0][row]] : "";
  }

  #design(run, row) {
    return table("Design", run.parameters.map((c) => [c.label, `${format(c.data[row])} ${c.unit}`]));
  }

  #pose(run, pose, row) {
    const ofPose = (column) => column.pose === pose.name;
    const bare = (column) => column.label.replace(`${pose.name}: `, "");
    const metrics = run.metrics.filter(ofPose).map((c) => [bare(c), `${format(c.data[row], digits(c))} ${c.unit}`]);
    const scores = run.scores.filter(ofPose).map((c) => [`score of ${bare(c)}`, format(c.data[row])]);
    const ends = run.ends[pose.name];
    const stops = ends ? [["path ends by", `− ${ends.words[ends.codes[0][row]]}, + ${ends.words[ends.codes[1][row]]}`]] : [];
    return table(pose.name, [...metrics, ...stops, ...scores]);
  }
}

function digits({ unit }) {
  return { "N mm": 0, "mm/s": 2, N: 2 }[unit] ?? 1;
}

function table(caption, rows) {
  const lines = rows.map(([name, value]) => make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, value)));
  return make("table", {}, make("caption", {}, caption), ...lines);
}
