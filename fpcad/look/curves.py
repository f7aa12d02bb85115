"""Curves of a run: sampling efficiency over calls, and shares of hands above a threshold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.look.run import Run
from fpcad.select.columns import numbers

Array = NDArray[np.float64]

POINTS = 400
"""Points of a curve that is drawn."""
ACCEPTED = "accepted"


@dataclass(frozen=True)
class Efficiency:
    """Candidates per call, along the calls."""

    calls: Array  # (k,)
    cumulative: Array  # (k,) since the first call
    recent: Array  # (k,) over the last `window` calls
    window: int


def efficiency(run: Run) -> Efficiency:
    """Sampling efficiency at up to 400 calls, the last one among them."""
    outcomes = run.calls["outcome"].to_numpy(zero_copy_only=False)
    accepted = np.cumsum(outcomes == ACCEPTED).astype(float)
    n, window = len(accepted), run.spec.sampling.efficiency_window
    count = np.unique(np.linspace(1, n, min(n, POINTS)).astype(int)) if n else np.zeros(0, int)
    before = np.concatenate([[0.0], accepted])
    first = np.maximum(count - window, 0)
    recent = (before[count] - before[first]) / np.maximum(count - first, 1)
    return Efficiency(count.astype(float), before[count] / count, recent, window)


def share_above(values: Array, thresholds: Array) -> Array:
    """Share (k,) of values (n,) that are greater than each threshold (k,); NaN is never above."""
    known = np.sort(values[~np.isnan(values)])
    return (len(known) - np.searchsorted(known, thresholds, side="right")) / max(len(values), 1)


def range_shares(run: Run) -> tuple[Array, dict[str, Array]]:
    """Thresholds [deg] of tool motion range, and each pose's share of hands above them."""
    ranges = {pose: numbers(run.metrics, f"{pose}_tmr_deg") for pose in run.poses}
    largest = max((np.nanmax(v) for v in ranges.values() if np.isfinite(v).any()), default=0.0)
    thresholds = np.linspace(0.0, max(largest, 1.0), POINTS)
    return thresholds, {pose: share_above(v, thresholds) for pose, v in ranges.items()}


def outcome_counts(run: Run) -> dict[str, int]:
    """How many calls ended how, the most frequent first."""
    reasons = [reason or ACCEPTED for reason in run.calls["reason"].to_pylist()]
    outcomes, counts = np.unique(reasons, return_counts=True)
    order = np.argsort(-counts, kind="stable")
    return {str(outcomes[i]): int(counts[i]) for i in order}
