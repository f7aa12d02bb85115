"""Every Jacobian that a kernel hands out is the slope of the values that it hands out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from fpcad.solve.attempt import Workbench
from tests.model.plain_hand import FINGERS, Array, Posture
from tests.model.postures import random_posture

POSES = ("carve", "poke", "press")
SEEDS = range(4)
STEP = 1e-5


def jacobian(of: Callable[[Array], Array], at: Array) -> Array:
    """Central differences (n_out, n_in)."""
    steps = STEP * np.eye(len(at))
    return np.stack([(of(at + step) - of(at - step)) / (2 * STEP) for step in steps], axis=1)


def assert_close(promised: Array, measured: Array) -> None:
    """Equal up to the rounding of central differences, relative to the largest entry."""
    assert promised.shape == measured.shape
    assert np.abs(promised - measured).max() <= 1e-7 * max(1.0, float(np.abs(measured).max()))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pose", POSES)
class TestSlopes:
    def test_of_cost_rows_and_margins(self, bench: Workbench, pose: str, seed: int):
        """In the state and, in the last column, in the tool's angle."""
        at, kernel = random_posture(bench.spec, pose, seed), bench.kernels[pose].constraints
        promised = [value.copy() for value in kernel(at.d, at.turn, at.y)[1::2]]
        for place, matrix in zip((0, 2, 4), promised, strict=True):

            def value(y_turn: Array, k: int = place) -> Array:
                return kernel(at.d, y_turn[-1], y_turn[:-1])[k].copy()

            assert_close(matrix, jacobian(value, np.append(at.y, at.turn)))

    def test_of_the_points_that_slide(self, bench: Workbench, pose: str, seed: int):
        """Sliding and approach are the relative velocity of both material points, in the tool's
        tangents and along its normal; the points come from the plain kinematics."""
        at = random_posture(bench.spec, pose, seed)
        S, s0, N, n0, *_ = bench.kernels[pose].rates(at.d, at.h, at.turn, at.x)
        u_rate = np.random.default_rng(seed).normal(size=(4, 3))
        sliding = (S @ u_rate.ravel() + s0).reshape(-1, 2)
        approach = N @ u_rate.ravel() + n0

        def after(time: float) -> Posture:
            return at._replace(turn=at.turn + time, u=at.u + time * u_rate)

        for i in range(len(at.fingers)):
            ahead, behind = after(STEP), after(-STEP)
            finger = (ahead.finger(i).p - behind.finger(i).p) / (2 * STEP)
            tool = (ahead.tool(i).p - behind.tool(i).p) / (2 * STEP)
            frame = at.tool(i)
            assert np.allclose(frame.tangents.T @ (finger - tool), sliding[i], atol=1e-6)
            assert frame.normal @ (finger - tool) == pytest.approx(approach[i], abs=1e-6)

    def test_of_the_points_that_push(self, bench: Workbench, pose: str, seed: int):
        """tau = J' f with the Jacobian of the finger's material point."""
        at = random_posture(bench.spec, pose, seed)
        wrench, torque, _ = bench.kernels[pose].statics(at.d, at.h, at.turn, at.x)
        for i, name in enumerate(at.fingers):
            own = FINGERS.index(name)

            def point(u: Array, i: int = i, own: int = own) -> Array:
                joints = at.u.copy()
                joints[own] = u
                return at._replace(u=joints).finger(i).p

            own_axes = slice(3 * i, 3 * i + 3)
            expected = np.zeros((12, 3))
            expected[3 * own : 3 * own + 3] = jacobian(point, at.u[own]).T @ wrench[:3, own_axes]
            assert np.allclose(torque[:, own_axes], expected, atol=1e-6)


@pytest.mark.parametrize("pose", POSES)
def test_margins_are_what_a_state_is_judged_by(bench: Workbench, pose: str):
    """Opposition and skin alike; squared distances vanish and change sign with the gaps."""
    at, kernels = random_posture(bench.spec, pose, 1), bench.kernels[pose]
    margins = kernels.constraints(at.d, at.turn, at.y)[4]
    _, opposition, skin, clearances = kernels.residual(at.d, at.turn, at.y)
    n = 3 * len(at.fingers)
    assert np.allclose(margins[:n], np.concatenate([10 * opposition, skin]))
    assert np.array_equal(np.sign(margins[n:]), np.sign(clearances))
