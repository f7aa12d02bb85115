"""Trials in physics of the hands that the rule ranks first, as columns of the metrics table."""

from __future__ import annotations

from collections import Counter
from functools import partial
from typing import Any

import pyarrow as pa

from fpcad.pipeline.evaluate import evaluate_candidate
from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.select.choose import finalists
from fpcad.simulate.candidate import TRIALS, held_shares
from fpcad.solve.attempt import Workbench

FAULT = "simulation_fault"
"""Column that tells why a hand could not be tried in all poses."""


def share_columns(build: Build) -> list[str]:
    """Columns of the shares of the planned range that were reached; none where nothing is tried."""
    if build.spec.selection.simulate == 0:
        return []
    return [f"{pose}_{column}" for pose in build.spec.poses for column in TRIALS]


def with_trials(build: Build, ranked: pa.Table) -> pa.Table:
    """The ranked table with what physics says of its finalists; other hands have no values there.

    Each result is a shard, so that a run that was killed goes on where it was, and a hand that turns
    out to be one that cannot be made makes room for one more.
    """
    selection, shards = build.spec.selection, build.shards("select")
    wanted = finalists(ranked, selection.rule, selection.simulate)
    done = {row["id"] for row in shards.rows()}
    todo = {id for id in wanted if id not in done}
    candidates = [c for c in read_candidates(build) if c.id in todo]
    schema = _schema(build)
    with (
        build.open_workers() as workers,
        build.reporter.stage("finalists in physics", len(wanted)) as bar,
    ):
        bar.advance(len(wanted) - len(todo))
        task = partial(try_candidate, design_space(build.spec.hand))
        for row in workers.map(task, candidates, partial(_untried, build)):
            shards.append(pa.Table.from_pylist([row], schema))
            bar.advance(1, f"hand {row['id']}: {min(row[c] for c in share_columns(build)):.0%}")
    rows = {row["id"]: row for row in shards.rows() if row["id"] in set(wanted)}
    for fault, count in Counter(row[FAULT] for row in rows.values() if row[FAULT]).most_common():
        build.reporter.note(f"could not be tried in physics, {count} of {len(rows)} hands: {fault}")
    return _joined(ranked, rows, schema)


def try_candidate(space: DesignSpace, bench: Workbench, candidate: Candidate) -> dict[str, Any]:
    """One row: shares of the planned range by pose and trial."""
    paths = evaluate_candidate(space, bench, candidate).paths
    shares, faults = held_shares(bench, space.internal(candidate.named), paths)
    columns = {f"{pose}_{name}": share for pose in shares for name, share in shares[pose].items()}
    fault = "; ".join(f"{pose}: {reason}" for pose, reason in faults.items())
    return {"id": candidate.id, **columns, FAULT: fault}


def _untried(build: Build, candidate: Candidate, reason: str) -> dict[str, Any]:
    """What stands for a candidate whose trials failed as a whole."""
    return {"id": candidate.id, **dict.fromkeys(share_columns(build), 0.0), FAULT: reason}


def _schema(build: Build) -> pa.Schema:
    shares = [(column, pa.float64()) for column in share_columns(build)]
    return pa.schema([("id", pa.int64()), *shares, (FAULT, pa.string())])


def _joined(ranked: pa.Table, rows: dict[int, dict[str, Any]], schema: pa.Schema) -> pa.Table:
    """The table with the columns of the trials put in place of older ones, or at the end."""
    ids = ranked["id"].to_pylist()
    for field in schema.remove(0):
        values = pa.array([rows[id][field.name] if id in rows else None for id in ids], field.type)
        if field.name in ranked.column_names:
            ranked = ranked.drop_columns([field.name])
        ranked = ranked.append_column(field, values)
    return ranked
