"""Stage evaluate: paths and metrics of all candidates."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, fields
from functools import partial
from itertools import chain, islice
from typing import Any, TypeVar

import numpy as np
import pyarrow as pa

from fpcad.pipeline.paths import ATTACHMENT, CANDIDATES_PER_SHARD, evaluation_table, size_note
from fpcad.pipeline.sample import NOT_A_NUMBER, read_candidates
from fpcad.pipeline.stage import Build, Counts, Progress, Stage
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Workbench
from fpcad.store import write_table
from fpcad.wield.evaluate import Evaluation, evaluate
from fpcad.wield.metrics import PathMetrics
from fpcad.wield.path import WieldingPath
from fpcad.wield.plugins import PathMetric, installed_metrics, measured

Item = TypeVar("Item")

FILE = "store/metrics.parquet"


def evaluate_all(build: Build) -> Counts:
    """Trace and measure every candidate that the store does not hold yet.

    A candidate whose evaluation fails is recorded as one without paths, with the reason.
    """
    shards = build.shards("evaluate")
    candidates = list(read_candidates(build))
    done = len(shards.rows())
    with (
        build.open_workers() as workers,
        build.reporter.stage("wielding the tool", len(candidates)) as bar,
    ):
        bar.advance(done)
        todo = candidates[done:]
        space, poses = design_space(build.spec.hand), list(build.spec.poses)
        evaluations = workers.map(
            partial(evaluate_candidate, space),
            todo,
            lambda _, reason: failed_evaluation(poses, reason),
        )
        first = list(islice(evaluations, 1))
        if first and first[0].paths:
            build.reporter.note(size_note(build, first[0], len(candidates)))
        for chunk in _chunks(zip(todo, chain(first, evaluations), strict=True)):
            _store(build, chunk, bar)
    rows = shards.rows()
    write_table(build.folder / FILE, pa.Table.from_pylist(rows, metrics_schema(build)))
    failures = Counter(row["reason"] for row in rows if row["reason"])
    for reason, count in failures.most_common():
        build.reporter.note(f"could not be evaluated, {count} of {len(rows)} hands: {reason}")
    wielding = [all(row[f"{p}_tmr_deg"] > 0 for p in build.spec.poses) for row in rows]
    return {
        "candidates": len(rows),
        "wielding_all_poses": sum(wielding),
        "failed": failures.total(),
    }


def evaluate_candidate(space: DesignSpace, bench: Workbench, candidate: Candidate) -> Evaluation:
    """Paths and metrics of one candidate; a pose whose path is not made of numbers has none."""
    states = {pose: solved.y for pose, solved in candidate.poses.items()}
    evaluation = evaluate(bench, space.internal(candidate.named), states)
    paths, metrics = {}, {}
    for pose, path in evaluation.paths.items():
        if made_of_numbers(path, evaluation.metrics[pose]):
            paths[pose], metrics[pose] = path, evaluation.metrics[pose]
        else:
            metrics[pose] = no_path(NOT_A_NUMBER)
    return Evaluation(paths, metrics)


def failed_evaluation(poses: Iterable[str], reason: str) -> Evaluation:
    """What stands for a candidate whose evaluation failed as a whole."""
    return Evaluation({}, {pose: no_path(reason) for pose in poses})


def no_path(reason: str) -> PathMetrics:
    """Metrics of a pose without a path: they score 0."""
    return PathMetrics(0.0, np.nan, np.nan, np.nan, 0.0, end_plus=reason, end_minus=reason)


def made_of_numbers(path: WieldingPath, metrics: PathMetrics) -> bool:
    """Whether states and metrics are finite, as far as a path that may not move has them."""
    figures = [metrics.tmr_deg, metrics.tip_force_n]
    if metrics.tmr_deg > 0:
        figures += [metrics.mss_mm_s, metrics.mft_nmm, metrics.mft_p90_nmm]
    states = (path.tool_angle_rad, path.joints_rad, path.contacts, path.hand_in_tool)
    return all(np.isfinite(values).all() for values in (figures, *states))


def metrics_schema(build: Build) -> pa.Schema:
    """Columns of the metrics: id, each pose's figures and reasons, and whether all went well."""
    kinds = {"float": pa.float64(), "str": pa.string()}
    columns = [
        (f"{pose}_{field.name}", kinds[str(field.type)])
        for pose in build.spec.poses
        for field in fields(PathMetrics)
    ]
    more = [metric.name for metric in installed_metrics()]
    columns += [(f"{pose}_{name}", pa.float64()) for pose in build.spec.poses for name in more]
    judged = [("makeable", pa.bool_()), ("reason", pa.string())]
    return pa.schema([("id", pa.int64()), *columns, *judged])


def _chunks(items: Iterable[Item]) -> Iterator[Iterator[Item]]:
    """The items, a shard's worth at a time, each taken only when it is asked for."""
    items = iter(items)
    while (first := next(items, None)) is not None:
        yield chain([first], islice(items, CANDIDATES_PER_SHARD - 1))


def _store(build: Build, evaluated: Iterable[tuple[Candidate, Evaluation]], bar: Progress) -> None:
    """Write one shard of metrics, with the paths where the spec keeps more than the chosen one's."""
    rows, attachments, more = [], [], installed_metrics()
    for candidate, evaluation in evaluated:
        rows.append(_metrics_row(candidate.id, evaluation, more))
        if build.spec.path.keep != "selected":
            attachments.append(evaluation_table(candidate.id, evaluation))
        bar.advance()
    table = pa.Table.from_pylist(rows, metrics_schema(build))
    kept = {ATTACHMENT: pa.concat_tables(attachments)} if attachments else {}
    build.shards("evaluate").append(table, **kept)


def _metrics_row(
    candidate: int, evaluation: Evaluation, more: Sequence[PathMetric]
) -> dict[str, Any]:
    """One row; a hand that was not evaluated in all poses cannot be chosen."""
    row: dict[str, Any] = {"id": candidate}
    for pose, metrics in evaluation.metrics.items():
        row |= {f"{pose}_{name}": value for name, value in asdict(metrics).items()}
        found = measured(more, evaluation.paths.get(pose), metrics.tmr_deg > 0)
        row |= {f"{pose}_{m.name}": value for m, value in zip(more, found, strict=True)}
    missing = [pose for pose in evaluation.metrics if pose not in evaluation.paths]
    reason = f"{missing[0]}: {evaluation.metrics[missing[0]].end_plus}" if missing else ""
    return {**row, "makeable": not missing, "reason": reason}


EVALUATE = Stage("evaluate", ("path", "motors"), ("wield",), (FILE,), evaluate_all, 2, plugins=True)
