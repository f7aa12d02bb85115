"""Poses of new hands from those of a neighbour: solved, judged, and against IPOPT."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from fpcad.model.equilibrium import least_torque
from fpcad.model.kernels import PoseKernels
from fpcad.model.statics import cone_facets
from fpcad.sample.space import DesignSpace
from fpcad.solve.attempt import SolvedPose, Workbench, attempt, held, open_workbench, solve_pose
from fpcad.solve.measure import MARGIN, NORMALS, POSITION_MM, Residual, measure
from fpcad.solve.program import build_pose_program, pose_bounds
from fpcad.solve.sqp import SqpSettings, solve_sqp
from fpcad.spec.schema import Spec
from tests.model.plain_hand import Array, Posture

POSES = ("carve", "poke", "press")
NEIGHBOURS = range(5)
STEP = 0.05


def neighbour(space: DesignSpace, named: Array, seed: int) -> Array:
    """A design one step of the tree away, in the mechanics' units."""
    direction = np.random.default_rng(seed).normal(size=len(named))
    there = space.standardize(named) + STEP * direction / np.linalg.norm(direction)
    return space.internal(space.named(there))


@pytest.fixture(scope="module")
def ipopt(clay: Spec, bench: Workbench, kernel_cache: Path) -> Workbench:
    """Clay with IPOPT in the own solver's place."""
    solver = clay.solver.model_copy(update={"method": "ipopt"})
    return open_workbench(clay.model_copy(update={"solver": solver}), kernel_cache)


def posture(bench: Workbench, pose: str, design: Array, y: Array) -> Posture:
    """A state for plain NumPy."""
    layout = bench.kernels[pose].layout
    fingers = tuple(contact.finger for contact in bench.spec.poses[pose].contacts)
    return Posture(
        fingers, design, 0.0, y[layout.hand], y[layout.joints].reshape(4, 3), y[layout.contacts].reshape(-1, 4)
    )  # fmt: skip


@pytest.mark.parametrize("seed", NEIGHBOURS)
@pytest.mark.parametrize("pose", POSES)
def test_neighbours_are_reached_within_tolerance(
    bench: Workbench, clay_space: DesignSpace, first_hand, pose: str, seed: int
):
    design = neighbour(clay_space, first_hand.named, seed)
    solved = solve_pose(bench, pose, design, first_hand.states[pose])
    assert solved is not None and solved.residual.acceptable
    at = posture(bench, pose, design, solved.y)
    for i in range(len(at.fingers)):
        tool, finger = at.tool(i), at.finger(i)
        assert np.linalg.norm(tool.p - finger.p) <= POSITION_MM
        assert np.linalg.norm(tool.normal + finger.normal) <= NORMALS
    lower, upper = pose_bounds(bench.spec, pose, bench.kernels[pose].layout)
    assert (solved.y - lower).min() >= MARGIN and (upper - solved.y).min() >= MARGIN
    assert bench.kernels[pose].residual(design, 0.0, solved.y)[3].min() >= MARGIN


def alike(cost: float, reference: float) -> bool:
    """Equal within one percent or 1e-4."""
    return abs(cost - reference) <= max(1e-4, 0.01 * reference)


@pytest.mark.parametrize("pose", POSES)
def test_minima_of_ipopt_are_minima_of_the_own_solver_too(
    bench: Workbench, ipopt: Workbench, clay_space: DesignSpace, first_hand, pose: str
):
    """Started where IPOPT ends, the own solver neither leaves nor finds anything better."""
    compared = 0
    for seed in NEIGHBOURS:
        design = neighbour(clay_space, first_hand.named, seed)
        theirs = solve_pose(ipopt, pose, design, first_hand.states[pose])
        if theirs is not None:
            ours = solve_pose(bench, pose, design, theirs.y)
            assert ours is not None and alike(ours.cost, theirs.cost)
            compared += 1
    assert compared >= 3


@pytest.mark.parametrize("pose", ["carve", "press"])
def test_cost_from_the_same_start_is_mostly_that_of_ipopt(
    bench: Workbench, ipopt: Workbench, clay_space: DesignSpace, first_hand, pose: str
):
    """The programs have several minima, centimetres apart, and IPOPT's first steps stray far; when
    poking they always end in another one, so that pose is not in this comparison. One neighbour may
    end in another one, and one more IPOPT may not solve at all."""
    same = []
    for seed in NEIGHBOURS:
        design = neighbour(clay_space, first_hand.named, seed)
        ours, theirs = (
            solve_pose(at, pose, design, first_hand.states[pose]) for at in (bench, ipopt)
        )
        assert ours is not None
        same += [alike(ours.cost, theirs.cost)] if theirs is not None else []
    assert len(same) >= len(NEIGHBOURS) - 1
    assert sum(same) >= len(same) - 1


@pytest.mark.parametrize("pose", POSES)
def test_a_minimum_is_one_to_first_order(
    bench: Workbench, clay_space: DesignSpace, first_hand, pose: str
):
    """Solved much more sharply, the cost hardly falls any further."""
    design = neighbour(clay_space, first_hand.named, 1)
    ours = solve_pose(bench, pose, design, first_hand.states[pose])
    assert ours is not None
    program = build_pose_program(bench.spec, pose, bench.kernels[pose], design)
    sharp = solve_sqp(program, ours.y, SqpSettings(1000, progress=1e-12, min_trust=1e-10))
    assert 0 <= ours.cost - sharp.cost <= 1e-4


def test_a_pose_solved_again_stays(bench: Workbench, first_hand):
    for pose, y in first_hand.states.items():
        again = solve_pose(bench, pose, first_hand.design, y)
        assert again is not None
        assert np.abs((again.y - y) / bench.kernels[pose].layout.scale).max() < 0.05


def test_attempts_are_reproducible_to_the_last_bit(
    bench: Workbench, clay_space: DesignSpace, first_hand
):
    design = neighbour(clay_space, first_hand.named, 0)
    one, two = (attempt(bench, design, first_hand.states) for _ in range(2))
    assert one.succeeded
    for pose in POSES:
        assert np.array_equal(one.poses[pose].y, two.poses[pose].y)


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("which", ["sqp", "ipopt"])
def test_a_hopeless_hand_has_no_pose(
    bench: Workbench, ipopt: Workbench, first_hand, pose: str, which: str
):
    """Thumb and fingers a metre apart never meet at a stick of 12 mm."""
    design = first_hand.design.copy()
    design[1] = 1000.0
    at = {"sqp": bench, "ipopt": ipopt}[which]
    assert solve_pose(at, pose, design, first_hand.states[pose]) is None


def outcome(bench: Workbench, design: Array, states: dict[str, Array]) -> str:
    return attempt(bench, design, states).reason


def test_the_first_failure_is_the_reason(bench: Workbench, first_hand):
    overlapping, apart = first_hand.design.copy(), first_hand.design.copy()
    overlapping[2], apart[1] = 10.0, 1000.0
    assert outcome(bench, overlapping, first_hand.states) == "geometry"
    assert outcome(bench, apart, first_hand.states) == "carve: solve"
    weak = bench.spec.statics.model_copy(update={"max_joint_torque_nmm": 1.0})
    powerless = replace(bench, spec=bench.spec.model_copy(update={"statics": weak}))
    assert outcome(powerless, first_hand.design, first_hand.states) == "carve: statics"
    assert outcome(bench, first_hand.design, first_hand.states) == ""


@pytest.mark.parametrize("pose", POSES)
def test_a_pose_must_hold_against_both_turning_directions(bench: Workbench, first_hand, pose: str):
    """One direction needs more torque than the other: a cap in between refuses the pose."""
    y, spec = first_hand.states[pose], bench.spec
    values = bench.kernels[pose].statics(first_hand.design, y[:6], 0.0, y[6:])
    wrench, torque, tip = (value.copy() for value in values)
    needed = []
    for sign in (1.0, -1.0):
        load = sign * spec.poses[pose].tip_force_n * tip
        holding = least_torque(wrench, torque, load, 1e5, cone_facets(spec.statics))
        assert holding is not None
        needed.append(holding.largest_torque_nmm)

    def is_held(cap: float) -> bool:
        statics = spec.statics.model_copy(update={"max_joint_torque_nmm": cap})
        capped = replace(bench, spec=spec.model_copy(update={"statics": statics}))
        return held(capped, pose, first_hand.design, y)

    assert max(needed) > 1.01 * min(needed)
    assert is_held(1.001 * max(needed))
    assert not is_held(0.999 * max(needed))


class TestMeasure:
    """What a state is judged by does not come from a solver."""

    def judged(self, bench: Workbench, solved: SolvedPose, design: Array, change: dict[int, float]):
        kernels, y = bench.kernels["carve"], solved.y.copy()
        for place, by in change.items():
            y[place] += by
        return measure(kernels, design, 0.0, y, pose_bounds(bench.spec, "carve", kernels.layout))

    def test_solved_poses_pass(self, bench: Workbench, first_hand):
        solved = first_hand.attempt.poses["carve"]
        assert self.judged(bench, solved, first_hand.design, {}) == solved.residual
        assert solved.residual.acceptable

    def test_a_hand_two_micrometres_off_does_not(self, bench: Workbench, first_hand):
        found = self.judged(bench, first_hand.attempt.poses["carve"], first_hand.design, {0: 2e-3})
        assert found.position_mm == pytest.approx(2e-3)
        assert not found.acceptable

    def test_a_contact_turned_about_the_tool_does_not(self, bench: Workbench, first_hand):
        found = self.judged(bench, first_hand.attempt.poses["carve"], first_hand.design, {19: 1e-6})
        assert found.position_mm == pytest.approx(6e-6, rel=1e-3)
        assert found.normals == pytest.approx(1e-6, rel=1e-3)
        assert not found.acceptable

    @pytest.mark.parametrize("turns", [1, -1])
    def test_a_state_out_of_bounds_does_not(self, bench: Workbench, first_hand, turns: int):
        """Contact 0 a turn further about the tool is the same point, but outside its window."""
        turn = {19: turns * 2 * np.pi}
        found = self.judged(bench, first_hand.attempt.poses["carve"], first_hand.design, turn)
        assert found.position_mm < 1e-9 and found.bounds < -1
        assert not found.acceptable

    @pytest.mark.parametrize("short", ["opposition", "skin", "clearance"])
    def test_every_margin_counts(self, short: str):
        """A state is as good as its least margin, of whichever kind."""

        def judged(least: float) -> Residual:
            margins = {name: np.ones(3) for name in ("opposition", "skin", "clearance")}
            margins[short][1] = least
            kernels = SimpleNamespace(residual=lambda *_: (np.zeros(6), *margins.values()))
            bounds = -np.ones(4), np.ones(4)
            return measure(cast(PoseKernels, kernels), np.zeros(6), 0.0, np.zeros(4), bounds)

        assert judged(-1e-7).acceptable and judged(-1e-7).clearance_mm == -1e-7
        assert not judged(-1e-5).acceptable
