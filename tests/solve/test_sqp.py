"""The own solver on programs whose answers are in textbooks or follow on one line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np
import pytest

from fpcad.solve.program import Linearization, Program
from fpcad.solve.sqp import SqpSettings, restore, solve_sqp
from tests.model.plain_hand import Array

SETTINGS = SqpSettings(progress=1e-12, min_trust=1e-9)
SYMBOL = ca.SX.sym("y", 2)
X, Y = SYMBOL[0], SYMBOL[1]


@dataclass(frozen=True)
class Problem:
    """A program in two variables with its answer."""

    residuals: list[ca.SX]
    rows: list[ca.SX]
    margins: list[ca.SX]
    answer: tuple[float, float]
    start: tuple[float, float] = (0.3, 0.4)
    bounds: tuple[float, float] = (-10.0, 10.0)

    @property
    def program(self) -> Program:
        return stated(self.residuals, self.rows, self.margins, self.bounds)


def stated(
    residuals: list[ca.SX],
    rows: list[ca.SX],
    margins: list[ca.SX],
    bounds: tuple[float, float] = (-10.0, 10.0),
    scale: tuple[float, float] = (1.0, 1.0),
) -> Program:
    """A program in the two symbols, with exact Jacobians."""
    outputs = []
    for part in (residuals, rows, margins):
        expression = ca.vertcat(*part) if part else ca.SX(0, 1)
        outputs += [expression, ca.jacobian(expression, SYMBOL)]
    function = ca.Function("program", [SYMBOL], [ca.densify(output) for output in outputs])

    def evaluate(y: Array) -> Linearization:
        values = [np.array(value) for value in function(y)]
        shaped = [v.reshape(-1) if i % 2 == 0 else v.reshape(-1, 2) for i, v in enumerate(values)]
        return Linearization(*shaped)

    low, high = (np.full(2, bound) for bound in bounds)
    return Program(evaluate, low, high, np.array(scale))


ON_CIRCLE = X**2 + Y**2 - 1
PROBLEMS: dict[str, Problem] = {
    "nearest point of a line": Problem([X, Y], [X + Y - 1], [], (0.5, 0.5)),
    "nearest point of a circle": Problem(
        [X - 2, Y - 1], [ON_CIRCLE], [], (2 / np.sqrt(5), 1 / np.sqrt(5))
    ),
    "corner of a box": Problem([X - 3, Y + 1], [], [], (1.0, 0.0), bounds=(0.0, 1.0)),
    "one active bound": Problem([X - 3, Y - 0.2], [], [], (1.0, 0.2), bounds=(0.0, 1.0)),
    "active margin": Problem([X - 2, Y - 2], [], [2 - X - Y], (1.0, 1.0)),
    "idle margin": Problem([X - 0.2, Y - 0.3], [], [2 - X - Y], (0.2, 0.3)),
    "row, margin and bound": Problem([X, Y - 3], [Y - X**2], [1.5 - X - Y / 2], (1.0, 1.0), bounds=(0.0, 10.0)),
    "Hock and Schittkowski 6": Problem([1 - X], [10 * (Y - X**2)], [], (1.0, 1.0), start=(-1.2, 1.0)),
    "Rosenbrock": Problem([10 * (Y - X**2), 1 - X], [], [], (1.0, 1.0), start=(-1.2, 1.0)),
    "Rosenbrock in a disc": Problem(
        [10 * (Y - X**2), 1 - X], [], [-ON_CIRCLE], (0.78641515, 0.61769831), start=(-0.5, 0.5)
    ),
    "fixed variables": Problem([X - 1, Y - 1], [], [], (0.25, 0.25), bounds=(0.25, 0.25)),
}  # fmt: skip


@pytest.mark.parametrize("name", PROBLEMS)
def test_known_answers(name: str):
    problem = PROBLEMS[name]
    result = solve_sqp(
        problem.program, np.array(problem.start), SqpSettings(200, progress=1e-14, min_trust=1e-9)
    )
    assert result.converged
    assert result.violation <= 1e-9
    assert np.allclose(result.y, problem.answer, atol=1e-5)
    residuals = problem.program.evaluate(result.y).residuals
    assert result.cost == pytest.approx(float(residuals @ residuals))


@pytest.mark.parametrize("name", PROBLEMS)
def test_bounds_hold_at_every_evaluation(name: str):
    problem = PROBLEMS[name]
    program, seen = problem.program, []

    def evaluate(y: Array) -> Linearization:
        seen.append(y.copy())
        return program.evaluate(y)

    solve_sqp(
        Program(evaluate, program.lower, program.upper, program.scale),
        np.array([20.0, -20]),
        SETTINGS,
    )
    assert np.min(seen) >= problem.bounds[0] and np.max(seen) <= problem.bounds[1]


INFEASIBLE: dict[str, tuple[list[ca.SX], list[ca.SX]]] = {
    "equation without solution": ([X**2 + 1], []),
    "equations that contradict each other": ([X + Y - 1, X + Y - 2], []),
    "margins that contradict each other": ([], [X - 1, -1 - X]),
    "margin beyond the bounds": ([], [X - 11]),
}


@pytest.mark.parametrize("name", INFEASIBLE)
def test_infeasible_programs_do_not_converge(name: str):
    rows, margins = INFEASIBLE[name]
    result = solve_sqp(stated([X, Y], rows, margins), np.array([0.3, 0.4]), SETTINGS)
    assert not result.converged
    assert result.violation > 0.4


def test_too_few_iterations_are_admitted():
    problem = PROBLEMS["Rosenbrock"]
    result = solve_sqp(problem.program, np.array(problem.start), SqpSettings(max_iterations=2))
    assert not result.converged and result.iterations == 2


def test_the_start_is_moved_inside_the_bounds():
    problem = PROBLEMS["corner of a box"]
    result = solve_sqp(problem.program, np.array([100.0, -100.0]), SETTINGS)
    assert result.converged and np.allclose(result.y, problem.answer, atol=1e-6)


def test_scale_changes_the_way_and_not_the_answer():
    problem = PROBLEMS["nearest point of a circle"]
    scaled = stated(problem.residuals, problem.rows, problem.margins, scale=(10.0, 0.1))
    result = solve_sqp(
        scaled, np.array(problem.start), SqpSettings(200, progress=1e-14, min_trust=1e-9)
    )
    assert np.allclose(result.y, problem.answer, atol=1e-5)


@pytest.mark.parametrize(
    ("rows", "margins", "guess", "nearest"),
    [
        ([X + Y - 1], [], (0.0, 0.0), (0.5, 0.5)),
        ([ON_CIRCLE], [], (2.0, 0.0), (1.0, 0.0)),
        ([], [1 - X], (3.0, 0.2), (1.0, 0.2)),
        ([], [1 - X], (0.7, 0.2), (0.7, 0.2)),  # feasible points stay
    ],
)
def test_restoring_goes_the_shortest_way(rows, margins, guess, nearest):
    result = restore(stated([], rows, margins), np.array(guess), SqpSettings())
    assert result.converged and result.violation <= 1e-9
    assert np.allclose(result.y, nearest, atol=1e-9)


def test_the_shortest_way_is_measured_in_scaled_variables():
    """x counts a tenth of y, so it takes 100 times the correction."""
    program = stated([], [X + Y - 1], [], scale=(10.0, 1.0))
    result = restore(program, np.zeros(2), SqpSettings())
    assert np.allclose(result.y, [100 / 101, 1 / 101])


def test_restoring_does_not_claim_what_cannot_be():
    result = restore(stated([], [X**2 + 1], []), np.array([0.5, 0.0]), SqpSettings())
    assert not result.converged


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_second_order_correction_follows_a_curved_constraint(sign: float):
    """From one side of a circle to the other, along it, in few iterations (Maratos' case)."""
    program: Callable[[], Program] = lambda: stated([X - 1, Y], [ON_CIRCLE], [])  # noqa: E731
    start = np.array([np.cos(2.5 * sign), np.sin(2.5 * sign)])
    result = solve_sqp(program(), start, SETTINGS)
    assert result.converged and result.iterations < 25
    assert np.allclose(result.y, [1, 0], atol=1e-5)
