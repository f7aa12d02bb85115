"""The control group: how well do hands wield that lack a part of what makes a candidate?"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from benchmarks.paper.control_states import (
    Disturbed,
    Prepare,
    Subject,
    own_states,
    reattempted_states,
    without_tip_force,
)
from fpcad.model.equilibrium import least_torque
from fpcad.model.pose import HAND_SIZE
from fpcad.model.statics import cone_facets
from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Workbench
from fpcad.store import read_json, read_table, write_table
from fpcad.wield.evaluate import evaluate

CHUNK = 20
SEED = 7
STATICS = ": statics"


@dataclass(frozen=True)
class Group:
    """Hands that are examined in the same way."""

    name: str
    rejected: bool
    """Whether its subjects are calls rejected by statics instead of candidates."""
    prepare: Prepare


GROUPS = (
    Group("candidates", False, own_states),
    Group("rejected by statics", True, reattempted_states),
    Group("near the optimum", False, Disturbed(0.1)),
    Group("far from the optimum", False, Disturbed(0.3)),
)


def examine_groups(build: Build, count: int) -> dict[str, list[dict[str, Any]]]:
    """Rows of all groups, `count` random hands each, from finished chunks where there are some.

    A hand whose poses cannot be prepared has no rows.
    """
    folder = build.folder / f"control-{_digest(build)}"
    candidates = list(read_candidates(build))
    rows: dict[str, list[dict[str, Any]]] = {}
    with build.open_workers() as workers:
        for group in GROUPS:
            subjects = _rejected(build, candidates) if group.rejected else _own(candidates)
            chosen = _choose(subjects, count)
            task = partial(examine, group.prepare, design_space(build.spec.hand))
            rows[group.name] = []
            with build.reporter.stage(f"control group: {group.name}", len(chosen)) as bar:
                for first in range(0, len(chosen), CHUNK):
                    chunk = chosen[first : first + CHUNK]
                    file = folder / _file_name(group, chunk)
                    if not file.exists():
                        found = [row for rows in workers.map(task, chunk) for row in rows]
                        write_table(file, pa.Table.from_pylist(found, SCHEMA))
                    rows[group.name] += read_table(file).to_pylist()
                    bar.advance(len(chunk))
    return rows


def examine(
    prepare: Prepare, space: DesignSpace, bench: Workbench, subject: Subject
) -> list[dict[str, Any]]:
    """One row for each pose of a hand: held or not, and its motion with and without statics."""
    states = prepare(bench, space, subject)
    if states is None:
        return []
    design = space.internal(subject.named)
    with_statics = evaluate(bench, design, states).metrics
    without = evaluate(without_tip_force(bench), design, states).metrics
    return [
        {
            "hand": subject.number,
            "pose": pose,
            "held": directions_held(bench, pose, design, y),
            "cost": _cost(bench, pose, design, y),
            "moved": _moved(bench, pose, subject.states[pose], y),
            "tmr_on_deg": with_statics[pose].tmr_deg,
            "tmr_off_deg": without[pose].tmr_deg,
            "off_end_minus": without[pose].end_minus,
            "off_end_plus": without[pose].end_plus,
        }
        for pose, y in states.items()
    ]


SCHEMA = pa.schema(
    [
        ("hand", pa.int64()),
        ("pose", pa.string()),
        ("held", pa.int64()),
        ("cost", pa.float64()),
        ("moved", pa.float64()),
        ("tmr_on_deg", pa.float64()),
        ("tmr_off_deg", pa.float64()),
        ("off_end_minus", pa.string()),
        ("off_end_plus", pa.string()),
    ]
)


def directions_held(bench: Workbench, pose: str, design: np.ndarray, y: np.ndarray) -> int:
    """In how many of the two directions of turning a pose withstands the tip force: 0, 1 or 2."""
    cap, force = bench.spec.statics.max_joint_torque_nmm, bench.spec.poses[pose].tip_force_n
    values = bench.kernels[pose].statics(design, y[:HAND_SIZE], 0.0, y[HAND_SIZE:])
    wrench, torque, tip = (value.copy() for value in values)
    facets = cone_facets(bench.spec.statics)
    ways = (least_torque(wrench, torque, sign * force * tip, cap, facets) for sign in (1.0, -1.0))
    return sum(way is not None for way in ways)


def _cost(bench: Workbench, pose: str, design: np.ndarray, y: np.ndarray) -> float:
    residuals = bench.kernels[pose].constraints(design, 0.0, y)[0]
    return float(residuals @ residuals)


def _moved(bench: Workbench, pose: str, before: np.ndarray, after: np.ndarray) -> float:
    """Root mean square change of a state's variables; 1 is 10 mm and 1 rad."""
    step = (after - before) / bench.kernels[pose].layout.scale
    return float(np.sqrt(np.mean(step**2)))


def _own(candidates: Sequence[Candidate]) -> list[Subject]:
    return [Subject(c.id, c.named, _states(c)) for c in candidates]


def _rejected(build: Build, candidates: Sequence[Candidate]) -> list[Subject]:
    """Calls that reached all poses but are not held in one, with their parents' states."""
    names = design_space(build.spec.hand).names
    return [
        Subject(
            row["number"], np.array([row[n] for n in names]), _states(candidates[row["parent"]])
        )
        for row in read_table(build.folder / "calls.parquet").to_pylist()
        if row["reason"].endswith(STATICS)
    ]


def _states(candidate: Candidate) -> dict[str, np.ndarray]:
    return {pose: solved.y for pose, solved in candidate.poses.items()}


def _choose(subjects: list[Subject], count: int) -> list[Subject]:
    """A random sample in order; all where there are no more than `count`."""
    if len(subjects) <= count:
        return subjects
    places = np.random.default_rng(SEED).choice(len(subjects), count, replace=False)
    return [subjects[place] for place in sorted(places)]


def _file_name(group: Group, chunk: list[Subject]) -> str:
    numbers = ",".join(str(subject.number) for subject in chunk)
    digest = hashlib.sha256(numbers.encode()).hexdigest()[:12]
    return f"{group.name.replace(' ', '-')}-{digest}.parquet"


def _digest(build: Build) -> str:
    """Name of everything that the rows depend on: the build, and how hands are examined."""
    stages = read_json(build.folder / "manifest.json")["stages"]
    digest = hashlib.sha256(stages["evaluate"]["key"].encode())
    for source in ("control.py", "control_states.py"):
        digest.update(Path(__file__).with_name(source).read_bytes())
    return digest.hexdigest()[:12]
