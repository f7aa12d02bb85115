"""Stage sample: the tree of candidates."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fpcad.pipeline.solve import read_start
from fpcad.pipeline.stage import Build, Counts, Stage
from fpcad.pipeline.tables import (
    call_row,
    call_schema,
    candidate_row,
    candidate_schema,
    read_call,
    read_candidate,
)
from fpcad.sample.rrt import ACCEPTED, Call, Proposal, grow, stop_reason
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate, Tree
from fpcad.solve.attempt import Attempt, Workbench, attempt
from fpcad.store import read_table, write_table
from fpcad.workers import Workers

Array = NDArray[np.float64]
Item = tuple[Proposal, dict[str, Array]]

CALLS, CANDIDATES = "calls.parquet", "candidates.parquet"
BATCHES_PER_SHARD = 16
NOT_A_NUMBER = "not a number"


def sample(build: Build) -> Counts:
    """Grow the tree to its end, batch by batch, from what the store already holds."""
    space, settings = design_space(build.spec.hand), build.spec.sampling
    tree, calls = _restore(build, space)
    schema = _shard_schema(build.bench, space)
    with (
        build.open_workers() as workers,
        build.reporter.stage("sampling hands", settings.candidates) as bar,
    ):
        bar.advance(len(tree.candidates))
        pending: list[Call] = []
        for batch in grow(tree, settings, partial(_solve_batch, workers, space), calls):
            pending += batch
            accepted = sum(call.outcome == ACCEPTED for call in batch)
            share = (len(tree.candidates) - 1) / len(calls)
            bar.advance(accepted, f"{len(calls)} calls, {share:.0%} accepted")
            if len(pending) >= BATCHES_PER_SHARD * settings.batch:
                _store(build, tree, pending, space, schema)
                pending = []
        _store(build, tree, pending, space, schema)
    _compact(build, tree, calls, space)
    outcomes = Counter(call.outcome for call in calls)
    reason = stop_reason(tree, settings, calls) or ""
    return {"candidates": len(tree.candidates), "calls": len(calls), "stop": reason, **outcomes}


def read_candidates(build: Build) -> Iterator[Candidate]:
    """All candidates, as the stage left them."""
    space = design_space(build.spec.hand)
    for row in read_table(build.folder / CANDIDATES).to_pylist():
        yield read_candidate(row, build.bench, space)


def attempt_item(space: DesignSpace, bench: Workbench, item: Item) -> Attempt:
    """Attempt a proposal from its parent's states; one that is not made of numbers has failed."""
    proposal, states = item
    tried = attempt(bench, space.internal(proposal.named), states)
    for pose, solved in tried.poses.items():
        if not np.isfinite([solved.cost, *solved.y]).all():
            return Attempt(tried.design, {}, f"{pose}: {NOT_A_NUMBER}")
    return tried


def failed_attempt(space: DesignSpace, item: Item, reason: str) -> Attempt:
    """What stands for an attempt that was lost to an error: a rejection."""
    return Attempt(space.internal(item[0].named), {}, reason)


def _solve_batch(
    workers: Workers[Workbench], space: DesignSpace, items: Sequence[Item]
) -> Sequence[Attempt]:
    return list(workers.map(partial(attempt_item, space), items, partial(failed_attempt, space)))


def _restore(build: Build, space: DesignSpace) -> tuple[Tree, list[Call]]:
    """Tree and calls as the finished shards tell them."""
    tree, calls = Tree(space), []
    tree.add(read_start(build))
    for row in build.shards("sample").rows():
        call = read_call(row, space)
        calls.append(call)
        if call.outcome == ACCEPTED:
            tree.add(read_candidate(row | {"id": call.candidate}, build.bench, space))
    return tree, calls


def _shard_schema(bench: Workbench, space: DesignSpace) -> pa.Schema:
    """A call and, where it was accepted, its candidate."""
    calls, candidates = call_schema(space), candidate_schema(bench, space)
    return pa.schema([*calls, *(f for f in candidates if f.name not in (*calls.names, "id"))])


def _store(
    build: Build, tree: Tree, calls: list[Call], space: DesignSpace, schema: pa.Schema
) -> None:
    rows = []
    for call in calls:
        row = call_row(call, space)
        if call.outcome == ACCEPTED:
            row |= candidate_row(tree.candidates[call.candidate], build.bench, space)
        rows.append(row)
    if rows:
        build.shards("sample").append(pa.Table.from_pylist(rows, schema))


def _compact(build: Build, tree: Tree, calls: list[Call], space: DesignSpace) -> None:
    rows = [call_row(call, space) for call in calls]
    write_table(build.folder / CALLS, pa.Table.from_pylist(rows, call_schema(space)))
    rows = [candidate_row(candidate, build.bench, space) for candidate in tree.candidates]
    schema = candidate_schema(build.bench, space)
    write_table(build.folder / CANDIDATES, pa.Table.from_pylist(rows, schema))


SAMPLE = Stage("sample", ("sampling",), ("sample",), (CALLS, CANDIDATES), sample)
