"""The numbers of one finished experiment, all counted from its tables."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from benchmarks.paper.packing import accepted_outcomes, ball_share, least_distance
from fpcad.sample.space import design_space
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_table

Array = NDArray[np.float64]

THRESHOLDS_DEG = (0, 1, 2, 5, 10, 20, 45, 90, 135, 180, 225, 270)
QUANTILES = (0.05, 0.5, 0.95)
METRICS = ("tmr_deg", "mss_mm_s", "mft_p90_nmm")


@dataclass(frozen=True)
class Tally:
    """What one experiment's tables say."""

    spec: Spec
    outcomes: Counter[str]
    """Calls by outcome."""
    accepted: NDArray[np.bool_]
    """(calls,) which calls gave a candidate."""
    points: Array
    """(n, n_free) standardized designs of the candidates."""
    tmr_deg: dict[str, Array]
    """(n,) of each pose, and of `all` the least of the poses."""
    metrics: dict[tuple[str, str], Array]
    """(n,) by pose and metric; NaN without a path."""
    ends: dict[str, Counter[str]]
    """Reasons of all ends of a pose's paths, two a candidate."""
    failures: dict[str, Counter[tuple[str, str]]]
    """Ends (minus, plus) of the paths of a pose whose motion range is zero."""
    front: int
    """Candidates on the Pareto front."""

    @property
    def candidates(self) -> int:
        return len(self.points)

    @property
    def calls(self) -> int:
        return len(self.accepted)

    @property
    def efficiency(self) -> float:
        """Candidates over calls, as the paper defines it; the first hand needed no call."""
        return self.candidates / self.calls

    @property
    def last_efficiency(self) -> float:
        """Mean over the spec's window of last calls."""
        return float(self.accepted[-self.spec.sampling.efficiency_window :].mean())

    @property
    def occupied(self) -> float:
        """Share of the design space within half the prescribed distance of a candidate."""
        return ball_share(self.points, self.spec.sampling.min_distance)

    @property
    def least_distance(self) -> float:
        """Distance of the two nearest candidates."""
        return least_distance(self.points)

    def beyond(self, pose: str, threshold_deg: float) -> int:
        """Candidates whose motion range of a pose (or `all`) is greater than a threshold."""
        return int((self.tmr_deg[pose] > threshold_deg).sum())

    def efficiency_after(self, calls: int) -> tuple[float, float]:
        """Cumulative efficiency and that of the window before, after a number of calls."""
        window = min(self.spec.sampling.efficiency_window, calls)
        seen = self.accepted[:calls]
        return (1 + int(seen.sum())) / calls, float(seen[-window:].mean())

    def quantiles(self, pose: str, metric: str) -> Array:
        """(3,) QUANTILES of a metric over the candidates that have a path."""
        values = self.metrics[pose, metric]
        return np.quantile(values[np.isfinite(values)], QUANTILES)


def tally(folder: Path) -> Tally:
    """Count everything in a build folder whose select stage is done."""
    spec = load_spec(folder / "spec.yaml")
    space, poses = design_space(spec.hand), list(spec.poses)
    candidates = read_table(folder / "candidates.parquet")
    calls = read_table(folder / "calls.parquet").sort_by("number")
    metrics = read_table(folder / "metrics.parquet").sort_by("id")
    named = np.stack([column(candidates, name) for name in space.names], axis=1)
    tmr = {pose: column(metrics, f"{pose}_tmr_deg") for pose in poses}
    outcomes = [reason or "accepted" for reason in calls["reason"].to_pylist()]
    return Tally(
        spec=spec,
        outcomes=Counter(outcomes),
        accepted=accepted_outcomes(outcomes),
        points=space.standardize(named),
        tmr_deg=tmr | {"all": np.min(list(tmr.values()), axis=0)},
        metrics={(p, m): column(metrics, f"{p}_{m}") for p in poses for m in METRICS},
        ends={pose: Counter(_ends(metrics, pose)) for pose in poses},
        failures={pose: _failures(metrics, pose, tmr[pose]) for pose in poses},
        front=sum(metrics["pareto"].to_pylist()),
    )


def column(table: pa.Table, name: str) -> Array:
    """A numerical column (n,); missing values are NaN."""
    return table[name].to_numpy(zero_copy_only=False).astype(float)


def _ends(metrics: pa.Table, pose: str) -> list[str]:
    return [*metrics[f"{pose}_end_minus"].to_pylist(), *metrics[f"{pose}_end_plus"].to_pylist()]


def _failures(metrics: pa.Table, pose: str, tmr: Array) -> Counter[tuple[str, str]]:
    minus, plus = (metrics[f"{pose}_end_{side}"].to_pylist() for side in ("minus", "plus"))
    return Counter((minus[i], plus[i]) for i in np.flatnonzero(~(tmr > 0)))
