"""Everything that docs/results.md is written from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.paper.experiment import STAGES, Experiment, runs
from benchmarks.paper.packing import Filling
from benchmarks.paper.published import Published
from benchmarks.paper.recheck import Recheck
from benchmarks.paper.recheck_ipopt import PoseComparison
from benchmarks.paper.tally import Tally, tally
from fpcad.store import read_json


@dataclass(frozen=True)
class Costs:
    """What one experiment took."""

    stage_seconds: dict[str, float]
    """As the manifest tells; of a stage that was interrupted, its last run alone."""
    runs: list[dict[str, Any]]
    """Runs of this script, with seconds and peak memory."""
    size_bytes: dict[str, int]
    """Of the build's files, by name; shards and other folders summed."""
    versions: dict[str, str]


@dataclass(frozen=True)
class Outcome:
    """One experiment with its numbers."""

    experiment: Experiment
    published: Published
    tally: Tally
    costs: Costs

    @property
    def title(self) -> str:
        return self.experiment.title


@dataclass(frozen=True)
class Results:
    """All numbers of the document."""

    plane: Outcome
    """Two free parameters, to the spec's own end."""
    plane_calls: Outcome
    """The same for as many calls as the paper made."""
    full: Outcome
    """All parameters."""
    fillings: Sequence[Filling]
    control: Mapping[str, Sequence[Mapping[str, Any]]]
    """Rows of the control groups by the groups' names."""
    recheck: Recheck
    ipopt: Mapping[str, PoseComparison]
    trial: int | None
    """Number of candidates that a trial was cut down to."""

    @property
    def outcomes(self) -> list[Outcome]:
        return [self.plane, self.plane_calls, self.full]


def outcome(experiment: Experiment, published: Published, folder: Path) -> Outcome:
    """The numbers of a finished build."""
    return Outcome(experiment, published, tally(folder), _costs(folder))


def _costs(folder: Path) -> Costs:
    manifest = read_json(folder / "manifest.json")
    seconds = {name: float(manifest["stages"][name]["seconds"]) for name in STAGES}
    return Costs(seconds, runs(folder), _sizes(folder), manifest["versions"])


def _sizes(folder: Path) -> dict[str, int]:
    tables = {file.name: file.stat().st_size for file in sorted(folder.glob("*.parquet"))}
    store = sum(file.stat().st_size for file in (folder / "store").rglob("*") if file.is_file())
    return {**tables, "store/": store}
