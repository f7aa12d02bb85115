"""Searching a first hand: jointly over designs and poses, from many starts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import SolveError
from fpcad.model.hand import hand_template
from fpcad.sample.space import DesignSpace
from fpcad.solve.attempt import Attempt, SolvedPose, Workbench, held, solve_pose
from fpcad.solve.start import random_start
from fpcad.spec.schema import Spec
from fpcad.workers import Workers

Array = NDArray[np.float64]

STARTS_PER_ROUND = 16
ENOUGH = 6
"""Held solutions of a pose of which the best is taken."""

Judge = Callable[[Workbench, str, Array, Array], float]
"""Merit of a held pose, from pose name, design [mm, rad] and state y; more is better."""


@dataclass(frozen=True)
class FirstHand:
    """A hand that reaches and holds all poses."""

    named: Array  # (n_d,) [mm, deg]
    attempt: Attempt
    starts: int
    """Starts that were tried in all."""


@dataclass(frozen=True)
class _Start:
    """One random start: everything that its result depends on."""

    pose: str
    design: Array
    seed: tuple[int, ...]


def search_start(
    workers: Workers[Workbench],
    space: DesignSpace,
    spec: Spec,
    judge: Judge,
    advance: Callable[[int, str], None],
) -> FirstHand:
    """Find a design all of whose poses can be solved and held.

    Designs are tried from the middle of the box on, then at random; each pose gets random
    starts until enough of them end in a held pose, and the one that `judge` likes best is kept:
    the cost alone would let the tree inherit a branch that wields badly. A pose that no start
    reaches ends the design.

    Raises:
        SolveError: no design of `solver.start_designs` reached all poses.
    """
    template = hand_template(spec.hand)
    starts, missed = 0, "geometry"
    for trial in range(spec.solver.start_designs):
        named = space.named(_design_point(space, spec, trial))
        design = space.internal(named)
        if not template.feasible(design):
            continue
        poses: dict[str, SolvedPose] = {}
        for place, pose in enumerate(spec.poses):
            advance(0, f"design {trial + 1}, {pose}")
            seed = (spec.sampling.seed, trial, place)
            found, used = _search_pose(workers, spec, judge, pose, design, seed)
            starts += used
            advance(used, "")
            if found is None:
                missed = pose
                break
            poses[pose] = found
        else:
            return FirstHand(named, Attempt(design, poses, ""), starts)
    raise SolveError(
        f"no first hand found: {starts} starts over {spec.solver.start_designs} designs, the last "
        f"of which failed at `{missed}`; widen that pose's windows or the design's ranges, give "
        "an `initial` hand, or raise `solver.starts` and `solver.start_designs`"
    )


def _design_point(space: DesignSpace, spec: Spec, trial: int) -> Array:
    """Standardized design (n_free,): the middle of the box first, then uniform samples."""
    n_free = int(space.free.sum())
    if trial == 0:
        return np.zeros(n_free)
    return np.random.default_rng([spec.sampling.seed, trial]).uniform(-0.5, 0.5, n_free)


def _search_pose(
    workers: Workers[Workbench],
    spec: Spec,
    judge: Judge,
    pose: str,
    design: Array,
    seed: tuple[int, ...],
) -> tuple[SolvedPose | None, int]:
    """The best held solution of one pose, and the starts it took.

    Rounds have a fixed size, so that the result does not depend on the number of workers.
    """
    held_poses: list[tuple[float, SolvedPose]] = []
    used = 0
    while used < spec.solver.starts and len(held_poses) < ENOUGH:
        numbers = range(used, min(used + STARTS_PER_ROUND, spec.solver.starts))
        tasks = [_Start(pose, design, (*seed, number)) for number in numbers]
        found = workers.map(partial(_try_start, judge), tasks, lambda *_: None)
        held_poses += [result for result in found if result is not None]
        used += len(numbers)
    best = max(held_poses, key=lambda result: result[0], default=None)
    return (None if best is None else best[1]), used


def _try_start(judge: Judge, bench: Workbench, start: _Start) -> tuple[float, SolvedPose] | None:
    """One start: solved, held and judged, or nothing."""
    state = random_start(bench, start.pose, start.design, np.random.default_rng(start.seed))
    solved = solve_pose(bench, start.pose, start.design, state)
    if solved is None or not held(bench, start.pose, start.design, solved.y):
        return None
    return judge(bench, start.pose, start.design, solved.y), solved
