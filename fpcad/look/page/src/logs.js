// Runs on motors: what was measured over time, a figure for each finger.

import { make } from "./dom.js";
import { extent } from "d3-array";
import { Lines } from "./lines.js";

const ALONE = { on() {}, selected: null }; // curves of a run mark no hand
const TOGETHER = { position: ["measured", "command"] }; // drawn in one figure

/** Figures of all runs and the list to choose what they show. */
export function drawLogs(controls, hosts, runs) {
  const kinds = kindsOf(runs);
  const show = (kind) => hosts.forEach((host, i) => {
    const views = fingersOf(runs[i], TOGETHER[kind] ?? [kind]);
    const figures = views.map(() => make("figure"));
    host.replaceChildren(...figures);
    views.forEach((view, k) => new Lines(figures[k], ALONE, { ...view, x: runs[i].seconds }));
  });
  const options = kinds.map((kind) => make("option", { value: kind }, kind));
  controls.append(make("label", {}, "show ", make("select", { onchange: (event) => show(event.target.value) }, ...options)));
  if (kinds.length) show(kinds[0]);
}

/** What can be shown of some run, measured and commanded positions as one. */
function kindsOf(runs) {
  const paired = Object.values(TOGETHER).flat();
  const names = [...new Set(runs.flatMap((run) => run.quantities.map((q) => q.name)))];
  const pairs = Object.keys(TOGETHER).filter((kind) => TOGETHER[kind].some((name) => names.includes(name)));
  return [...names.filter((name) => !paired.includes(name)), ...pairs];
}

/** Views of the quantities of one run, a view for each finger: joints and motors are named after theirs. */
function fingersOf(run, names) {
  const fingers = new Map();
  const quantities = run.quantities.filter((q) => names.includes(q.name));
  for (const { name, unit, of, values } of quantities) {
    const points = run.seconds.length;
    of.forEach((part, i) => {
      const [finger, ...rest] = part.split("_");
      const curve = { name: [rest.join(" ") || part, names.length > 1 ? name : ""].join(" ").trim(), y: values.subarray(i * points, (i + 1) * points) };
      fingers.set(finger, { unit, curves: [...(fingers.get(finger)?.curves ?? []), curve] });
    });
  }
  const what = names.join(" and ");
  return [...fingers].map(([finger, { unit, curves }]) => ({
    title: `${run.name}: ${what} of ${finger} over time`, xLabel: "time [s]", yLabel: `${finger}: ${what} [${unit}]`,
    yRange: span(curves), curves,
  }));
}

function span(curves) {
  const ends = curves.map(({ y }) => extent(y));
  const [low, high] = extent(ends.flat());
  return low < high ? [low, high] : [low - 1, high + 1];
}
