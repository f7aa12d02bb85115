// Up to four hands side by side, each with its own view and slider.

import { make, format } from "./dom.js";
import { Player } from "./player.js";

const MOST = 4;

export class Compare {
  constructor(host, run, openStage) {
    Object.assign(this, { host, run, openStage, rows: [] });
  }

  add(row) {
    if (row === null || this.rows.includes(row)) return;
    if (this.rows.length === MOST) this.#remove(this.host.firstElementChild, this.rows[0]);
    this.rows.push(row);
    const { candidates, scores } = this.run;
    const view = make("div", { class: "stage" }), controls = make("div");
    const lines = scores.map((s) => make("tr", {}, make("th", { scope: "row" }, s.label), make("td", {}, format(s.data[row]))));
    const close = make("button", { type: "button", onclick: () => this.#remove(card, row) }, "Remove");
    const title = make("h3", {}, `Hand ${candidates.id[row]}, mean ${format(candidates.mean[row])} `);
    const card = make("article", { class: "card" }, title, close, view, controls, make("table", {}, ...lines));
    this.host.append(card);
    card.stage = this.openStage(view);
    card.player = new Player(controls, { run: this.run, selected: row, on() {} }, card.stage);
  }

  /** Shows the paths of a hand that have come since it was put here. */
  reload(row) {
    this.host.children[this.rows.indexOf(row)]?.player.reload();
  }

  #remove(card, row) {
    card.stage?.dispose();
    card.remove();
    this.rows = this.rows.filter((kept) => kept !== row);
  }
}
