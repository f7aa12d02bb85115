// Curves over one axis, with a mark for the selected hand.

import { max } from "d3-array";
import { axisBottom, axisLeft } from "d3-axis";
import { scaleLinear } from "d3-scale";
import { pointer, select } from "d3-selection";
import { line } from "d3-shape";
import { make, onResize } from "./dom.js";

const DASHES = ["", "7 3", "2 3", "9 3 2 3", "4 4"];
const MARGIN = { left: 46, right: 12, top: 28, bottom: 40 };
const HEIGHT = 250;

export class Lines {
  /**
   * @param view {title, x, curves: [{name, y}], xLabel, yLabel, yRange?, marks(row): [{x, curve}], find(x, curve): row};
   *   without a range y is a share, from 0 to 1; without marks and find there are no hands to mark.
   */
  constructor(host, state, view) {
    Object.assign(this, { state, view, width: 0 });
    this.box = make("div", { class: "plot lines" });
    host.append(this.box, this.#legend());
    this.svg = select(this.box).append("svg").attr("role", "img").attr("aria-label", view.title);
    if (view.find) this.svg.on("click", (event) => this.#click(event));
    onResize(this.box, (width) => this.#draw(width));
    state.on("select", () => this.#mark());
  }

  redraw() {
    if (this.width) this.#draw(this.width);
  }

  #legend() {
    const items = this.view.curves.map(({ name }, i) =>
      make("li", {}, make("span", { class: `key curve-${i % 5}`, "aria-hidden": "true" }), name));
    return make("ul", { class: "legend" }, ...items);
  }

  #draw(width) {
    this.width = width;
    this.box.style.aspectRatio = width / HEIGHT;
    const { view, svg } = this;
    svg.attr("viewBox", [0, 0, width, HEIGHT]).selectAll("*").remove();
    this.x = scaleLinear([Math.min(0, view.x[0] ?? 0), max(view.x) || 1], [MARGIN.left, width - MARGIN.right]);
    this.y = scaleLinear(view.yRange ?? [0, 1], [HEIGHT - MARGIN.bottom, MARGIN.top]);
    const upright = view.yRange ? axisLeft(this.y).ticks(5) : axisLeft(this.y).ticks(5, "%");
    svg.append("g").attr("transform", `translate(0,${HEIGHT - MARGIN.bottom})`).call(axisBottom(this.x).ticks(width / 90));
    svg.append("g").attr("transform", `translate(${MARGIN.left},0)`).call(upright);
    const label = (text) => svg.append("text").attr("class", "axis-label").attr("text-anchor", "end").text(text);
    label(view.xLabel).attr("x", width - MARGIN.right).attr("y", HEIGHT - 6);
    label(view.yLabel).attr("text-anchor", "start").attr("x", 8).attr("y", 16);
    view.curves.forEach(({ y }, i) => {
      const path = line().defined((v) => !Number.isNaN(v)).x((_, k) => this.x(view.x[k])).y((v) => this.y(v));
      svg.append("path").attr("class", `curve curve-${i % 5}`).attr("stroke-dasharray", DASHES[i % 5]).attr("d", path(y));
    });
    this.marks = svg.append("g");
    this.#mark();
  }

  #mark() {
    if (!this.width) return;
    this.marks.selectAll("*").remove();
    if (this.state.selected === null) return;
    for (const { x, curve } of this.view.marks(this.state.selected)) {
      if (!(x >= this.x.domain()[0])) continue;
      const y = this.view.curves[curve].y[nearestIndex(this.view.x, x)];
      this.marks.append("line").attr("class", "drop").attr("x1", this.x(x)).attr("x2", this.x(x))
        .attr("y1", this.y(0)).attr("y2", this.y(y));
      this.marks.append("circle").attr("class", "mark").attr("r", 5).attr("cx", this.x(x)).attr("cy", this.y(y));
    }
  }

  #click(event) {
    if (!this.width) return; // not drawn yet
    const [px, py] = pointer(event, this.svg.node());
    const x = this.x.invert(px);
    const at = nearestIndex(this.view.x, x);
    const distances = this.view.curves.map(({ y }) => Math.abs(this.y(y[at]) - py));
    const row = this.view.find(x, distances.indexOf(Math.min(...distances)));
    if (row !== null) this.state.select(row);
  }
}

/** Index of the value in rising `values` that is nearest to x. */
function nearestIndex(values, x) {
  let best = 0;
  for (let i = 1; i < values.length; i++) if (Math.abs(values[i] - x) < Math.abs(values[best] - x)) best = i;
  return best;
}
