"""Collecting and writing figures: medians, ratios and the machine they were taken on."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path

from fpcad.store import write_json


@dataclass(frozen=True)
class Figure:
    """One comparison; `ratio` is baseline / ours, so more is better."""

    name: str
    ours: float
    baseline: float
    ratio: float
    unit: str
    note: str = ""


def figure(name: str, ours: float, baseline: float, unit: str, note: str = "") -> Figure:
    """A comparison with its ratio."""
    return Figure(name, ours, baseline, baseline / ours, unit, note)


def machine() -> dict[str, str]:
    """What the figures were taken on."""
    model = next(
        (
            line.split(":", 1)[1].strip()
            for line in Path("/proc/cpuinfo").read_text().splitlines()
            if line.startswith("model name")
        ),
        platform.processor(),
    )
    packages = ("casadi", "daqp", "numpy", "osqp", "scipy")
    load = " ".join(f"{value:.1f}" for value in os.getloadavg())
    return {
        "processor": model,
        "cores": str(os.cpu_count()),
        "load": load,
        "python": platform.python_version(),
        **{package: version(package) for package in packages},
    }


def write_figures(figures: Sequence[Figure], target: Path) -> None:
    """bench.json: the machine and a list of name, ours, baseline, ratio, unit, note."""
    write_json(target, {"machine": machine(), "figures": [asdict(f) for f in figures]})


def print_figures(figures: Sequence[Figure]) -> None:
    """The same as a table on stdout."""
    print(f"{'':46}{'ours':>12}{'baseline':>12}{'ratio':>8}  unit")
    for f in figures:
        print(f"{f.name:46}{f.ours:12.4g}{f.baseline:12.4g}{f.ratio:8.1f}  {f.unit}")
        if f.note:
            print(f"    {f.note}")
    print(", ".join(f"{key} {value}" for key, value in machine().items()))
