"""Stage select: scores, Pareto front, trials in physics, the chosen hand and its paths."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import pyarrow as pa

from fpcad.pipeline.evaluate import FILE as METRICS_FILE
from fpcad.pipeline.evaluate import evaluate_candidate
from fpcad.pipeline.finalists import share_columns, with_trials
from fpcad.pipeline.makeable import refuse_early
from fpcad.pipeline.paths import FILE as PATHS
from fpcad.pipeline.paths import read_paths, write_paths
from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build, Counts, Stage
from fpcad.sample.space import design_space
from fpcad.select.choose import Choice, choose
from fpcad.select.ranking import rank_table
from fpcad.select.scores import Metric
from fpcad.store import read_table, write_json, write_table
from fpcad.wield.demand import torque_demand
from fpcad.wield.evaluate import Evaluation
from fpcad.wield.plugins import scored_by

METRICS, SELECTED = "metrics.parquet", "selected.json"


def select(build: Build) -> Counts:
    """Rank all candidates, choose one, and keep the paths that the spec asks for.

    Hands whose numbers alone forbid to make them are out at once. Every other one that was
    evaluated counts as makeable until making it has failed; see :func:`refuse`.
    """
    return _settle(build, refuse_early(build, read_table(build.folder / METRICS_FILE)))


def refuse(build: Build, candidate: int, reason: str) -> None:
    """Mark a candidate as one that cannot be made, say why, and choose another."""
    metrics = read_table(build.folder / METRICS)
    rows = metrics.to_pylist()
    refused = [
        {**row, "makeable": False, "reason": reason} for row in rows if row["id"] == candidate
    ]
    others = [row for row in rows if row["id"] != candidate]
    rows = sorted(others + refused, key=lambda row: row["id"])
    _settle(build, pa.Table.from_pylist(rows, metrics.schema))


def _settle(build: Build, metrics: pa.Table) -> Counts:
    """Rank the hands, choose among those that can be made, and write what follows.

    The choice is written last: a kill before it has the same hand refused again, for the same reason.
    """
    poses, selection = list(build.spec.poses), build.spec.selection
    more = [Metric(*told) for told in scored_by(metrics.column_names, poses)]
    ranked = rank_table(metrics, poses, selection, more)
    if selection.simulate:
        ranked = with_trials(build, ranked)
    choice = choose(ranked, selection.rule, share_columns(build))
    write_table(build.folder / METRICS, ranked)
    write_paths(build, list({choice.id, *_kept(build, ranked)}), partial(_evaluate_again, build))
    write_json(build.folder / SELECTED, describe_choice(build, choice))
    return {"selected": choice.id, "front": int(sum(ranked["pareto"].to_pylist()))}


def _kept(build: Build, ranked: pa.Table) -> list[int]:
    """Candidates whose paths are kept, beside the chosen one."""
    match build.spec.path.keep:
        case "all":
            return ranked["id"].to_pylist()
        case "front":
            return ranked.filter(ranked["pareto"])["id"].to_pylist()
        case "selected":
            return []


def _evaluate_again(build: Build, ids: list[int]) -> Iterator[Evaluation]:
    wanted, space = set(ids), design_space(build.spec.hand)
    candidates = [c for c in read_candidates(build) if c.id in wanted]
    if candidates:
        with build.open_workers() as workers:
            yield from workers.map(partial(evaluate_candidate, space), candidates)


def describe_choice(build: Build, choice: Choice) -> dict[str, Any]:
    """What selected.json tells of a hand whose paths are kept."""
    space = design_space(build.spec.hand)
    named = next(c.named for c in read_candidates(build) if c.id == choice.id)
    demand = {
        pose: torque_demand(build.bench, pose, space.internal(named), path)
        for pose, path in read_paths(build, choice.id).items()
    }
    return {
        "id": choice.id,
        "design": dict(zip(space.names, named.tolist(), strict=True)),
        "rule": choice.rule,
        "reason": choice.reason,
        "scores": choice.scores,
        "motor": build.spec.motors.type,
        "torque": {pose: told.to_json() for pose, told in demand.items()},
    }


SELECT = Stage(
    "select",
    ("selection", "path", "motors", "print", "mount"),
    ("wield", "select", "make/parts", "make/gates"),
    (METRICS, PATHS, SELECTED),
    select,
    physics=lambda spec: spec.selection.simulate > 0,
)
