"""One step along a wielding path: Runge-Kutta on the rates, then projection onto contact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.solve.program import build_projection_program
from fpcad.solve.sqp import SqpSettings, restore
from fpcad.wield.graph import GraphStep
from fpcad.wield.load import Load
from fpcad.wield.rates import SINGULAR_CURVATURE, End, Mechanism, Rates, solve_rates

Array = NDArray[np.float64]

PROJECTION = SqpSettings(feasibility=1e-9, max_trust=0.5)
"""Contact to 1e-9 mm; a correction of more than half a radian would be another path."""


UNMET = 1e-8
"""Violation up to which the graph's solution of a program is taken for one; rate programs in rad/s
and mm/s, programs of equilibrium in N, 10 N mm and N m."""


class Holding(NamedTuple):
    """What holds the tool in a state."""

    torque_nmm: float  # least largest joint torque against the tip force
    tip_force_n: float  # largest tip force that the motors hold


class Step(NamedTuple):
    """State after a step, and what happened on the way."""

    x: Array  # (n_u + 4n,) state [u, a]
    sliding: Array  # (n,) distance [mm] that each contact slid
    holding: Holding | None = None
    """Where it was found along with the step; None says nothing."""


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


def step(
    m: Mechanism, load: Load, turn: float, x: Array, direction: float, dt: float
) -> Step | End:
    """As :func:`advance`, by the mechanism's graph where it has one and finds a solution.

    A dual method's rates are optimal as soon as they violate nothing; an equilibrium is taken only
    where no program of the graph has failed.
    """
    if m.graph is not None:
        out = GraphStep(*m.graph(m.design, m.hand, turn, x, direction, dt, *load.values))
        if out.unmet[0] <= UNMET and out.least_determinant[0] >= SINGULAR_CURVATURE:
            reached, sliding = out.x.copy(), out.sliding.copy()
            if out.violation[0] <= PROJECTION.feasibility:
                held = not m.graph.failed and out.unheld[0] <= UNMET
                return Step(reached, sliding, _holding(out) if held else None)
            projected = project(m, turn + direction * dt, reached)
            if projected is not None:
                return Step(projected, sliding)
    return advance(m, turn, x, direction, dt)


def _holding(out: GraphStep) -> Holding:
    return Holding(float(out.torque_nmm[0]), float(out.tip_force_n[0]))


def project(m: Mechanism, turn: float, guess: Array) -> Array | None:
    """The state x = [u, a] in contact next to a guess, tool and hand held; None if there is none."""
    program = build_projection_program(m.kernels, m.bounds, m.design, m.hand, turn)
    result = restore(program, guess, PROJECTION)
    far = np.abs((result.y - guess) / program.scale).max() > PROJECTION.max_trust
    return result.y if result.converged and not far else None
