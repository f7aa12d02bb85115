"""Equilibrium programs against SciPy's HiGHS, and against each other."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog

from fpcad.model.equilibrium import greatest_load, least_torque
from fpcad.model.statics import cone_edges, cone_facets
from fpcad.solve.attempt import Workbench
from fpcad.spec.process import Statics
from fpcad.wield.evaluate import build_load, evaluate
from tests.model.plain_hand import Array
from tests.model.postures import random_posture

POSES = ("carve", "poke", "press")
STATICS = Statics()
FACETS, EDGES = cone_facets(STATICS), cone_edges(STATICS)
CAP_NMM = 10_000.0
FORCE_N = 10.0
UNITS = np.array([1.0, 1, 1, 0.1, 0.1, 0.1])  # moments in 10 N mm

Program = tuple[Array, Array, Array]
"""Wrenches (6, 3n) and joint torques (n_u, 3n) of unit contact forces, unit load (6,)."""


def programs_along(bench: Workbench, first_hand, pose: str, count: int = 40) -> list[Program]:
    """Held states of the first hand's path, evenly taken, with the pull of its direction."""
    path = evaluate(bench, first_hand.design, {pose: first_hand.states[pose]}).paths[pose]
    found = []
    for place in np.linspace(0, len(path.tool_angle_rad) - 1, count).astype(int):
        turn = path.tool_angle_rad[place]
        x = np.concatenate([path.joints_rad[place].ravel(), path.contacts[place].ravel()])
        values = bench.kernels[pose].statics(first_hand.design, path.hand_in_tool, turn, x)
        wrench, torque, tip = (value.copy() for value in values)
        found.append((wrench, torque, tip if turn >= 0 else -tip))
    return found


def random_programs(bench: Workbench, pose: str, count: int = 40) -> list[Program]:
    """Postures that need not touch: their forces still have wrenches and torques."""
    found = []
    for seed in range(count):
        at = random_posture(bench.spec, pose, seed)
        wrench, torque, tip = (
            v.copy() for v in bench.kernels[pose].statics(at.d, at.h, at.turn, at.x)
        )
        found.append((wrench, torque, tip))
    return found


def along_edges(program: Program) -> Program:
    """The same with forces >= 0 along the friction pyramids' edges."""
    wrench, torque, load = program
    edges = np.kron(np.eye(wrench.shape[1] // 3), EDGES)
    return wrench @ edges, torque @ edges, load


def highs_torque(program: Program) -> float | None:
    """Least largest torque [N mm] against FORCE_N, by HiGHS along the cones' edges; torques in N m."""
    wrench, torque, load = along_edges(program)
    joints, edges = torque.shape
    column = np.ones((joints, 1))
    found = linprog(
        np.append(np.zeros(edges), 1.0),
        A_ub=np.block([[torque / 1e3, -column], [-torque / 1e3, -column]]),
        b_ub=np.zeros(2 * joints),
        A_eq=np.hstack([UNITS[:, None] * wrench, np.zeros((6, 1))]),
        b_eq=-FORCE_N * UNITS * load,
        bounds=[(0, None)] * edges + [(0, CAP_NMM / 1e3)],
    )
    return float(found.x[-1] * 1e3) if found.status == 0 else None


def highs_load(program: Program, limit: Array) -> float:
    """Greatest load [N] within torque limits (n,) [N mm], by HiGHS along the cones' edges."""
    wrench, torque, load = along_edges(program)
    found = linprog(
        np.append(np.zeros(torque.shape[1]), -1.0),
        A_ub=np.hstack([np.vstack([torque, -torque]), np.zeros((2 * len(torque), 1))]) / 1e3,
        b_ub=np.concatenate([limit, limit]) / 1e3,
        A_eq=UNITS[:, None] * np.hstack([wrench, load[:, None]]),
        b_eq=np.zeros(6),
    )
    assert found.status == 0
    return float(found.x[-1])


@pytest.mark.parametrize("pose", POSES)
class TestAlongPaths:
    def test_least_torque_is_that_of_highs(self, bench: Workbench, first_hand, pose: str):
        for wrench, torque, load in programs_along(bench, first_hand, pose):
            ours = least_torque(wrench, torque, FORCE_N * load, CAP_NMM, FACETS)
            assert ours is not None
            theirs = highs_torque((wrench, torque, load))
            assert ours.largest_torque_nmm == pytest.approx(theirs, rel=1e-9)

    def test_greatest_load_is_that_of_highs(self, bench: Workbench, first_hand, pose: str):
        motors = build_load(bench.spec, pose)
        for wrench, torque, load in programs_along(bench, first_hand, pose):
            by_motors = motors.motor_per_joint_torque @ torque
            ours = greatest_load(wrench, by_motors, load, motors.motor_torque_nmm, FACETS)
            theirs = highs_load((wrench, by_motors, load), motors.motor_torque_nmm)
            assert ours == pytest.approx(theirs, rel=1e-9)

    def test_forces_balance_the_load(self, bench: Workbench, first_hand, pose: str):
        for wrench, torque, load in programs_along(bench, first_hand, pose):
            held = least_torque(wrench, torque, FORCE_N * load, CAP_NMM, FACETS)
            assert held is not None
            normal, *friction = held.forces_n.reshape(-1, 3).T
            assert (np.hypot(*friction) <= normal + 1e-9).all()
            assert np.abs(wrench @ held.forces_n + FORCE_N * load).max() < 1e-6
            assert np.allclose(torque @ held.forces_n, held.torque_nmm)
            assert np.abs(held.torque_nmm).max() == pytest.approx(held.largest_torque_nmm)

    def test_what_the_least_torque_holds_is_all_that_it_holds(
        self, bench: Workbench, first_hand, pose: str
    ):
        """With each joint limited to the least torque for F, the greatest load is F."""
        for wrench, torque, load in programs_along(bench, first_hand, pose):
            held = least_torque(wrench, torque, FORCE_N * load, CAP_NMM, FACETS)
            assert held is not None
            limit = np.full(len(torque), held.largest_torque_nmm)
            assert greatest_load(wrench, torque, load, limit, FACETS) == pytest.approx(
                FORCE_N, rel=1e-9
            )


@pytest.mark.parametrize("pose", POSES)
def test_highs_agrees_on_what_cannot_be_held(bench: Workbench, pose: str):
    programs = random_programs(bench, pose)
    ours = [least_torque(w, t, FORCE_N * load, CAP_NMM, FACETS) for w, t, load in programs]
    theirs = [highs_torque(program) for program in programs]
    for held, torque in zip(ours, theirs, strict=True):
        assert (held is None) == (torque is None)
        if held is not None:
            assert held.largest_torque_nmm == pytest.approx(torque, rel=1e-9)


def test_random_postures_are_of_both_kinds(bench: Workbench):
    programs = [program for pose in POSES for program in random_programs(bench, pose)]
    held = [
        least_torque(w, t, FORCE_N * load, CAP_NMM, FACETS) is not None for w, t, load in programs
    ]
    assert 10 < sum(held) < len(held) - 10


def test_twice_the_load_needs_twice_the_torque(bench: Workbench, first_hand):
    for wrench, torque, load in programs_along(bench, first_hand, "carve", 5):
        one, two = (least_torque(wrench, torque, f * load, 1e6, FACETS) for f in (1.0, 2.0))
        assert one is not None and two is not None
        assert two.largest_torque_nmm == pytest.approx(2 * one.largest_torque_nmm)
