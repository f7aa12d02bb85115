"""The rate program: contact is kept, limits are looked ahead to, and sliding is least."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.solve.attempt import Workbench
from fpcad.solve.program import path_bounds
from fpcad.solve.qp import BACKENDS, QpSolution, QuadraticProgram, solve_daqp
from fpcad.wield.rates import End, Mechanism, Rates, solve_rates
from tests.model.plain_hand import Array
from tests.model.postures import touching_posture
from tests.wield.wielding import Wielding

POSES = ("carve", "poke", "press")
DIRECTIONS = (-1.0, 1.0)
DT = np.radians(1)


def states(wielding: Wielding, direction: float, count: int = 8) -> list[tuple[float, Array]]:
    """Tool angles and states along one direction, the pose first, the end left out."""
    inner = wielding.traces[direction].states[:-2]
    places = np.unique(np.linspace(0, len(inner) - 1, count).astype(int))
    return [(inner[place].turn, inner[place].x) for place in places]


def to_seam(m: Mechanism, x: Array) -> float:
    """Least distance [mm] of a contact to the end of its finger's cylinder, where rates jump."""
    return float(np.abs(x[14::4] - (m.design[0] - m.design[3] / 2)).min())


def rates_at(m: Mechanism, turn: float, x: Array, direction: float) -> Rates:
    rates = solve_rates(m, turn, x, direction, DT)
    assert isinstance(rates, Rates)
    return rates


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("pose", POSES)
class TestAlongPaths:
    def test_no_contact_is_lifted_or_pressed(self, wielding, pose: str, direction: float):
        """E_z v = 0 at every contact."""
        m = wielding[pose].mechanism
        for turn, x in states(wielding[pose], direction):
            rates = rates_at(m, turn, x, direction)
            _, _, N, n0, *_ = m.kernels.rates(m.design, m.hand, turn, x)
            assert np.abs(N @ rates.x[:12] + direction * n0).max() < 1e-8

    def test_contact_is_kept_to_first_order(self, wielding, pose: str, direction: float):
        """All five rows of every contact stay zero: what is left shrinks like the time squared."""
        m = wielding[pose].mechanism
        for turn, x in states(wielding[pose], direction):
            if to_seam(m, x) < 1e-2:
                continue
            rates, left = rates_at(m, turn, x, direction), []
            for time in (2e-4, 1e-4):
                y = wielding[pose].y(x + time * rates.x)
                rows = m.kernels.constraints(m.design, turn + direction * time, y)[2]
                left.append(np.abs(rows).max())
            assert left[1] < max(0.3 * left[0], 1e-8)

    def test_sliding_is_the_tangential_velocity(self, wielding, pose: str, direction: float):
        m = wielding[pose].mechanism
        for turn, x in states(wielding[pose], direction):
            rates = rates_at(m, turn, x, direction)
            S, s0, *_ = m.kernels.rates(m.design, m.hand, turn, x)
            velocity = (S @ rates.x[:12] + direction * s0).reshape(-1, 2)
            assert np.allclose(rates.sliding, np.hypot(*velocity.T))

    def test_one_step_of_euler_stays_inside_the_bounds(self, wielding, pose: str, direction: float):
        m = wielding[pose].mechanism
        for turn, x in states(wielding[pose], direction):
            ahead = x + DT * rates_at(m, turn, x, direction).x
            assert (ahead >= m.bounds[0] - 1e-8).all() and (ahead <= m.bounds[1] + 1e-8).all()

    def test_a_bound_halfway_ahead_is_respected(self, wielding, pose: str, direction: float):
        """Every coordinate in turn gets a bound that it would pass within the step."""
        m = wielding[pose].mechanism
        turn, x = states(wielding[pose], direction)[2]
        free, respected = rates_at(m, turn, x, direction).x, 0
        for k in np.flatnonzero((np.abs(free) > 1e-3) & np.isfinite(m.bounds[0])):
            low, high = m.bounds[0].copy(), m.bounds[1].copy()
            (high if free[k] > 0 else low)[k] = x[k] + DT * free[k] / 2
            rates = solve_rates(replace(m, bounds=(low, high)), turn, x, direction, DT)
            if isinstance(rates, Rates):
                ahead = x[k] + DT * rates.x[k]
                assert low[k] - 1e-9 <= ahead <= high[k] + 1e-9
                respected += 1
        assert respected >= 8

    def test_no_joint_is_faster_than_allowed(self, wielding, pose: str, direction: float):
        m = replace(wielding[pose].mechanism, max_joint_rate=1.5)
        for turn, x in states(wielding[pose], direction, 3):
            rates = solve_rates(m, turn, x, direction, DT)
            if isinstance(rates, Rates):
                assert np.abs(rates.x[:12]).max() <= 1.5 + 1e-9

    def test_backends_agree(self, wielding, pose: str, direction: float):
        m = wielding[pose].mechanism
        for turn, x in states(wielding[pose], direction, 6):
            ours, theirs = (
                rates_at(replace(m, qp=BACKENDS[name]), turn, x, direction)
                for name in ("daqp", "osqp")
            )
            assert np.abs(ours.x[:12] - theirs.x[:12]).max() < 1e-5

    def test_no_other_motion_slides_less(self, wielding, pose: str, direction: float):
        """The program's optimum against random motions that its constraints allow."""
        seen: list[QuadraticProgram] = []

        def watched(program: QuadraticProgram) -> QpSolution | None:
            seen.append(program)
            return solve_daqp(program)

        m, random = replace(wielding[pose].mechanism, qp=watched), np.random.default_rng(0)
        for turn, x in states(wielding[pose], direction, 4):
            best = rates_at(m, turn, x, direction).x[:12]
            program = seen[-1]

            def cost(u: Array, p: QuadraticProgram = program) -> float:
                return float(u @ p.H @ u / 2 + p.f @ u)

            n = len(m.kernels.rates(m.design, m.hand, turn, x)[2])
            null = np.linalg.svd(program.A[:n])[2][n:]
            for size in (1.0, 1e-2, 1e-4):
                for offset in random.normal(size=(50, len(null))) @ null * size:
                    u = np.clip(best + offset, program.lower, program.upper)
                    rows = program.A @ u
                    inside = (rows >= program.row_lower - 1e-9) & (rows <= program.row_upper + 1e-9)
                    if inside.all():
                        assert cost(u) >= cost(best) - 1e-9


def test_fingers_without_contact_keep_still_unless_something_is_in_their_way(wielding):
    """The ring finger of carve touches nothing."""
    m = wielding["carve"].mechanism
    turn, x = states(wielding["carve"], 1.0)[3]
    assert np.abs(rates_at(m, turn, x, 1.0).x[9:12]).max() < 1e-6


def test_contradicting_limits_end_the_path(wielding):
    """A joint that would have to be elsewhere at once cannot."""
    m = wielding["press"].mechanism
    assert (
        solve_rates(replace(m, max_joint_rate=1e-3), 0.0, wielding["press"].pose[6:], 1.0, DT)
        == End.RATES
    )


@pytest.mark.parametrize("spin", [0.0, 2e-3])
def test_parallel_cylinders_have_no_contact_rates(bench: Workbench, first_hand, spin: float):
    """Two cylinders side by side touch along a line."""
    at = touching_posture(bench.spec, "carve", 0, -10.0, 0, spin)
    bounds = path_bounds(bench.spec, "carve", bench.kernels["carve"].layout)
    m = Mechanism(bench.kernels["carve"], bounds, at.d, at.h, 1.0, 100.0, solve_daqp)
    assert solve_rates(m, at.turn, at.x, 1.0, DT) == End.SINGULAR


@pytest.mark.parametrize("spin", [0.02, 0.5])
def test_crossed_cylinders_have_contact_rates(bench: Workbench, spin: float):
    at = touching_posture(bench.spec, "carve", 0, -10.0, 0, spin)
    determinants = bench.kernels["carve"].rates(at.d, at.h, at.turn, at.x)[-1]
    assert determinants[0] == pytest.approx(np.sin(spin) ** 2, rel=1e-9)
