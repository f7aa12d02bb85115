"""Quadratic programs: the backends agree, with each other and with the optimality conditions."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.solve.qp import BACKENDS, UNBOUNDED, QpSolution, QuadraticProgram, solve_daqp_softly

SEEDS = range(20)


def random_program(seed: int) -> QuadraticProgram:
    """Like a rate program: 12 variables, 4 equations, 20 inequalities; zero is feasible."""
    random = np.random.default_rng(seed)
    n, equations, inequalities = 12, 4, 20
    factor = random.normal(size=(8, n))
    A = random.normal(size=(equations + inequalities, n))
    x = random.normal(size=n)
    gap = np.concatenate([np.zeros(equations), random.uniform(0, 1, inequalities)])
    free = np.concatenate([A[:equations] @ x, np.full(inequalities, UNBOUNDED)])
    return QuadraticProgram(
        H=factor.T @ factor + 1e-2 * np.eye(n),
        f=3 * random.normal(size=n),
        lower=x - random.uniform(0, 2, n),
        upper=x + random.uniform(0, 2, n),
        A=A,
        row_lower=A @ x - gap,
        row_upper=free,
    )


def solve(backend: str, program: QuadraticProgram) -> QpSolution:
    """Solution of a program that has one."""
    solution = BACKENDS[backend](program)
    assert solution is not None
    return solution


@pytest.mark.parametrize("seed", SEEDS)
def test_backends_agree(seed: int):
    program = random_program(seed)
    solutions = [solve(backend, program) for backend in BACKENDS]
    for other in solutions[1:]:
        assert np.allclose(solutions[0].x, other.x, atol=1e-5)
        assert np.allclose(solutions[0].row_multipliers, other.row_multipliers, atol=1e-3)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("backend", BACKENDS)
def test_solutions_are_feasible_and_active_sets_right(backend: str, seed: int):
    program = random_program(seed)
    solution = solve(backend, program)
    x, rows = solution.x, program.A @ solution.x
    assert (x - program.lower).min() > -1e-7 and (program.upper - x).min() > -1e-7
    assert (rows - program.row_lower).min() > -1e-7 and (program.row_upper - rows).min() > -1e-7
    idle = rows[4:] - program.row_lower[4:] > 1e-5
    assert np.abs(solution.row_multipliers[4:][idle]).max(initial=0) < 1e-4
    # What the rows do not explain of the slope must push against bounds that are active.
    slope = program.H @ x + program.f + program.A.T @ solution.row_multipliers
    inside = (x - program.lower > 1e-5) & (program.upper - x > 1e-5)
    assert np.abs(slope[inside]).max(initial=0) < 1e-3
    assert (slope[x - program.lower < 1e-7] > -1e-3).all()
    assert (slope[program.upper - x < 1e-7] < 1e-3).all()


@pytest.mark.parametrize("backend", BACKENDS)
def test_unconstrained_minimum(backend: str):
    free = np.full(2, UNBOUNDED)
    program = QuadraticProgram(
        np.diag([2.0, 4.0]), np.array([-2.0, 4.0]), -free, free, np.zeros((0, 2)), np.zeros(0), np.zeros(0)
    )  # fmt: skip
    assert np.allclose(solve(backend, program).x, [1, -1], atol=1e-6)


def contradiction(kind: str) -> QuadraticProgram:
    """A program without a feasible point."""
    A = {"rows": [[1.0, 1], [1, 1]], "row and bounds": [[1.0, 1], [1, -1]]}[kind]
    low = {"rows": [2.0, -1], "row and bounds": [3.0, 0]}[kind]
    high = {"rows": [3.0, 1], "row and bounds": [4.0, 0]}[kind]
    one = np.ones(2)
    return QuadraticProgram(
        np.eye(2), np.zeros(2), -one, one, np.array(A), np.array(low), np.array(high)
    )


@pytest.mark.parametrize("kind", ["rows", "row and bounds"])
@pytest.mark.parametrize("backend", BACKENDS)
def test_no_feasible_point_is_none(backend: str, kind: str):
    assert BACKENDS[backend](contradiction(kind)) is None


@pytest.mark.parametrize("kind", ["rows", "row and bounds"])
def test_soft_rows_give_way_and_bounds_do_not(kind: str):
    program = contradiction(kind)
    solution = solve_daqp_softly(program)
    assert solution is not None
    assert np.abs(solution.x).max() <= 1 + 1e-9
    assert (program.A @ solution.x)[0] > 1  # towards what it asks for


@pytest.mark.parametrize("seed", SEEDS)
def test_violating_a_soft_row_is_dear(seed: int):
    """Rows that can be met give way to the slope they resist, but only a 500th of it."""
    program = random_program(seed)
    soft = solve_daqp_softly(program)
    assert soft is not None
    violation = np.maximum(program.row_lower - program.A @ soft.x, 0).max()
    assert 0 < violation < np.abs(soft.row_multipliers).max() / 500
    assert np.allclose(soft.x, solve("daqp", program).x, atol=0.05)
