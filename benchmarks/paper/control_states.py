"""Poses that candidates do not have: not held, or in contact but off the cost's optimum."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fpcad.sample.space import DesignSpace
from fpcad.solve.attempt import Workbench, attempt
from fpcad.solve.measure import measure
from fpcad.solve.program import build_pose_program, pose_bounds
from fpcad.solve.sqp import SqpSettings, restore

Array = NDArray[np.float64]
States = dict[str, Array]

RESTORATION = SqpSettings(feasibility=1e-9)
TRIES = 20
"""Disturbances of a pose of which the first that can be brought back into contact counts."""
SEED = 20


@dataclass(frozen=True)
class Subject:
    """One hand to examine."""

    number: int
    """Of the candidate or, for a rejected hand, of the call."""
    named: Array
    """(n_d,) design [mm, deg]."""
    states: Mapping[str, Array]
    """State y of each pose: the candidate's own, or its parent's for a rejected hand."""


Prepare = Callable[[Workbench, DesignSpace, Subject], States | None]
"""The states in which a subject is examined; None where one of the poses cannot be had."""


def own_states(bench: Workbench, space: DesignSpace, subject: Subject) -> States | None:
    """A candidate's poses as they are."""
    return dict(subject.states)


def reattempted_states(bench: Workbench, space: DesignSpace, subject: Subject) -> States | None:
    """All poses of a rejected hand, solved from its parent's once more."""
    again = attempt(bench, space.internal(subject.named), dict(subject.states))
    if set(again.poses) != set(bench.spec.poses):
        return None
    return {pose: solved.y for pose, solved in again.poses.items()}


@dataclass(frozen=True)
class Disturbed:
    """Every pose moved by a normal deviate and brought back into contact on the shortest way.

    All constraints of the pose hold, collision and windows among them; its cost plays no part.
    """

    size: float
    """Standard deviation; 1 is 10 mm and 1 rad."""

    def __call__(self, bench: Workbench, space: DesignSpace, subject: Subject) -> States | None:
        states = {}
        for place, (pose, y) in enumerate(subject.states.items()):
            random = np.random.default_rng([SEED, subject.number, place])
            found = self._disturbed(bench, pose, space.internal(subject.named), y, random)
            if found is None:
                return None
            states[pose] = found
        return states

    def _disturbed(
        self, bench: Workbench, pose: str, design: Array, y: Array, random: np.random.Generator
    ) -> Array | None:
        kernels = bench.kernels[pose]
        program = build_pose_program(bench.spec, pose, kernels, design)
        bounds = pose_bounds(bench.spec, pose, kernels.layout)
        for _ in range(TRIES):
            guess = y + self.size * kernels.layout.scale * random.normal(size=len(y))
            reached = restore(program, guess, RESTORATION).y
            if measure(kernels, design, 0.0, reached, bounds).acceptable:
                return reached
        return None


def without_tip_force(bench: Workbench) -> Workbench:
    """A workbench whose paths never end by statics: nothing pulls at the tip.

    It goes round the spec's check, which wants a force, because such a hand is only examined here.
    """
    poses = {
        name: pose.model_copy(update={"tip_force_n": 0.0})
        for name, pose in bench.spec.poses.items()
    }
    return replace(bench, spec=bench.spec.model_copy(update={"poses": poses}))
