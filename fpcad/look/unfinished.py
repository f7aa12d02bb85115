"""Tables of a run as far as it came: compacted ones, or else the shards of the running stage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from fpcad.look.layout import columns_of
from fpcad.sample.space import design_space
from fpcad.select.ranking import rank_table
from fpcad.select.scores import Metric
from fpcad.spec.schema import Spec
from fpcad.store import Shards, read_table
from fpcad.wield.plugins import scored_by

SAMPLING = "Sampling was stopped before its end: what its store holds is shown."
MEASURING = "Measuring was stopped before its end: scores compare the hands measured so far."
EMPTY = "No candidate was found yet."


def found_candidates(
    folder: Path, manifest: dict[str, Any], spec: Spec, warnings: list[str]
) -> pa.Table:
    """One row a hand."""
    file = folder / "candidates.parquet"
    if _done(manifest, "sample") and file.exists():
        table = read_table(file)
    else:
        warnings.append(SAMPLING)
        table = _sampled_so_far(folder, manifest, spec)
    if table.num_rows == 0:
        warnings.append(EMPTY)
    return table


def found_calls(folder: Path, manifest: dict[str, Any], spec: Spec) -> pa.Table:
    """One row a proposal of the sampling."""
    file = folder / "calls.parquet"
    if _done(manifest, "sample") and file.exists():
        return read_table(file)
    names = ["number", "parent", "candidate", "outcome", "reason", *design_space(spec.hand).names]
    shards = _shards(folder, manifest, "sample")
    return shards.select(names) if shards is not None else pa.table({name: [] for name in names})


def found_metrics(
    folder: Path, manifest: dict[str, Any], spec: Spec, warnings: list[str]
) -> pa.Table:
    """One row a measured hand, with scores."""
    file = folder / "metrics.parquet"
    if _done(manifest, "select") and file.exists():
        return read_table(file)
    measured = folder / "store" / "metrics.parquet"
    if _done(manifest, "evaluate") and measured.exists():
        return _ranked(read_table(measured), spec)
    shards = _shards(folder, manifest, "evaluate")
    if shards is None:
        shards = _no_metrics(spec)
    if _done(manifest, "sample"):
        warnings.append(MEASURING)
    return _ranked(shards, spec)


def _sampled_so_far(folder: Path, manifest: dict[str, Any], spec: Spec) -> pa.Table:
    """The first hand and the accepted ones of the finished shards."""
    start = folder / "store" / "start.parquet"
    tables = [read_table(start)] if _done(manifest, "solve") and start.exists() else []
    shards = _shards(folder, manifest, "sample")
    if shards is not None and tables:
        accepted = shards.filter(pc.field("outcome") == "accepted")
        ids = accepted["candidate"]
        accepted = accepted.drop_columns(["candidate", "number", "outcome", "reason"])
        tables.append(accepted.append_column("id", ids).select(tables[0].column_names))
    if tables:
        return pa.concat_tables(tables, promote_options="default")
    states = [column for pose in spec.poses for column in columns_of(spec, pose)]
    floats = [*design_space(spec.hand).names, *states]
    columns = [("id", pa.int64()), ("parent", pa.int64()), *((n, pa.float64()) for n in floats)]
    return pa.schema(columns).empty_table()


def _ranked(measured: pa.Table, spec: Spec) -> pa.Table:
    """Measured hands with scores; none of them counts as impossible to make."""
    if "makeable" not in measured.column_names:
        n = measured.num_rows
        measured = measured.append_column("makeable", pa.array(np.ones(n, dtype=bool)))
        measured = measured.append_column("reason", pa.array([""] * n, pa.string()))
    more = [Metric(*told) for told in scored_by(measured.column_names, list(spec.poses))]
    return rank_table(measured, list(spec.poses), spec.selection, more)


def _no_metrics(spec: Spec) -> pa.Table:
    kinds = ("tmr_deg", "mss_mm_s", "mft_nmm", "mft_p90_nmm", "tip_force_n")
    names = [f"{pose}_{kind}" for pose in spec.poses for kind in kinds]
    return pa.schema([("id", pa.int64()), *((name, pa.float64()) for name in names)]).empty_table()


def _shards(folder: Path, manifest: dict[str, Any], stage: str) -> pa.Table | None:
    """All finished shards of a stage with the inputs that the manifest names; None without any."""
    key = manifest["stages"].get(stage, {}).get("key", "")
    files = Shards(folder / "store" / f"{stage}-{key[:12]}").files() if key else []
    if not files:
        return None
    return pa.concat_tables([read_table(file) for file in files], promote_options="default")


def _done(manifest: dict[str, Any], stage: str) -> bool:
    return manifest["stages"].get(stage, {}).get("status") == "done"
