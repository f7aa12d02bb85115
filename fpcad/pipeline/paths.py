"""Paths of many candidates: what they weigh, and which are kept in paths.parquet."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import groupby

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from fpcad.pipeline.stage import Build
from fpcad.pipeline.tables import PATH_SCHEMA, path_table, read_path
from fpcad.store import read_table, write_tables
from fpcad.wield.evaluate import Evaluation
from fpcad.wield.path import WieldingPath

FILE = "paths.parquet"
ATTACHMENT = "paths"
CANDIDATES_PER_SHARD = 16
UNITS = ("bytes", "kB", "MB", "GB", "TB")

EvaluateAgain = Callable[[list[int]], Iterator[Evaluation]]
"""Evaluates candidates by their ids, one after the other as they are asked for."""

KEPT = {
    "all": "all are kept in paths.parquet and while running in store/",
    "front": "all lie in store/ until the hand is exported; paths.parquet keeps the front's",
    "selected": "only the chosen hand's are kept",
}


def evaluation_table(candidate: int, evaluation: Evaluation) -> pa.Table:
    """The states of a candidate's paths as rows."""
    tables = [path_table(candidate, path) for path in evaluation.paths.values()]
    return pa.concat_tables([PATH_SCHEMA.empty_table(), *tables])


def size_note(build: Build, first: Evaluation, candidates: int) -> str:
    """What the paths of all candidates will take, judged by the first one's."""
    table = evaluation_table(0, first)
    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd")
    each = sink.getvalue().size
    return (
        f"paths: about {_size(each)} a hand ({table.num_rows} states), {_size(each * candidates)} "
        f"for {candidates}; {KEPT[build.spec.path.keep]}"
    )


def write_paths(build: Build, kept: list[int], again: EvaluateAgain) -> None:
    """Write the paths of the kept candidates, in the order of their ids.

    They come from the evaluation's shards, one shard in memory at a time; those that are gone from
    there are evaluated again.
    """
    shards, kept = build.shards("evaluate"), sorted(kept)
    there = shards.attachment_numbers(ATTACHMENT)
    evaluations = again([id for id in kept if _shard(id) not in there])

    def tables() -> Iterator[pa.Table]:
        for shard, ids in groupby(kept, _shard):
            wanted = list(ids)
            if shard in there:
                stored = shards.attachment(ATTACHMENT, shard)
                yield stored.filter(np.isin(stored["id"].to_numpy(), wanted))
            else:
                yield pa.concat_tables(evaluation_table(id, next(evaluations)) for id in wanted)

    write_tables(build.folder / FILE, PATH_SCHEMA, tables())


def read_paths(build: Build, candidate: int) -> dict[str, WieldingPath]:
    """The kept paths of one candidate, in the order of the spec's poses."""
    rows = read_table(build.folder / FILE, pc.field("id") == candidate)
    return {
        pose: read_path(rows.filter(pc.field("pose") == pose), kernels.layout)
        for pose, kernels in build.bench.kernels.items()
    }


def drop_spare_paths(build: Build) -> None:
    """Remove the evaluation's paths, where the spec keeps fewer than all of them."""
    if build.spec.path.keep != "all":
        build.shards("evaluate").drop_attachments(ATTACHMENT)


def _shard(candidate: int) -> int:
    """Number of the shard of a candidate."""
    return candidate // CANDIDATES_PER_SHARD


def _size(count: float) -> str:
    """A number of bytes for people, to two digits or so."""
    power = min(int(math.log10(max(count, 1.0))) // 3, len(UNITS) - 1)
    value = count / 1000**power
    return f"{value:.{0 if value >= 10 else 1}f} {UNITS[power]}"
