"""A finished or unfinished run, read from its build folder alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fpcad.errors import SpecError, StoreError, ToolchainError
from fpcad.look.columns import Column, metric_columns, parameter_columns, score_columns
from fpcad.look.layout import columns_of
from fpcad.look.unfinished import found_calls, found_candidates, found_metrics
from fpcad.sample.space import DesignSpace, design_space
from fpcad.select.columns import flags, numbers
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_json

if TYPE_CHECKING:
    import pandas

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Run:
    """Everything that a build folder tells of a run. Tables are Arrow's."""

    folder: Path
    spec: Spec
    manifest: dict[str, Any]
    candidates: pa.Table
    """One row a hand: `id`, `parent`, design parameters, solved poses."""
    calls: pa.Table
    """One row a proposal of the sampling, with its outcome."""
    metrics: pa.Table
    """One row a measured hand: metrics, reasons, scores, `pareto`."""
    selected: dict[str, Any] | None
    """What selected.json tells; None before a hand is chosen."""
    warnings: tuple[str, ...]
    """What is missing or unusual, a sentence each."""

    @property
    def poses(self) -> list[str]:
        """Names of the poses in the order of the spec."""
        return list(self.spec.poses)

    @cached_property
    def space(self) -> DesignSpace:
        """The box of designs that was sampled."""
        return design_space(self.spec.hand)

    @cached_property
    def table(self) -> pa.Table:
        """Design and metrics of all n candidates by rising `id`; NaN where one is not measured."""
        designs = self.candidates.select(["id", "parent", *self.space.names])
        return designs.join(self.metrics, keys="id", join_type="left outer").sort_by("id")

    @cached_property
    def ids(self) -> NDArray[np.int64]:
        """(n,) candidates in the order of :attr:`table`."""
        return self.table["id"].to_numpy()

    @cached_property
    def designs(self) -> Array:
        """(n, n_d) design parameters in the units of their names."""
        return self.matrix(self.space.names)

    @property
    def parameters(self) -> list[Column]:
        """The design parameters."""
        return parameter_columns(self.space.names)

    @property
    def metric_columns(self) -> list[Column]:
        """Metrics of :attr:`table`, plug-ins' too."""
        return metric_columns(self.metrics, self.poses)

    @property
    def score_columns(self) -> list[Column]:
        """Single scores of :attr:`table`."""
        return score_columns(self.metrics, self.poses)

    @property
    def front(self) -> Mask:
        """(n,) which candidates are on the Pareto front."""
        return flags(self.table, "pareto")

    def matrix(self, names: list[str] | tuple[str, ...]) -> Array:
        """(n, k) columns of :attr:`table` as numbers; NaN where a value is missing."""
        columns = [numbers(self.table, name) for name in names]
        return np.column_stack(columns) if columns else np.zeros((self.table.num_rows, 0))

    def paths(self, candidate: int) -> pa.Table:
        """States of the kept paths of one candidate; no rows where none are kept."""
        file = self.folder / "paths.parquet"
        if not file.exists():
            return pa.table({"id": pa.array([], pa.int64())})
        return pq.read_table(file, filters=[("id", "=", candidate)])

    def frame(self) -> pandas.DataFrame:
        """:attr:`table` as a pandas frame with `id` as its index."""
        try:
            import pandas  # noqa: F401
        except ImportError as error:
            raise ToolchainError("pandas is missing: pip install 'fpcad[notebook]'") from error
        return self.table.to_pandas().set_index("id")


def load(folder: Path | str) -> Run:
    """The run in a build folder, as `fpcad.load("build/clay")`.

    A run that was stopped half-way gives what its store holds, and says so in `warnings`.

    Raises:
        StoreError: there is no run, or one that this version cannot read.
    """
    folder = Path(folder)
    manifest = _manifest(folder)
    try:
        spec = load_spec(folder / "spec.yaml")
    except SpecError as error:
        raise StoreError(_other_version(folder, manifest, f"its spec.yaml: {error}")) from error
    warnings: list[str] = []
    candidates = found_candidates(folder, manifest, spec, warnings)
    metrics = found_metrics(folder, manifest, spec, warnings)
    calls = found_calls(folder, manifest, spec)
    _check_columns(folder, manifest, spec, candidates, calls)
    chosen = _chosen(folder, manifest)
    if chosen is None and metrics.num_rows:
        warnings.append("No hand is chosen yet.")
    warnings += _unwielded(spec, metrics)
    return Run(folder, spec, manifest, candidates, calls, metrics, chosen, tuple(warnings))


def _manifest(folder: Path) -> dict[str, Any]:
    file = folder / "manifest.json"
    if not file.exists():
        raise StoreError(f"{folder}: no run here; make one with `fpcad design {folder.name}`")
    manifest = read_json(file)
    if not isinstance(manifest, dict) or not isinstance(manifest.get("stages"), dict):
        raise StoreError(_other_version(folder, {}, "its manifest.json names no stages"))
    return manifest


def _chosen(folder: Path, manifest: dict[str, Any]) -> dict[str, Any] | None:
    """What selected.json tells, unless it is left from another run."""
    file = folder / "selected.json"
    done = manifest["stages"].get("select", {}).get("status") == "done"
    return read_json(file) if done and file.exists() else None


def _check_columns(
    folder: Path, manifest: dict[str, Any], spec: Spec, candidates: pa.Table, calls: pa.Table
) -> None:
    wanted = ["id", "parent", *design_space(spec.hand).names]
    wanted += [column for pose in spec.poses for column in columns_of(spec, pose)]
    for file, table, names in (
        ("candidates", candidates, wanted),
        ("calls", calls, ["candidate", "outcome", "reason"]),
    ):
        missing = [name for name in names if name not in table.column_names]
        if missing:
            found = f"{file}.parquet has no column `{missing[0]}`"
            raise StoreError(_other_version(folder, manifest, found))


def _other_version(folder: Path, manifest: dict[str, Any], found: str) -> str:
    made_by = manifest.get("versions", {}).get("fpcad", "an unknown version")
    return (
        f"{folder}: made by fpcad {made_by}, not readable by {version('fpcad')} ({found}); "
        f"make it again with `fpcad design {folder.name}`"
    )


def _unwielded(spec: Spec, metrics: pa.Table) -> list[str]:
    """Poses that no measured hand can move the tool from."""
    return [
        f"No hand turns the tool at all from the pose {pose}."
        for pose in spec.poses
        if metrics.num_rows and not (numbers(metrics, f"{pose}_tmr_deg") > 0).any()
    ]
