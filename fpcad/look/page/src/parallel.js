// Parallel coordinates: a line for each hand, an axis for each parameter and score, brushable.

import { brushY } from "d3-brush";
import { axisLeft } from "d3-axis";
import { scaleLinear } from "d3-scale";
import { select } from "d3-selection";
import { make, format, onResize } from "./dom.js";
import { colour, fit, isPrinting } from "./theme.js";

const HEIGHT = 340;
const TOP = 112;
const BOTTOM = 14;
const SPACING = 58; // least pixels between two axes
const CHUNK = 1500; // lines drawn between two frames
const NEAR = 12;

export class Parallel {
  /** @param columns {name, label, unit, data, range} of each axis; `others` have filters only. */
  constructor(host, state, columns, others = []) {
    Object.assign(this, { state, columns, others, width: 0, drawing: 0 });
    this.lines = make("canvas", { "aria-hidden": "true" });
    this.marks = make("canvas", { "aria-hidden": "true" });
    this.box = make("div", { class: "plot parallel" }, this.lines, this.marks);
    this.box.style.height = `${HEIGHT}px`;
    this.svg = select(this.box).append("svg").attr("role", "img")
      .attr("aria-label", "Parallel coordinates of parameters and scores; the filters below do what brushes do.");
    this.box.addEventListener("click", (event) => this.#click(event));
    const scroller = make("div", { class: "scroller", tabindex: "0", role: "group", "aria-label": "Parallel coordinates, scrollable" }, this.box);
    host.append(scroller);
    onResize(scroller, (width) => {
      if (!this.width) host.append(this.#filters());
      this.#resize(width);
    });
    state.on("select", () => this.#drawMarks());
    state.on("filter", () => this.#drawLines());
  }

  redraw() {
    if (this.width) this.#resize(this.width);
  }

  #resize(outer) {
    this.width = Math.max(outer, SPACING * this.columns.length);
    const step = (this.width - 64) / Math.max(this.columns.length - 1, 1);
    this.box.style.width = `${this.width}px`;
    this.box.style.aspectRatio = this.width / HEIGHT;
    this.columns.forEach((column, i) => {
      column.x = 44 + i * step;
      column.y = scaleLinear(column.range, [HEIGHT - BOTTOM, TOP]);
    });
    this.#drawAxes();
    this.#drawLines();
    this.#drawMarks();
  }

  #drawAxes() {
    const svg = this.svg.attr("viewBox", [0, 0, this.width, HEIGHT]);
    svg.selectAll("*").remove();
    const axes = this.columns.map((column) => axisLeft(column.y).ticks(4)); // asks for the page's layout, so all at once
    for (const [i, column] of this.columns.entries()) {
      const group = svg.append("g").attr("transform", `translate(${column.x},0)`);
      group.call(axes[i]);
      group.append("text").attr("class", "axis-label").attr("text-anchor", "start").attr("transform", `translate(-2,${TOP - 10}) rotate(-38)`)
        .text(column.unit ? `${column.label} [${column.unit}]` : column.label);
      const brush = brushY().extent([[-11, TOP], [11, HEIGHT - BOTTOM]])
        .on("end", ({ selection, sourceEvent }) => sourceEvent && this.#brushed(column, selection));
      group.append("g").attr("class", "brush").call(brush);
      column.brush = { group: group.select(".brush"), brush };
      this.#showBrush(column);
    }
  }

  #brushed(column, selection) {
    const range = selection && [column.y.invert(selection[1]), column.y.invert(selection[0])];
    [column.low.value, column.high.value] = range ? range.map((v) => v.toFixed(2)) : ["", ""];
    this.state.limit(column, range);
  }

  #showBrush(column) {
    if (!column.brush) return;
    const limit = this.state.limits.get(column.name)?.range;
    const inside = limit && limit.map((v) => Math.min(Math.max(v, column.range[0]), column.range[1]));
    column.brush.group.call(column.brush.brush.move, inside ? [column.y(inside[1]), column.y(inside[0])] : null);
  }

  /** Number fields that do what the brushes do, for the keyboard. */
  #filters() {
    const rows = [...this.columns, ...this.others].map((column) => {
      const field = (name, word) => (column[name] = make("input", {
        type: "number", step: "any", "aria-label": `${column.label}, ${word}`, onchange: () => this.#typed(column),
      }));
      const low = field("low", "at least"), high = field("high", "at most");
      const unit = column.unit ? ` ${column.unit}` : "";
      const span = `${format(column.range[0])} to ${format(column.range[1])}${unit}`;
      return make("div", { class: "filter" }, make("span", {}, column.label), low, high, make("small", {}, span));
    });
    const clear = make("button", { type: "button", onclick: () => this.#clear() }, "Clear all filters");
    return make("details", { class: "filters" }, make("summary", {}, "Filters"), ...rows, clear);
  }

  #typed(column) {
    const { low, high } = column;
    const range = [low.value === "" ? -Infinity : +low.value, high.value === "" ? Infinity : +high.value];
    this.state.limit(column, low.value === "" && high.value === "" ? null : range);
    this.#showBrush(column);
  }

  #clear() {
    for (const column of [...this.columns, ...this.others]) {
      column.low.value = column.high.value = "";
      if (this.state.limits.has(column.name)) this.state.limit(column, null);
      this.#showBrush(column);
    }
  }

  /** Draws in pieces, so that the page goes on answering. */
  #drawLines() {
    if (!this.width) return;
    const context = fit(this.lines, this.width, HEIGHT);
    const { front } = this.state.run.candidates;
    const all = Array.from({ length: this.state.count }, (_, row) => row).filter((row) => this.state.passing[row]);
    const ordered = [...all.filter((row) => !front[row]), ...all.filter((row) => front[row])];
    const paints = [colour("muted"), colour("front")];
    context.globalAlpha = Math.min(1, Math.max(0.06, 40 / (ordered.length + 1)));
    const turn = ++this.drawing;
    const piece = (from) => {
      if (turn !== this.drawing) return;
      for (const row of ordered.slice(from, from + CHUNK)) {
        context.strokeStyle = paints[front[row]];
        this.#trace(context, row);
      }
      if (from + CHUNK >= ordered.length) return;
      if (isPrinting()) piece(from + CHUNK);
      else requestAnimationFrame(() => piece(from + CHUNK));
    };
    piece(0);
  }

  #drawMarks() {
    if (!this.width) return;
    const context = isPrinting() ? this.lines.getContext("2d") : fit(this.marks, this.width, HEIGHT);
    context.globalAlpha = 1;
    const { chosen } = this.state.run;
    const marked = [[chosen, colour("chosen")], [this.state.selected, colour("selected")]];
    for (const [row, paint] of marked.filter(([row]) => row !== null)) {
      for (const [style, width] of [[colour("paper"), 5], [paint, 2.5]]) {
        context.strokeStyle = style;
        context.lineWidth = width;
        this.#trace(context, row);
      }
    }
  }

  #trace(context, row) {
    context.beginPath();
    let open = false;
    for (const { x, y, data } of this.columns) {
      if (Number.isNaN(data[row])) open = false;
      else if (open) context.lineTo(x, y(data[row]));
      else (context.moveTo(x, y(data[row])), (open = true));
    }
    context.stroke();
  }

  #click(event) {
    if (!this.width || event.target.closest?.(".brush")) return;
    const box = this.box.getBoundingClientRect();
    const x = event.clientX - box.left, y = event.clientY - box.top;
    const right = Math.min(Math.max(this.columns.findIndex((c) => c.x >= x), 1), this.columns.length - 1);
    const [a, b] = [this.columns[right - 1], this.columns[right]];
    const share = (x - a.x) / (b.x - a.x);
    let best = [null, NEAR];
    for (let row = 0; row < this.state.count; row++) {
      if (!this.state.passing[row]) continue;
      const at = (1 - share) * a.y(a.data[row]) + share * b.y(b.data[row]);
      if (Math.abs(at - y) < best[1]) best = [row, Math.abs(at - y)];
    }
    if (best[0] !== null) this.state.select(best[0]);
  }
}
