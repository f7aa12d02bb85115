// The page: reads the run, draws every figure, ties them together by one selection.

import { Actions } from "./actions.js";
import { Compare } from "./compare.js";
import { drawUnseen, make } from "./dom.js";
import { Lines } from "./lines.js";
import { List } from "./list.js";
import { drawLogs } from "./logs.js";
import { Numbers } from "./numbers.js";
import { Parallel } from "./parallel.js";
import { Player } from "./player.js";
import { Scatter } from "./scatter.js";
import { settled } from "./shown.js";
import { State } from "./state.js";
import { onThemeChange } from "./theme.js";
import { readRest, readRun } from "./data.js";

const at = (id) => document.getElementById(id);

/** Runs view3d.js, which is text until then: to compile it takes longer than all that the page opens with. */
function load3d() {
  let arrived;
  window.fpcad3d = (exported) => (arrived = exported);
  const script = make("script");
  script.textContent = at("script-3d").textContent;
  document.head.append(script);
  return arrived;
}

async function start() {
  await window.fpcadPainted; // from first.js: the summary, text of the page, comes before all that is read
  const run = readRun();
  const state = new State(run);
  const figures = run.candidates.count ? drawFigures(run, state) : [];
  new Numbers(at("numbers"), state);
  bindControls(run, state);
  performance.mark("fpcad:answers"); // figures are drawn as they come into sight
  await settled(state); // each step to 3D takes long where graphics are emulated: a hand picked between is shown first
  const { Stage, GLTFExporter } = load3d();
  const whole = readRest(run);
  await settled(state);
  const open = (host) => openStage(host, run, Stage);
  const stage = run.candidates.count ? open(at("stage")) : null;
  const player = run.candidates.count ? new Player(at("player"), state, stage) : null;
  performance.mark("fpcad:stage");
  onThemeChange(() => {
    figures.forEach((figure) => figure.redraw());
    player?.redraw();
  });
  await whole;
  if (run.runs.length) drawLogs(at("log-controls"), [...document.querySelectorAll(".log")], run.runs);
  if (player) {
    player.reload();
    new List(at("list"), at("list-controls"), state);
    new Actions(at("actions"), state, stage, player, new Compare(at("compare"), run, open), new GLTFExporter());
  }
  await drawUnseen();
  window.fpcad = { run, state, stage, player, figures }; // for tests and for the curious
  performance.mark("fpcad:whole");
  document.documentElement.dataset.ready = "yes";
}

function drawFigures(run, state) {
  const [x, y] = [column(run.map.points, 0), column(run.map.points, 1)];
  const plane = { x, y, xLabel: run.map.axes[0], yLabel: run.map.axes[1] };
  const landscapes = run.scores.map((score) => {
    const host = make("figure", {}, make("figcaption", {}, score.label));
    at("landscapes").append(host);
    return new Scatter(host, state, { ...plane, title: `Landscape of the score ${score.label}`, scores: score.data });
  });
  const groups = new Scatter(at("map"), state, { ...plane, title: "Map of the designs", axes: true, leaders: true });
  return [...landscapes, groups, ...pareto(run, state), ...curves(run, state), parallel(run, state)];
}

/** Front and dominated hands over two columns that the reader picks. */
function pareto(run, state) {
  const columns = [...run.scores, ...run.metrics];
  if (columns.length < 2) return [];
  const view = (x, y) => ({
    title: `Pareto front: ${columns[y].label} over ${columns[x].label}`,
    x: columns[x].data, y: columns[y].data, xLabel: label(columns[x], run), yLabel: label(columns[y], run), axes: true,
  });
  const second = Math.min(Math.floor(run.scores.length / 3), columns.length - 1) || 1;
  const plot = new Scatter(at("pareto"), state, view(0, second));
  const pick = (word, initial) => {
    const options = columns.map((c, i) => make("option", { value: i, selected: i === initial }, label(c, run)));
    const list = make("select", { id: `pareto-${word}`, onchange: () => plot.setView(view(+picks[0].value, +picks[1].value)) }, ...options);
    at("pareto-axes").append(make("label", {}, `${word} `, list));
    return list;
  };
  const picks = [pick("across", 0), pick("up", second)];
  return [plot];
}

function label(column, run) {
  const score = run.scores.includes(column);
  return `${column.label}${score ? " (score)" : column.unit ? ` [${column.unit}]` : ""}`;
}

function curves(run, state) {
  const { efficiency, shares, candidates } = run;
  const made = [];
  if (efficiency.calls.length) {
    made.push(new Lines(at("efficiency"), state, {
      title: "Sampling efficiency over calls", x: efficiency.calls, xLabel: "calls", yLabel: "candidates a call",
      curves: [{ name: "since the first call", y: efficiency.cumulative }, { name: `over the last ${efficiency.window} calls`, y: efficiency.recent }],
      marks: (row) => [{ x: candidates.call[row], curve: 0 }],
      find: (x) => nearest(candidates.call, x),
    }));
  }
  const poses = run.poses.map(({ name }) => name).filter((name) => name in shares.poses);
  const ranges = poses.map((name) => run.metrics.find((c) => c.name === `${name}_tmr_deg`)?.data);
  if (poses.length && ranges.every(Boolean)) {
    made.push(new Lines(at("shares"), state, {
      title: "Share of hands whose tool motion range is above a threshold", x: shares.thresholds,
      xLabel: "tool motion range [°]", yLabel: "share of hands above",
      curves: poses.map((name) => ({ name, y: shares.poses[name] })),
      marks: (row) => ranges.map((range, curve) => ({ x: range[row], curve })),
      find: (x, curve) => nearest(ranges[curve], x),
    }));
  }
  return made;
}

function nearest(values, x) {
  let best = null;
  values.forEach((value, row) => {
    if (!Number.isNaN(value) && (best === null || Math.abs(value - x) < Math.abs(values[best] - x))) best = row;
  });
  return best;
}

function parallel(run, state) {
  const parameters = run.parameters.filter((c) => c.free).map((c) => ({ ...c, range: c.bounds }));
  const scores = run.scores.map((c) => ({ ...c, range: [0, 100] }));
  const metrics = run.metrics.map((c) => ({ ...c, range: span(c.data) }));
  return new Parallel(at("parallel"), state, [...parameters, ...scores], metrics);
}

/** One coordinate of points in a plane; as a loop, since the page waits for it. */
function column(points, k) {
  const values = new Float32Array(points.length / 2);
  for (let i = 0; i < values.length; i++) values[i] = points[2 * i + k];
  return values;
}

/** Least and greatest number, apart from each other; NaN is passed over. */
function span(values) {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < values.length; i++) {
    if (values[i] < low) low = values[i];
    if (values[i] > high) high = values[i];
  }
  if (low > high) low = high = 0;
  return low < high ? [low, high] : [low - 1, low + 1];
}

/** The 3D view, or a sentence where the browser cannot draw it. */
function openStage(host, run, Stage) {
  try {
    return new Stage(host, run);
  } catch (error) {
    host.append(make("p", {}, `This browser shows no 3D view (${error.message}). Everything else works.`));
    return null;
  }
}

function bindControls(run, state) {
  const field = at("pick");
  const rows = new Map(Array.from(run.candidates.id, (id, row) => [id, row]));
  field.addEventListener("change", () => state.select(rows.get(+field.value) ?? null));
  const show = () => (field.value = state.selected === null ? "" : run.candidates.id[state.selected]);
  state.on("select", show);
  show();
  at("to-chosen").disabled = run.chosen === null;
  at("to-chosen").addEventListener("click", () => state.select(run.chosen));
  for (const button of document.querySelectorAll("button[data-row]"))
    button.addEventListener("click", () => state.select(+button.dataset.row));
}

start();
