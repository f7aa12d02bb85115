"""Integration is of order four on smooth stretches, and projection brings states into contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.solve.qp import QpSolution, QuadraticProgram, solve_daqp
from fpcad.wield.integrate import Step, advance, project
from fpcad.wield.rates import End, Mechanism
from tests.model.plain_hand import Array
from tests.wield.wielding import Wielding

POSES = ("carve", "poke", "press")
STRETCH = 0.2
"""The first turn [rad] of pressing on the minus side: no limit acts, and all contacts but one
stay on their fingertips, that one on the same side of the seam."""


def integrated(m: Mechanism, x: Array, steps: int, project_after: bool = False) -> Array:
    """State after STRETCH in equal steps."""
    dt = STRETCH / steps
    for k in range(steps):
        step = advance(m, -k * dt, x, -1.0, dt, project_after)
        assert isinstance(step, Step)
        x = step.x
    return x


def scaled(m: Mechanism, difference: Array) -> float:
    """Largest difference, 10 mm counted as 1 rad."""
    return float(np.abs(difference / m.kernels.layout.scale[6:]).max())


def gap(m: Mechanism, turn: float, x: Array) -> float:
    """Largest residual of the contact equations [mm, -]."""
    return float(np.abs(m.kernels.residual(m.design, turn, np.concatenate([m.hand, x]))[0]).max())


@pytest.fixture(scope="module")
def press(wielding: dict[str, Wielding]) -> tuple[Mechanism, Array]:
    return wielding["press"].mechanism, wielding["press"].pose[6:]


def test_the_error_shrinks_with_the_fourth_power_of_the_step(press: tuple[Mechanism, Array]):
    m, x = press
    exact = integrated(m, x, 128)
    errors = [scaled(m, integrated(m, x, steps) - exact) for steps in (2, 4, 8, 16)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.min() >= 3.5
    assert errors[-1] < 1e-6


def test_nothing_acts_on_that_stretch(press: tuple[Mechanism, Array]):
    """What the order is measured on is smooth: no inequality is active and no seam is crossed."""
    m, x = press
    seen: list[tuple[QuadraticProgram, QpSolution]] = []

    def watched(program: QuadraticProgram) -> QpSolution | None:
        solution = solve_daqp(program)
        assert solution is not None
        seen.append((program, solution))
        return solution

    sides = []
    for k in range(8):
        step = advance(replace(m, qp=watched), -k * STRETCH / 8, x, -1.0, STRETCH / 8, False)
        assert isinstance(step, Step)
        x = step.x
        sides.append(np.sign(x[14::4] - (m.design[0] - m.design[3] / 2)))
    assert (np.array(sides) == sides[0]).all()
    for program, solution in seen:
        rows = program.A @ solution.x
        n = len(m.kernels.rates(m.design, m.hand, 0.0, x)[2])  # equations come first
        assert (solution.x > program.lower).all() and (solution.x < program.upper).all()
        assert (rows[n:] > program.row_lower[n:]).all() and (rows[n:] < program.row_upper[n:]).all()


def test_drift_off_contact_shrinks_with_the_step(press: tuple[Mechanism, Array]):
    m, x = press
    drifts = [gap(m, -STRETCH, integrated(m, x, steps)) for steps in (2, 4, 8)]
    assert drifts[0] > 8 * drifts[1] > 64 * drifts[2] > 0


def test_projection_ends_the_drift(press: tuple[Mechanism, Array]):
    m, x = press
    assert gap(m, -STRETCH, integrated(m, x, 2)) > 1e-6
    assert gap(m, -STRETCH, integrated(m, x, 2, project_after=True)) < 1e-9


def test_steps_of_both_directions_undo_each_other(press: tuple[Mechanism, Array]):
    """Without limits the motion is an ordinary differential equation, which can be run back."""
    m, x = press
    there = advance(m, 0.0, x, -1.0, 0.02)
    assert isinstance(there, Step)
    back = advance(m, -0.02, there.x, 1.0, 0.02)
    assert isinstance(back, Step)
    assert scaled(m, back.x - x) < 1e-5


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("pose", POSES)
class TestProjection:
    def disturbed(self, wielding, pose: str, seed: int) -> tuple[Mechanism, float, Array]:
        """A state of a path with noise: about 0.03 mm and 3 mrad."""
        states = wielding[pose].traces[1.0].states
        state, m = states[len(states) // 2], wielding[pose].mechanism
        noise = np.random.default_rng(seed).normal(size=len(state.x)) * m.kernels.layout.scale[6:]
        return m, state.turn, np.clip(state.x + 3e-3 * noise, *m.bounds)

    def test_ends_in_contact_and_inside_the_bounds(self, wielding, pose: str, seed: int):
        m, turn, guess = self.disturbed(wielding, pose, seed)
        x = project(m, turn, guess)
        assert x is not None
        assert gap(m, turn, guess) > 1e-3 and gap(m, turn, x) < 1e-9
        assert (x >= m.bounds[0]).all() and (x <= m.bounds[1]).all()
        assert m.kernels.residual(m.design, turn, np.concatenate([m.hand, x]))[3].min() > -1e-9

    def test_is_repeatable(self, wielding, pose: str, seed: int):
        m, turn, guess = self.disturbed(wielding, pose, seed)
        x = project(m, turn, guess)
        assert x is not None
        again = project(m, turn, x)
        assert again is not None and np.array_equal(again, x)

    def test_moves_hardly_further_than_the_noise(self, wielding, pose: str, seed: int):
        """The undisturbed state is in contact too, so the nearest one is no further away."""
        m, turn, guess = self.disturbed(wielding, pose, seed)
        x = project(m, turn, guess)
        assert x is not None
        states = wielding[pose].traces[1.0].states
        scale = m.kernels.layout.scale[6:]
        noise = np.linalg.norm((guess - states[len(states) // 2].x) / scale)
        assert np.linalg.norm((x - guess) / scale) <= noise * 1.2


def test_the_correction_is_the_shortest(press: tuple[Mechanism, Array]):
    """Where no limit acts it is normal to the set of contacts, in scaled variables."""
    m, x = press
    scale = m.kernels.layout.scale[6:]
    guess = x + 1e-4 * scale * np.random.default_rng(0).normal(size=len(x))
    found = project(m, 0.0, guess)
    assert found is not None
    correction = (found - guess) / scale
    J = m.kernels.constraints(m.design, 0.0, np.concatenate([m.hand, found]))[3][:, 6:-1] * scale
    along = correction - J.T @ np.linalg.lstsq(J.T, correction, rcond=None)[0]
    assert np.linalg.norm(along) < 1e-3 * np.linalg.norm(correction)


def test_out_of_reach_is_none(press: tuple[Mechanism, Array]):
    """A tool turned by half a turn is not the next state of this one."""
    m, x = press
    assert project(m, np.pi, x) is None


def test_a_step_that_cannot_be_projected_says_so(press: tuple[Mechanism, Array]):
    """A hand half a metre off still has rates, but no contact."""
    m, x = press
    away = replace(m, hand=m.hand + np.array([0, 0, -500.0, 0, 0, 0]))
    assert advance(away, 0.0, x, 1.0, 1e-3) is End.PROJECTION
