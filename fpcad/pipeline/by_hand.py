"""A hand that a person chose instead of the rule, made like the rule's."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from fpcad.errors import StoreError
from fpcad.pipeline.evaluate import evaluate_candidate
from fpcad.pipeline.paths import FILE as PATHS
from fpcad.pipeline.paths import evaluation_table
from fpcad.pipeline.run import is_current, run_stages
from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.select import METRICS, SELECTED, describe_choice
from fpcad.pipeline.stage import Build
from fpcad.pipeline.tables import PATH_SCHEMA
from fpcad.sample.space import design_space
from fpcad.select.choose import Choice, single_scores
from fpcad.select.scores import MEAN_SCORE
from fpcad.store import read_json, read_table, write_json, write_tables
from fpcad.wield.path import WieldingPath

RULE = "by hand"
REASON = "chosen by hand"


def choose_by_hand(build: Build, candidate: int) -> int:
    """Make a candidate the chosen hand, export it and write the report anew.

    It stays chosen until what the selection depends on changes. A hand that cannot be made is
    refused like any other; the id that is returned is then another one's.
    """
    if not is_current(build, "select"):
        raise StoreError(
            f"{build.folder}: made from another spec or by another version; "
            f"run `fpcad design {build.folder.name}` first"
        )
    metrics = read_table(build.folder / METRICS, pc.field("id") == candidate)
    if metrics.num_rows != 1:
        raise StoreError(f"{build.folder}: no measured hand {candidate}")
    row = metrics.to_pylist()[0]
    if not row["makeable"]:
        raise StoreError(f"hand {candidate} cannot be made: {row['reason']}")
    scores = {name: row[name] for name in [*single_scores(metrics), MEAN_SCORE]}
    _keep_paths_too(build, candidate)
    choice = Choice(candidate, RULE, REASON, scores)
    write_json(build.folder / SELECTED, describe_choice(build, choice))
    run_stages(build, "export", force=True)
    run_stages(build, "report")
    return int(read_json(build.folder / SELECTED)["id"])


def trace_candidate(build: Build, candidate: int) -> list[WieldingPath]:
    """The paths of one candidate, traced now; no file is written."""
    found = [c for c in read_candidates(build) if c.id == candidate]
    if not found:
        raise StoreError(f"{build.folder}: no candidate {candidate}")
    space = design_space(build.spec.hand)
    return list(evaluate_candidate(space, build.bench, found[0]).paths.values())


def _keep_paths_too(build: Build, candidate: int) -> None:
    """Add a candidate's paths to those that are kept."""
    file = build.folder / PATHS
    if read_table(file, pc.field("id") == candidate).num_rows:
        return
    found = next(c for c in read_candidates(build) if c.id == candidate)
    evaluate = partial(evaluate_candidate, design_space(build.spec.hand), build.bench)

    def tables() -> Iterator[pa.Table]:
        with pq.ParquetFile(file) as kept:
            for batch in kept.iter_batches():
                yield pa.Table.from_batches([batch]).cast(PATH_SCHEMA)
        yield evaluation_table(candidate, evaluate(found))

    write_tables(file, PATH_SCHEMA, tables())
