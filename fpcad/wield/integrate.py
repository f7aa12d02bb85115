"""One step along a wielding path: Runge-Kutta on the rates, then projection onto contact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.solve.program import build_projection_program
from fpcad.solve.sqp import SqpSettings, restore
from fpcad.wield.graph import GraphStep
from fpcad.wield.rates import SINGULAR_CURVATURE, End, Mechanism, Rates, solve_rates

Array = NDArray[np.float64]

PROJECTION = SqpSettings(feasibility=1e-9, max_trust=0.5)
"""Contact to 1e-9 mm; a correction of more than half a radian would be another path."""


UNMET = 1e-8
"""Violation [rad/s, mm/s] of a rate program up to which the graph's solution is taken for one."""


class Step(NamedTuple):
    """State after a step, and what happened on the way."""

    x: Array  # (n_u + 4n,) state [u, a]
    sliding: Array  # (n,) distance [mm] that each contact slid


def advance(
    m: Mechanism, turn: float, x: Array, direction: float, dt: float, project_after: bool = True
) -> Step | End:
    """Turn the tool by `direction * dt` [rad]: classical Runge-Kutta of order 4, then projection.

    Args:
        turn: tool angle [rad] before the step.
        x: (n_u + 4n,) state [u, a] before the step.
        direction: +1 or -1.
        dt: length of the step [rad], at 1 rad/s also [s].
        project_after: whether to correct the drift off contact.
    """
    stages: list[Rates] = []
    for fraction in (0.0, 0.5, 0.5, 1.0):
        at = x + fraction * dt * stages[-1].x if stages else x
        rates = solve_rates(m, turn + direction * fraction * dt, at, direction, dt)
        if isinstance(rates, End):
            return rates
        stages.append(rates)
    weights = dt / 6 * np.array([1.0, 2.0, 2.0, 1.0])
    moved = x + weights @ np.array([stage.x for stage in stages])
    sliding = weights @ np.array([stage.sliding for stage in stages])
    if not project_after:
        return Step(moved, sliding)
    projected = project(m, turn + direction * dt, moved)
    return End.PROJECTION if projected is None else Step(projected, sliding)


def step(m: Mechanism, turn: float, x: Array, direction: float, dt: float) -> Step | End:
    """As :func:`advance`, by the mechanism's graph where it has one and finds a solution."""
    if m.graph is not None:
        out = GraphStep(*m.graph(m.design, m.hand, turn, x, direction, dt))
        solved = not m.graph.failed and out.unmet[0] <= UNMET
        if solved and out.least_determinant[0] >= SINGULAR_CURVATURE:
            reached, sliding = out.x.copy(), out.sliding.copy()
            if out.violation[0] <= PROJECTION.feasibility:
                return Step(reached, sliding)
            projected = project(m, turn + direction * dt, reached)
            if projected is not None:
                return Step(projected, sliding)
    return advance(m, turn, x, direction, dt)


def project(m: Mechanism, turn: float, guess: Array) -> Array | None:
    """The state x = [u, a] in contact next to a guess, tool and hand held; None if there is none."""
    program = build_projection_program(m.kernels, m.bounds, m.design, m.hand, turn)
    result = restore(program, guess, PROJECTION)
    far = np.abs((result.y - guess) / program.scale).max() > PROJECTION.max_trust
    return result.y if result.converged and not far else None
