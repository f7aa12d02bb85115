"""Stage evaluate: paths and metrics of all candidates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, fields
from functools import partial
from itertools import chain, islice
from typing import Any, TypeVar

import pyarrow as pa

from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build, Counts, Progress, Stage
from fpcad.pipeline.tables import PATH_SCHEMA, path_table
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Workbench
from fpcad.store import write_table
from fpcad.wield.evaluate import Evaluation, evaluate
from fpcad.wield.metrics import PathMetrics

Item = TypeVar("Item")

FILE = "store/metrics.parquet"
CANDIDATES_PER_SHARD = 16


def evaluate_all(build: Build) -> Counts:
    """Trace and measure every candidate that the store does not hold yet."""
    space, shards = design_space(build.spec.hand), build.shards("evaluate")
    candidates = list(read_candidates(build))
    done = len(shards.rows())
    with (
        build.open_workers() as workers,
        build.reporter.stage("wielding the tool", len(candidates)) as bar,
    ):
        bar.advance(done)
        todo = candidates[done:]
        evaluations = workers.map(partial(evaluate_candidate, space), todo)
        for chunk in _chunks(zip(todo, evaluations, strict=True)):
            _store(build, chunk, bar)
    rows = shards.rows()
    write_table(build.folder / FILE, pa.Table.from_pylist(rows, metrics_schema(build)))
    wielding = [all(row[f"{p}_tmr_deg"] > 0 for p in build.spec.poses) for row in rows]
    return {"candidates": len(rows), "wielding_all_poses": sum(wielding)}


def _chunks(items: Iterable[Item]) -> Iterator[Iterator[Item]]:
    """The items, a shard's worth at a time, each taken only when it is asked for."""
    items = iter(items)
    while (first := next(items, None)) is not None:
        yield chain([first], islice(items, CANDIDATES_PER_SHARD - 1))


def _store(build: Build, evaluated: Iterable[tuple[Candidate, Evaluation]], bar: Progress) -> None:
    """Write one shard of metrics, with the paths where the spec keeps more than the chosen one's."""
    rows, paths = [], [PATH_SCHEMA.empty_table()]
    for candidate, evaluation in evaluated:
        rows.append(_metrics_row(candidate.id, evaluation))
        if build.spec.path.keep != "selected":
            paths += [path_table(candidate.id, path) for path in evaluation.paths.values()]
        bar.advance()
    table = pa.Table.from_pylist(rows, metrics_schema(build))
    build.shards("evaluate").append(table, paths=pa.concat_tables(paths))


def evaluate_candidate(space: DesignSpace, bench: Workbench, candidate: Candidate) -> Evaluation:
    """Paths and metrics of one candidate."""
    states = {pose: solved.y for pose, solved in candidate.poses.items()}
    return evaluate(bench, space.internal(candidate.named), states)


def metrics_schema(build: Build) -> pa.Schema:
    """Columns of the metrics: id, and each pose's figures and reasons."""
    kinds = {"float": pa.float64(), "str": pa.string()}
    columns = [
        (f"{pose}_{field.name}", kinds[str(field.type)])
        for pose in build.spec.poses
        for field in fields(PathMetrics)
    ]
    return pa.schema([("id", pa.int64()), *columns])


def _metrics_row(candidate: int, evaluation: Evaluation) -> dict[str, Any]:
    row: dict[str, Any] = {"id": candidate}
    for pose, metrics in evaluation.metrics.items():
        row |= {f"{pose}_{name}": value for name, value in asdict(metrics).items()}
    return row


EVALUATE = Stage("evaluate", ("path", "motors"), ("wield",), (FILE,), evaluate_all)
