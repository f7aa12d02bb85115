"""A first hand is found where the spec gives none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.errors import SolveError
from fpcad.sample.search import FirstHand, search_start
from fpcad.sample.space import DesignSpace, design_space
from fpcad.solve.attempt import Workbench, held
from fpcad.spec.schema import Spec
from fpcad.workers import InProcess
from tests.model.plain_hand import Array


def without_initial(clay: Spec, *poses: str, **solver: int) -> Spec:
    """Clay with some of its poses and no known hand."""
    return clay.model_copy(
        update={
            "initial": None,
            "poses": {pose: clay.poses[pose] for pose in poses},
            "solver": clay.solver.model_copy(update={"starts": 48, "start_designs": 3, **solver}),
        }
    )


def least_joint_use(_: Workbench, __: str, ___: Array, y: Array) -> float:
    """A quick merit: small joint angles."""
    return -float(np.abs(y[6:18]).sum())


def search(bench: Workbench, spec: Spec, space: DesignSpace | None = None) -> FirstHand:
    at = replace(bench, spec=spec)
    space = space or design_space(spec.hand)
    return search_start(InProcess(lambda: at), space, spec, least_joint_use, lambda *_: None)


@pytest.fixture(scope="module")
def found(bench: Workbench, clay: Spec) -> FirstHand:
    return search(bench, without_initial(clay, "carve", "press"))


def test_all_poses_are_solved_and_held(bench: Workbench, found: FirstHand):
    assert found.attempt.succeeded and set(found.attempt.poses) == {"carve", "press"}
    for pose, solved in found.attempt.poses.items():
        assert solved.residual.acceptable
        assert held(bench, pose, found.attempt.design, solved.y)


def test_the_middle_of_the_box_comes_first(clay_space: DesignSpace, found: FirstHand):
    assert np.allclose(found.named, (clay_space.lower + clay_space.upper) / 2)
    assert np.array_equal(found.attempt.design, clay_space.internal(found.named))


def test_starts_are_counted(found: FirstHand):
    assert 2 * 16 <= found.starts <= 2 * 48


def test_the_same_seed_finds_the_same_hand(bench: Workbench, clay: Spec, found: FirstHand):
    again = search(bench, without_initial(clay, "carve", "press"))
    assert again.starts == found.starts
    for pose, solved in found.attempt.poses.items():
        assert np.array_equal(again.attempt.poses[pose].y, solved.y)


def test_the_judge_decides(bench: Workbench, clay: Spec):
    """With the merit reversed another solution of the same starts is taken."""
    spec = without_initial(clay, "press", starts=32)
    at = replace(bench, spec=spec)

    def most_joint_use(*arguments) -> float:
        return -least_joint_use(*arguments)

    least, most = (
        search_start(InProcess(lambda: at), design_space(spec.hand), spec, judge, lambda *_: None)
        for judge in (least_joint_use, most_joint_use)
    )
    use = [np.abs(hand.attempt.poses["press"].y[6:18]).sum() for hand in (least, most)]
    assert use[0] < use[1]


def test_a_hopeless_space_is_told(bench: Workbench, clay: Spec):
    """Palms a metre long: every design fails at its first pose, after as many starts as allowed."""
    space = design_space(clay.hand)
    lower, upper = space.lower.copy(), space.upper.copy()
    lower[1], upper[1] = 1000.0, 1100.0
    spec = without_initial(clay, "press", starts=4, start_designs=2)
    with pytest.raises(
        SolveError, match=r"8 starts over 2 designs, the last of which failed at `press`"
    ):
        search(bench, spec, DesignSpace(space.names, lower, upper))


def test_progress_is_told(bench: Workbench, clay: Spec):
    told: list[tuple[int, str]] = []
    spec = without_initial(clay, "press")
    at, space = replace(bench, spec=spec), design_space(spec.hand)
    hand = search_start(
        InProcess(lambda: at), space, spec, least_joint_use, lambda *step: told.append(step)
    )
    assert told == [(0, "design 1, press"), (hand.starts, "")]
