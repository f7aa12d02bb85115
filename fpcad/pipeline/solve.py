"""Stage solve: the hand that sampling starts from."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from fpcad.errors import SolveError
from fpcad.model.state import pose_state
from fpcad.pipeline.stage import Build, Counts, Stage
from fpcad.pipeline.tables import candidate_row, candidate_schema, read_candidate
from fpcad.sample.search import search_start
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Attempt, attempt
from fpcad.spec.pose import Initial
from fpcad.store import read_table, write_table
from fpcad.wield.evaluate import motion_range

FILE = "store/start.parquet"


def solve(build: Build) -> Counts:
    """Solve all poses of the first hand, from the spec's `initial` or by a search."""
    space, initial = design_space(build.spec.hand), build.spec.initial
    if initial is not None:
        named = np.array([initial.design[name] for name in space.names])
        first, starts = _polish(build, space, named, initial), 0
    else:
        named, first, starts = _search(build, space)
    start = Candidate(0, -1, named, first.poses)
    row, schema = candidate_row(start, build.bench, space), candidate_schema(build.bench, space)
    write_table(build.folder / FILE, pa.Table.from_pylist([row], schema))
    return {"starts": starts, "poses": len(first.poses)}


def read_start(build: Build) -> Candidate:
    """The first hand, as the stage left it."""
    row = read_table(build.folder / FILE).to_pylist()[0]
    return read_candidate(row, build.bench, design_space(build.spec.hand))


def _polish(build: Build, space: DesignSpace, named: np.ndarray, initial: Initial) -> Attempt:
    names = build.bench.template.names
    with build.reporter.stage("solving the initial hand", len(build.spec.poses)) as bar:
        states = {pose: pose_state(given, names) for pose, given in initial.poses.items()}
        solved = attempt(build.bench, space.internal(named), states)
        bar.advance(len(solved.poses))
    if not solved.succeeded:
        raise SolveError(
            f"the spec's initial hand does not reach its poses ({solved.reason}); "
            "leave `initial` out to have a start searched for"
        )
    return solved


def _search(build: Build, space: DesignSpace) -> tuple[np.ndarray, Attempt, int]:
    with (
        build.open_workers() as workers,
        build.reporter.stage("searching a first hand", None) as bar,
    ):
        found = search_start(workers, space, build.spec, motion_range, bar.advance)
    return found.named, found.attempt, found.starts


SOLVE = Stage(
    "solve",
    ("tool", "hand", "poses", "statics", "bounds", "solver", "initial"),
    ("spec", "model", "solve", "sample"),
    (FILE,),
    solve,
)
