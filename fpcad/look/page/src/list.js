// The hands that pass the filters, sorted by a column.

import { make, format } from "./dom.js";

const SHOWN = 30;

export class List {
  constructor(host, controls, state) {
    Object.assign(this, { host, state });
    const { run } = state;
    const mean = { label: "mean score", unit: "", data: run.candidates.mean, better: "larger" };
    this.columns = [mean, ...run.metrics, ...run.scores, ...run.parameters];
    const options = this.columns.map((c, i) => make("option", { value: i }, c.label));
    this.by = make("select", { onchange: () => this.show(true) }, ...options);
    this.order = make("select", { onchange: () => this.show() }, make("option", { value: "-1" }, "largest first"), make("option", { value: "1" }, "smallest first"));
    controls.append(make("label", {}, "sort by ", this.by), make("label", {}, "order ", this.order));
    state.on("filter", () => this.show());
    state.on("select", () => this.#mark());
    this.show();
  }

  show(natural = false) {
    const column = this.columns[+this.by.value];
    if (natural) this.order.value = column.better === "smaller" ? "1" : "-1";
    const sign = +this.order.value, { data } = column;
    const rows = Array.from(data.keys()).filter((row) => this.state.passing[row] && !Number.isNaN(data[row]));
    rows.sort((a, b) => sign * (data[a] - data[b]) || a - b);
    const shown = [column, ...this.columns.filter((c) => c !== column).slice(0, 5)];
    const head = make("tr", {}, ...["hand", ...shown.map((c) => (c.unit ? `${c.label} [${c.unit}]` : c.label))].map((t) => make("th", { scope: "col" }, t)));
    const lines = rows.slice(0, SHOWN).map((row) => this.#line(row, shown));
    const count = make("caption", {}, `${rows.length} hands pass; the first ${lines.length}`);
    this.host.replaceChildren(make("table", { class: "wide" }, count, make("thead", {}, head), make("tbody", {}, ...lines)));
    this.#mark();
  }

  #line(row, shown) {
    const go = make("button", { type: "button", onclick: () => this.state.select(row) }, `${this.state.run.candidates.id[row]}`);
    return make("tr", { "data-hand": row }, make("td", {}, go), ...shown.map((c) => make("td", {}, format(c.data[row]))));
  }

  #mark() {
    for (const line of this.host.querySelectorAll("tr[data-hand]"))
      line.classList.toggle("current", +line.dataset.hand === this.state.selected);
  }
}
