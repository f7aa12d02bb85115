"""Metrics from other packages: a function over a path, found through the entry points `fpcad.metrics`.

    from fpcad.wield.plugins import scored

    @scored("smaller", resolution=0.01)
    def joint_travel_rad(path):
        return float(abs(numpy.diff(path.joints_rad, axis=0)).sum())

and in the package's pyproject.toml

    [project.entry-points."fpcad.metrics"]
    joint_travel_rad = "my_package:joint_travel_rad"
"""

from __future__ import annotations

import hashlib
import inspect
import math
import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, fields
from importlib.metadata import entry_points
from typing import Literal, TypeVar

from fpcad.errors import ToolchainError
from fpcad.wield.metrics import PathMetrics
from fpcad.wield.path import WieldingPath

GROUP = "fpcad.metrics"
NAME = re.compile(r"[a-z][a-z0-9_]*")
SCORE = "_score"

Better = Literal["larger", "smaller"]
Measure = Callable[[WieldingPath], float]
ScoredBy = tuple[str, str, Better, float]
"""A metric's column and its score's, both without the pose; what is good; the resolution."""
Function = TypeVar("Function", bound=Measure)


@dataclass(frozen=True)
class PathMetric:
    """A metric that another package brings."""

    name: str
    """Columns are `<pose>_<name>`; a unit's suffix, as `_mm`, is shown as the unit."""
    measure: Measure
    """From a path to a number; NaN where it has none."""
    better: Better | None = None
    """Which values are good; without it the metric is shown and not scored."""
    resolution: float = 1e-9
    """Differences below it do not count in scores."""

    def at(self, path: WieldingPath) -> float:
        """The metric of a path."""
        value = self.measure(path)
        if not isinstance(value, (int, float)) or math.isinf(value):
            raise ToolchainError(
                f"metric {self.name}: gave {value!r} for a path of {path.pose}; allowed is a "
                "finite number, or NaN"
            )
        return float(value)

    def fingerprint(self) -> str:
        """Changes when the metric does, as far as its source tells."""
        try:
            text = inspect.getsource(self.measure)
        except (OSError, TypeError):  # a built-in or a callable object: its name must do
            text = repr(getattr(self.measure, "__qualname__", type(self.measure).__qualname__))
        told = f"{self.name} {self.better} {self.resolution!r} {text}"
        return hashlib.sha256(told.encode()).hexdigest()


def scored(better: Better, resolution: float) -> Callable[[Function], Function]:
    """Mark a metric's function as one that hands are scored by.

    Args:
        better: which values are good.
        resolution: differences below it do not count, in the metric's unit.
    """
    if better not in ("larger", "smaller") or not 0 < resolution < math.inf:
        raise ValueError('scored: "larger" or "smaller", and a positive resolution')

    def mark(function: Function) -> Function:
        function.__dict__.update(better=better, resolution=resolution)
        return function

    return mark


def installed_metrics() -> tuple[PathMetric, ...]:
    """The metrics of all installed packages, by name.

    Raises:
        ToolchainError: two have one name, a name is not allowed, or one cannot be loaded.
    """
    found: dict[str, PathMetric] = {}
    taken = {field.name for field in fields(PathMetrics)}
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        if point.name in taken or point.name in found:
            raise ToolchainError(f"metric {point.name} ({point.value}): the name is taken")
        if not NAME.fullmatch(point.name) or point.name.endswith(SCORE):
            raise ToolchainError(
                f"metric {point.name} ({point.value}): a name is made of a-z, 0-9 and _, and does "
                f"not end with {SCORE}"
            )
        try:
            measure = point.load()
        except (ImportError, AttributeError) as error:
            raise ToolchainError(f"metric {point.name} ({point.value}): {error}") from error
        settings = {k: v for k, v in vars(measure).items() if k in ("better", "resolution")}
        found[point.name] = PathMetric(point.name, measure, **settings)
    return tuple(found.values())


def scored_by(columns: Collection[str], poses: Sequence[str]) -> list[ScoredBy]:
    """How the installed metrics that a table with these columns holds are scored."""
    return [
        (metric.name, f"{metric.name}{SCORE}", metric.better, metric.resolution)
        for metric in installed_metrics()
        if metric.better and all(f"{pose}_{metric.name}" in columns for pose in poses)
    ]


def measured(metrics: Sequence[PathMetric], path: WieldingPath | None, moved: bool) -> list[float]:
    """Each metric of a path; NaN where there is no path or where it never moved."""
    return [metric.at(path) if path is not None and moved else math.nan for metric in metrics]
