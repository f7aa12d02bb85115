"""The page's figures for a paper, as SVG and PDF."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from fpcad.look.analysis import front_hypervolume, sensitivity
from fpcad.look.columns import Column
from fpcad.look.curves import efficiency, range_shares
from fpcad.look.groups import clusters, design_map
from fpcad.look.run import Run
from fpcad.store import replacing

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000")
"""Okabe and Ito's, which all kinds of colour vision tell apart."""
DASHES = ("-", "--", ":", "-.", (0, (6, 2, 1, 2, 1, 2)))
MUTED = "#9aa3aa"
DARK_CELL = 0.6
"""Correlation whose cell is so dark that its text is white."""
WIDTH_IN = 6.3
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "svg.hashsalt": "fpcad",  # else each SVG gets other names inside
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}
UNDATED: dict[str, dict[str, Any]] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}


def write_figures(run: Run, folder: Path, formats: tuple[str, ...] = ("svg", "pdf")) -> list[Path]:
    """Write every figure that the run has data for, in each format; the same run, the same bytes."""
    written = []
    with _style():
        for name, draw in FIGURES.items():
            figure = draw(run)
            if figure is None:
                continue
            for kind in formats:
                file = folder / f"{name}.{kind}"
                with replacing(file) as beside:
                    figure.savefig(beside, format=kind, metadata=UNDATED[kind])
                written.append(file)
    return written


@contextmanager
def _style() -> Iterator[None]:
    with matplotlib.rc_context(STYLE):
        yield


def efficiency_figure(run: Run) -> Figure | None:
    """Candidates per call, along the calls."""
    found = efficiency(run)
    if not len(found.calls):
        return None
    figure, axes = _one()
    axes.plot(found.calls, found.cumulative, color=COLOURS[0], label="since the first call")
    label = f"over the last {found.window} calls"
    axes.plot(found.calls, found.recent, DASHES[1], color=COLOURS[1], label=label)
    axes.set(xlabel="calls", ylabel="candidates per call", ylim=(0, 1.02))
    axes.legend(frameon=False)
    return figure


def shares_figure(run: Run) -> Figure | None:
    """Share of hands whose tool motion range is above a threshold, a curve for each pose."""
    if not run.metrics.num_rows:
        return None
    figure, axes = _one()
    thresholds, shares = range_shares(run)
    for k, (pose, share) in enumerate(shares.items()):
        style = {"color": COLOURS[k % 5], "linestyle": DASHES[k % 5]}
        axes.plot(thresholds, share, label=pose, **style)
    axes.set(xlabel="tool motion range [deg]", ylabel="share of hands above", ylim=(0, 1.02))
    axes.legend(frameon=False)
    return figure


def landscapes_figure(run: Run) -> Figure | None:
    """Each score over the free parameters, or over their t-SNE map."""
    columns = run.score_columns
    if not columns or not run.metrics.num_rows:
        return None
    plane, width = design_map(run), max(1, len(columns) // len(run.poses))
    height = -(-len(columns) // width)
    figure = Figure(figsize=(WIDTH_IN, 0.36 * WIDTH_IN * height), layout="constrained")
    grid = figure.subplots(height, width, squeeze=False).ravel()
    for axes, column in zip(grid, columns, strict=False):
        scores = run.matrix([column.name])[:, 0]
        drawn = axes.scatter(*plane.points.T, c=scores, s=_size(run), vmin=0, vmax=100)
        axes.set_title(column.label)
        if plane.axes[0].startswith("t-SNE"):
            axes.set(xticks=[], yticks=[])
    figure.colorbar(drawn, ax=list(grid), label="score", shrink=0.6)
    figure.supxlabel(f"{plane.axes[0]}  ({plane.told})")
    figure.supylabel(plane.axes[1])
    return figure


def front_figure(run: Run) -> Figure | None:
    """Front and dominated hands, each pair of poses by their best-known score."""
    columns = _first_scores(run)
    if len(columns) < 2 or not run.metrics.num_rows:
        return None
    pairs = [(a, b) for k, a in enumerate(columns) for b in columns[k + 1 :]]
    figure = Figure(figsize=(WIDTH_IN, WIDTH_IN / len(pairs) + 0.5), layout="constrained")
    for axes, (a, b) in zip(figure.subplots(1, len(pairs), squeeze=False)[0], pairs, strict=True):
        x, y = run.matrix([a.name, b.name]).T
        axes.scatter(x[~run.front], y[~run.front], s=_size(run), color=MUTED, label="dominated")
        axes.scatter(
            x[run.front], y[run.front], s=_size(run), color=COLOURS[0], marker="+", label="front"
        )
        if run.selected is not None:
            at = run.ids == run.selected["id"]
            chosen = {"s": 60, "facecolors": "none", "edgecolors": COLOURS[1], "label": "chosen"}
            axes.scatter(x[at], y[at], marker="s", **chosen)
        axes.set(xlabel=a.label, ylabel=b.label)
    axes.legend(frameon=False, fontsize=7)
    volume = front_hypervolume(run)
    told = "" if volume.exact else "about "
    figure.suptitle(f"hypervolume over all scores: {told}{volume.value:.4f}", fontsize=9)
    return figure


def parallel_figure(run: Run) -> Figure | None:
    """Parameters and scores of all hands as lines."""
    scores = run.score_columns
    if not scores or not run.metrics.num_rows:
        return None
    free = run.space.free
    columns = [c for c, is_free in zip(run.parameters, free, strict=True) if is_free]
    standardized = run.space.standardize(run.designs) + 0.5
    lines = np.hstack([standardized, run.matrix([c.name for c in scores]) / 100])
    figure, axes = _one(0.55)
    opacity = min(1.0, max(0.03, 25 / len(lines)))
    for rows, colour in ((~run.front, MUTED), (run.front, COLOURS[0])):
        axes.plot(lines[rows].T, color=colour, alpha=opacity, linewidth=0.7)
    if run.selected is not None:
        axes.plot(lines[run.ids == run.selected["id"]].T, color=COLOURS[1], linewidth=2)
    labels = [c.label for c in (*columns, *scores)]
    axes.set_xticks(range(len(labels)), labels, rotation=40, ha="right")
    axes.set(ylabel="share of range", ylim=(0, 1))
    return figure


def clusters_figure(run: Run) -> Figure | None:
    """HDBSCAN's clusters of designs on their map."""
    if not len(run.ids):
        return None
    plane, labels = design_map(run), clusters(run.space.standardize(run.designs))
    figure, axes = _one(0.7)
    for label in range(-1, labels.max() + 1):
        colour = MUTED if label < 0 else COLOURS[label % 5]
        name = "no cluster" if label < 0 else f"cluster {label + 1}"
        x, y = plane.points[labels == label].T
        axes.scatter(x, y, s=_size(run), color=colour, label=f"{name} ({len(x)})")
    axes.set(xlabel=f"{plane.axes[0]}  ({plane.told})", ylabel=plane.axes[1])
    axes.legend(frameon=False)
    return figure


def sensitivity_figure(run: Run) -> Figure | None:
    """Rank correlation of each metric with each free parameter."""
    told = sensitivity(run, importances=False)
    if not told.num_rows or not np.isfinite(told["rank_correlation"].to_numpy()).any():
        return None
    parameters = list(dict.fromkeys(told["parameter"].to_pylist()))
    metrics = list(dict.fromkeys(told["metric"].to_pylist()))
    values = told["rank_correlation"].to_numpy().reshape(len(metrics), len(parameters))
    figure, axes = _one(0.9)
    drawn = axes.imshow(values, cmap="PuOr", vmin=-1, vmax=1, aspect="auto")
    axes.set_xticks(range(len(parameters)), parameters, rotation=40, ha="right")
    axes.set_yticks(range(len(metrics)), metrics)
    for (i, j), value in np.ndenumerate(values):
        text = "" if np.isnan(value) else f"{value:.2f}"
        ink = "white" if abs(value) > DARK_CELL else "black"
        axes.text(j, i, text, ha="center", va="center", color=ink)
    figure.colorbar(drawn, ax=axes, label="Spearman's rank correlation")
    return figure


FIGURES: dict[str, Callable[[Run], Figure | None]] = {
    "efficiency": efficiency_figure,
    "range_shares": shares_figure,
    "landscapes": landscapes_figure,
    "front": front_figure,
    "parallel": parallel_figure,
    "clusters": clusters_figure,
    "sensitivity": sensitivity_figure,
}


def _first_scores(run: Run) -> list[Column]:
    """The first score of each pose."""
    firsts: dict[str | None, Column] = {}
    for column in run.score_columns:
        firsts.setdefault(column.pose, column)
    return list(firsts.values())


def _one(height: float = 0.5) -> tuple[Figure, Any]:
    figure = Figure(figsize=(WIDTH_IN, height * WIDTH_IN), layout="constrained")
    return figure, figure.subplots()


def _size(run: Run) -> float:
    """Area of a point [pt^2]."""
    return float(np.clip(2000 / max(len(run.ids), 1), 1.5, 16))
