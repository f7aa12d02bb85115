// A cloud of hands in a plane: points on one canvas, marks on another above it.

import { extent } from "d3-array";
import { axisBottom, axisLeft } from "d3-axis";
import { scaleLinear } from "d3-scale";
import { select } from "d3-selection";
import { make, onResize } from "./dom.js";
import { colour, fit, isPrinting, scoreColour } from "./theme.js";

const SVG = "http://www.w3.org/2000/svg";
const SHADES = 32;
const NEAR = 24; // pixels within which a click finds a point

export class Scatter {
  /**
   * @param view {title, x, y, xLabel, yLabel, scores?, axes}: x, y and scores by row.
   */
  constructor(host, state, view) {
    Object.assign(this, { state, view, width: 0 });
    this.points = make("canvas", { "aria-hidden": "true" });
    this.marks = make("canvas", { "aria-hidden": "true" });
    this.axes = document.createElementNS(SVG, "svg");
    this.box = make(
      "div",
      { class: "plot", tabindex: "0", role: "group", onkeydown: (e) => this.#key(e) },
      this.points, this.marks, this.axes,
    );
    this.box.addEventListener("click", (event) => this.#click(event));
    this.box.style.aspectRatio = 1 / this.#slope(); // its place is kept before it is drawn
    host.append(this.box);
    this.setView(view);
    onResize(this.box, (width) => this.#resize(width));
    state.on("select", () => this.drawMarks());
    state.on("filter", () => this.drawPoints());
  }

  /** Shows other values in the same place. */
  setView(view) {
    this.view = { ...this.view, ...view };
    this.box.setAttribute("aria-label", `${this.view.title}. Arrow keys go to a neighbouring hand.`);
    if (this.width) this.#resize(this.width);
  }

  redraw() {
    if (this.width) this.#resize(this.width);
  }

  /** Height over width. */
  #slope() {
    return this.view.axes ? 0.62 : 0.86;
  }

  #resize(width) {
    this.width = width;
    this.height = Math.round(width * this.#slope());
    const margin = this.view.axes ? { left: 42, right: 10, top: 26, bottom: 40 } : { left: 7, right: 7, top: 7, bottom: 7 };
    const scale = (values, range) => scaleLinear(padded(values), range);
    this.x = scale(this.view.x, [margin.left, width - margin.right]);
    this.y = scale(this.view.y, [this.height - margin.bottom, margin.top]);
    this.#drawAxes();
    this.drawPoints();
    this.drawMarks();
  }

  #drawAxes() {
    const axes = this.view.axes ? [axisBottom(this.x).ticks(6), axisLeft(this.y).ticks(6)] : [];
    const svg = select(this.axes).attr("viewBox", [0, 0, this.width, this.height]);
    svg.selectAll("*").remove();
    if (!axes.length) return;
    svg.append("g").attr("transform", `translate(0,${this.height - 40})`).call(axes[0]);
    svg.append("g").attr("transform", "translate(42,0)").call(axes[1]);
    const label = (text) => svg.append("text").attr("class", "axis-label").text(text);
    label(this.view.xLabel).attr("x", this.width - 10).attr("y", this.height - 6).attr("text-anchor", "end");
    label(this.view.yLabel).attr("x", 8).attr("y", 16);
  }

  drawPoints() {
    if (!this.width) return;
    const context = fit(this.points, this.width, this.height);
    const size = this.state.count > 2000 ? 2 : this.state.count > 300 ? 3 : 5;
    for (const [paint, rows, shape] of this.#layers()) {
      context.fillStyle = paint;
      for (const row of rows) {
        const x = this.x(this.view.x[row]), y = this.y(this.view.y[row]);
        if (Number.isNaN(x + y)) continue;
        if (shape === "cross") cross(context, x, y, size + 1);
        else context.fillRect(x - size / 2, y - size / 2, size, size);
      }
    }
  }

  /** Rows by the colour that they are painted in, hindmost first. */
  #layers() {
    return this.view.leaders ? this.#clusterLayers() : this.#scoreLayers();
  }

  #clusterLayers() {
    const { cluster } = this.state.run.candidates;
    const layers = [colour("faint"), colour("muted"), ...[0, 1, 2, 3, 4].map((i) => colour(`curve-${i}`))].map((paint) => [paint, []]);
    for (let row = 0; row < this.state.count; row++) {
      const shown = cluster[row] < 0 ? 1 : 2 + (cluster[row] % 5);
      layers[this.state.passing[row] ? shown : 0][1].push(row);
    }
    return layers;
  }

  #scoreLayers() {
    const { candidates } = this.state.run;
    const outside = [], plain = [], front = [];
    const shades = Array.from({ length: SHADES + 1 }, () => []);
    for (let row = 0; row < this.state.count; row++) {
      const score = this.view.scores?.[row];
      if (!this.state.passing[row]) outside.push(row);
      else if (score !== undefined && !Number.isNaN(score)) shades[Math.round((score / 100) * SHADES)].push(row);
      else if (candidates.front[row] && !this.view.scores) front.push(row);
      else plain.push(row);
    }
    const shaded = shades.map((rows, i) => [scoreColour((100 * i) / SHADES), rows]);
    return [[colour("faint"), outside], [colour("muted"), plain], ...shaded, [colour("front"), front, "cross"]];
  }

  drawMarks() {
    if (!this.width) return;
    const context = isPrinting() ? this.points.getContext("2d") : fit(this.marks, this.width, this.height);
    const { chosen, clusters } = this.state.run;
    if (this.view.leaders) clusters.forEach(({ row }, i) => this.#label(context, row, `${i + 1}`));
    if (chosen !== null) this.#ring(context, chosen, colour("chosen"), 10, true);
    if (this.state.selected !== null) this.#ring(context, this.state.selected, colour("selected"), 6, false);
  }

  #ring(context, row, paint, radius, square) {
    const x = this.x(this.view.x[row]), y = this.y(this.view.y[row]);
    if (Number.isNaN(x + y)) return;
    for (const [style, width] of [[colour("paper"), 5], [paint, 2.5]]) {
      context.beginPath();
      if (square) context.rect(x - radius, y - radius, 2 * radius, 2 * radius);
      else context.arc(x, y, radius, 0, 2 * Math.PI);
      context.strokeStyle = style;
      context.lineWidth = width;
      context.stroke();
    }
  }

  #label(context, row, text) {
    const x = this.x(this.view.x[row]), y = this.y(this.view.y[row]);
    context.font = "bold 13px system-ui, sans-serif";
    context.lineWidth = 4;
    context.strokeStyle = colour("paper");
    context.fillStyle = colour("ink");
    context.strokeText(text, x + 7, y - 7);
    context.fillText(text, x + 7, y - 7);
  }

  /** Where a hand lies in this plot [CSS pixels]. */
  place(row) {
    return [this.x(this.view.x[row]), this.y(this.view.y[row])];
  }

  #click(event) {
    if (!this.width) return; // not drawn yet
    const box = this.box.getBoundingClientRect();
    const [row, distance] = this.#nearest(event.clientX - box.left, event.clientY - box.top, () => true);
    if (distance <= NEAR) this.state.select(row);
  }

  #key(event) {
    const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!direction || !this.width || this.state.selected === null) return;
    event.preventDefault();
    const [x0, y0] = this.place(this.state.selected);
    const ahead = (x, y) => {
      const along = (x - x0) * direction[0] + (y - y0) * direction[1];
      return along > 0.5 && along >= Math.abs((x - x0) * direction[1] + (y - y0) * direction[0]);
    };
    this.state.select(this.#nearest(x0, y0, ahead)[0]);
  }

  /** The nearest passing hand that `allowed` lets through, and its distance [CSS pixels]. */
  #nearest(x0, y0, allowed) {
    let best = [null, Infinity];
    for (let row = 0; row < this.state.count; row++) {
      if (!this.state.passing[row]) continue;
      const [x, y] = this.place(row);
      const distance = Math.hypot(x - x0, y - y0);
      if (distance < best[1] && allowed(x, y)) best = [row, distance];
    }
    return best;
  }
}

function padded(values) {
  const [low = 0, high = 1] = extent(values);
  const margin = 0.03 * (high - low) || 1;
  return [low - margin, high + margin];
}

function cross(context, x, y, size) {
  context.fillRect(x - size / 2, y - 1, size, 2);
  context.fillRect(x - 1, y - size / 2, 2, size);
}
