"""The curves of the paper's results figure, for our runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.paper.results import Outcome, Results
from fpcad.store import replacing

POINTS = 400


def draw_curves(results: Results, target: Path) -> None:
    """Efficiency along the calls, and share of hands beyond a motion range; a PNG.

    Needs matplotlib, which comes with the extra `pictures`.
    """
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(2, 2, figsize=(9, 6), layout="constrained")
    for column, outcome in enumerate((results.plane_calls, results.full)):
        _efficiency(axes[0, column], outcome)
    for column, outcome in enumerate((results.plane, results.full)):
        _thresholds(axes[1, column], outcome)
    with replacing(target) as beside:
        # Without the date and version of the file's maker, equal numbers give equal files.
        figure.savefig(beside, format="png", dpi=90, metadata={"Software": None})
    plt.close(figure)


def _efficiency(axis, outcome: Outcome) -> None:
    t = outcome.tally
    calls = np.unique(np.geomspace(10, t.calls, POINTS).astype(int))
    both = np.array([t.efficiency_after(int(n)) for n in calls])
    window = t.spec.sampling.efficiency_window
    axis.semilogx(calls, 100 * both[:, 0], label="of all calls")
    axis.semilogx(calls, 100 * both[:, 1], label=f"of the last {window:,}", linewidth=0.8)
    end = outcome.published
    axis.plot(end.calls, 100 * end.efficiency, "k+", label="the paper's end")
    axis.set(title=outcome.title, xlabel="calls", ylabel="accepted [%]", ylim=(0, 105))
    axis.legend(frameon=False)


def _thresholds(axis, outcome: Outcome) -> None:
    t = outcome.tally
    thresholds = np.linspace(0, 360, POINTS)
    for pose in t.tmr_deg:
        shares = [100 * t.beyond(pose, float(limit)) / t.candidates for limit in thresholds]
        axis.plot(thresholds, shares, label=pose)
    axis.set(title=outcome.title, xlabel="tool motion range above [deg]", ylabel="candidates [%]")
    axis.legend(frameon=False)
