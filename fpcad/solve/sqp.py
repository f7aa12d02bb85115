"""Trust-region Gauss-Newton sequential quadratic programming.

Nocedal, Wright (2006), sections 18.1 to 18.5: an l1 merit function judges steps, a second-order
correction saves those that only the curvature of the constraints spoils, and where the
linearized constraints contradict each other they are met as well as can be.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.solve.program import Linearization, Program, SolveResult
from fpcad.solve.qp import UNBOUNDED, QpSolution, QuadraticProgram, solve_daqp, solve_daqp_softly

Array = NDArray[np.float64]

CURVATURE_FLOOR = 1e-4
"""Added to the Hessian in scaled variables: keeps flat directions from running to the edge of trust."""
RESTORATION_WEIGHT = 1e4
"""Price of violated equations, against the cost, where the linearized program has no solution."""


LEAST_PENALTY = 1e-2
"""Least price of infeasibility [1/mm] in the merit function."""


@dataclass(frozen=True)
class SqpSettings:
    """When to stop, and how far to trust."""

    max_iterations: int = 60
    feasibility: float = 1e-9
    """Largest violation of rows, margins and bounds [mm, rad]."""
    progress: float = 1e-6
    """Predicted decrease of the merit function at which a point counts as optimal."""
    trust: float = 0.5
    """First trust radius, in scaled variables."""
    max_trust: float = 2.0
    min_trust: float = 1e-5
    """Radius at which the merit function is no longer followed."""
    max_restorations: int = 20
    """Newton steps that restore feasibility at the end."""


class _Point(NamedTuple):
    """A program's values at one point, in scaled variables; owns its arrays."""

    y: Array
    at: Linearization
    cost: float
    infeasibility: float  # l1

    @property
    def violation(self) -> float:
        rows = np.abs(self.at.rows).max(initial=0.0)
        return max(float(rows), float(-self.at.margins.min(initial=0.0)))


class _Tried(NamedTuple):
    """A step in scaled variables that was taken, and where it led."""

    step: Array
    outcome: _Point


def solve_sqp(program: Program, start: Array, settings: SqpSettings) -> SolveResult:
    """Minimize a program from `start` (n,), which is first moved inside the bounds.

    The merit function leads to a point that is as good as it gets; Newton steps of least length
    then restore feasibility to full precision.
    """
    point = _evaluate(program, np.clip(start, program.lower, program.upper))
    point, iterations, converged = _descend(program, point, settings)
    point = _restore(program, point, settings)
    feasible = point.violation <= settings.feasibility
    return SolveResult(point.y, point.cost, point.violation, iterations, converged and feasible)


def restore(program: Program, guess: Array, settings: SqpSettings) -> SolveResult:
    """The feasible point next to `guess` (n,): shortest Newton steps in scaled variables."""
    start = _evaluate(program, np.clip(guess, program.lower, program.upper))
    point = _restore(program, start, settings)
    feasible = point.violation <= settings.feasibility
    return SolveResult(point.y, point.cost, point.violation, 0, feasible)


def _descend(program: Program, point: _Point, settings: SqpSettings) -> tuple[_Point, int, bool]:
    """Follow the merit function; the point, the iterations and whether no progress was left."""
    trust, penalty = settings.trust, LEAST_PENALTY
    for iteration in range(settings.max_iterations):
        step = _step(program, point, trust, None)
        if step is None:
            return point, iteration, False
        penalty = max(penalty, 1.5 * float(np.abs(step.row_multipliers).max(initial=0.0)))
        predicted = _merit(point, penalty) - _predict(point, step.x, penalty)
        if predicted <= settings.progress:
            return point, iteration, True
        trial = _trial(program, point, step.x, trust, penalty)
        actual = _merit(point, penalty) - _merit(trial, penalty)
        size = float(np.abs(step.x).max(initial=0.0))
        if actual >= 0.1 * predicted:
            point = trial
            if actual >= 0.7 * predicted and size >= 0.9 * trust:
                trust = min(2 * trust, settings.max_trust)
        else:
            trust = 0.3 * min(trust, size)
        if trust < settings.min_trust:
            return point, iteration + 1, False
    return point, settings.max_iterations, False


def _restore(program: Program, point: _Point, settings: SqpSettings) -> _Point:
    """Newton's method on the violated constraints, each step the shortest that meets them.

    Violation may rise for a step or two where a contact crosses from cylinder to tip, since the
    curvature jumps there; the least violated point is returned.
    """
    best = point
    for _ in range(settings.max_restorations):
        if best.violation <= settings.feasibility:
            break
        step = _step(program, point, settings.max_trust, None, shortest=True)
        if step is None:
            break
        point = _evaluate(program, _moved(program, point.y, step.x))
        best = min(best, point, key=lambda candidate: candidate.violation)
    return best


def _evaluate(program: Program, y: Array) -> _Point:
    raw = program.evaluate(y)
    at = Linearization(
        raw.residuals.copy(),
        raw.residuals_jacobian * program.scale,
        raw.rows.copy(),
        raw.rows_jacobian * program.scale,
        raw.margins.copy(),
        raw.margins_jacobian * program.scale,
    )
    infeasibility = np.abs(at.rows).sum() - np.minimum(at.margins, 0.0).sum()
    return _Point(y, at, float(at.residuals @ at.residuals), float(infeasibility))


def _step(
    program: Program,
    point: _Point,
    trust: float,
    tried: _Tried | None,
    shortest: bool = False,
) -> QpSolution | None:
    """Step in scaled variables from the linearized program within the trust region.

    After a step that was tried, the constraints are those that its outcome shows: their values
    there, less the linear part of the way (second-order correction).
    """
    at, n = point.at, len(point.y)
    rows, margins = at.rows, at.margins
    if tried is not None:
        rows = tried.outcome.at.rows - at.rows_jacobian @ tried.step
        margins = tried.outcome.at.margins - at.margins_jacobian @ tried.step
    J = at.residuals_jacobian
    lower = np.maximum((program.lower - point.y) / program.scale, -trust)
    upper = np.minimum((program.upper - point.y) / program.scale, trust)
    near = margins < np.abs(at.margins_jacobian).sum(axis=1) * trust
    H = np.eye(n) if shortest else 2 * J.T @ J + CURVATURE_FLOOR * np.eye(n)
    f = np.zeros(n) if shortest else 2 * J.T @ at.residuals
    A, G, margins = at.rows_jacobian, at.margins_jacobian[near], margins[near]
    free = np.full(len(margins), UNBOUNDED)
    exact = QuadraticProgram(
        H,
        f,
        lower,
        upper,
        np.vstack([A, G]),
        np.concatenate([-rows, -margins]),
        np.concatenate([-rows, free]),
    )
    solution = solve_daqp(exact)
    if solution is not None or tried is not None:
        return solution
    H, f = H + RESTORATION_WEIGHT * A.T @ A, f + RESTORATION_WEIGHT * A.T @ rows
    return solve_daqp_softly(QuadraticProgram(H, f, lower, upper, G, -margins, free))


def _predict(point: _Point, step: Array, penalty: float) -> float:
    """Merit that the linearization promises after a step."""
    at = point.at
    residuals = at.residuals + at.residuals_jacobian @ step
    rows = at.rows + at.rows_jacobian @ step
    margins = at.margins + at.margins_jacobian @ step
    infeasibility = np.abs(rows).sum() - np.minimum(margins, 0.0).sum()
    return float(residuals @ residuals + penalty * infeasibility)


def _trial(program: Program, point: _Point, step: Array, trust: float, penalty: float) -> _Point:
    """The point after a step, or after its second-order correction where that is better."""
    trial = _evaluate(program, _moved(program, point.y, step))
    if _merit(trial, penalty) < _merit(point, penalty):
        return trial
    correction = _step(program, point, trust, _Tried(step, trial))
    if correction is None:
        return trial
    corrected = _evaluate(program, _moved(program, point.y, correction.x))
    return min(trial, corrected, key=lambda candidate: _merit(candidate, penalty))


def _moved(program: Program, y: Array, step: Array) -> Array:
    return np.clip(y + program.scale * step, program.lower, program.upper)


def _merit(point: _Point, penalty: float) -> float:
    return point.cost + penalty * point.infeasibility
