"""Stage select: scores, Pareto front, the chosen hand and its paths."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa

from fpcad.pipeline.evaluate import FILE as METRICS_FILE
from fpcad.pipeline.evaluate import evaluate_candidate
from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build, Counts, Stage
from fpcad.pipeline.tables import PATH_SCHEMA, path_table
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.select.choose import Choice, choose
from fpcad.select.ranking import rank_table
from fpcad.store import read_table, write_json, write_table
from fpcad.wield.demand import torque_demand
from fpcad.wield.evaluate import Evaluation

METRICS, PATHS, SELECTED = "metrics.parquet", "paths.parquet", "selected.json"


def select(build: Build) -> Counts:
    """Rank all candidates, choose one, and keep the paths that the spec asks for.

    Every hand counts as makeable until making it has failed; see :func:`refuse`.
    """
    metrics = read_table(build.folder / METRICS_FILE)
    n = metrics.num_rows
    metrics = metrics.append_column("makeable", pa.array(np.ones(n, dtype=bool)))
    return _settle(build, metrics.append_column("reason", pa.array([""] * n)))


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
    """Rank the hands, choose among those that can be made, and write what follows."""
    space, rule = design_space(build.spec.hand), build.spec.selection.rule
    ranked = rank_table(metrics, list(build.spec.poses), build.spec.selection)
    choice = choose(ranked, rule)
    candidate = next(c for c in read_candidates(build) if c.id == choice.id)
    evaluation = evaluate_candidate(space, build.bench, candidate)
    _keep_paths(build, _kept(build, ranked), choice.id, evaluation)
    write_json(build.folder / SELECTED, _selected(build, space, candidate, evaluation, choice))
    write_table(build.folder / METRICS, ranked)
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


def _keep_paths(build: Build, kept: list[int], chosen: int, evaluation: Evaluation) -> None:
    """Write the paths of the kept candidates and, with a rule off the front, of the chosen one."""
    tables = [PATH_SCHEMA.empty_table()]
    for shard in build.shards("evaluate").attachments("paths"):
        tables.append(shard.filter(np.isin(shard["id"].to_numpy(), kept)))
    if chosen not in kept:
        tables += [path_table(chosen, path) for path in evaluation.paths.values()]
    write_table(build.folder / PATHS, pa.concat_tables(tables))


def _selected(
    build: Build, space: DesignSpace, candidate: Candidate, evaluation: Evaluation, choice: Choice
) -> dict[str, Any]:
    """What selected.json tells."""
    design = space.internal(candidate.named)
    demand = {
        pose: torque_demand(build.bench, pose, design, path)
        for pose, path in evaluation.paths.items()
    }
    return {
        "id": choice.id,
        "design": dict(zip(space.names, candidate.named.tolist(), strict=True)),
        "rule": choice.rule,
        "reason": choice.reason,
        "scores": choice.scores,
        "motor": build.spec.motors.type,
        "torque": {pose: told.to_json() for pose, told in demand.items()},
    }


SELECT = Stage(
    "select",
    ("selection", "path", "motors"),
    ("wield", "select"),
    (METRICS, PATHS, SELECTED),
    select,
)
