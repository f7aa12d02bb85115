"""The rate program: joint rates that turn the tool while its contacts slide as little as can be."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.model.compile import Kernel
from fpcad.model.kernels import PoseKernels
from fpcad.solve.qp import UNBOUNDED, Backend, QuadraticProgram

Array = NDArray[np.float64]

SINGULAR_CURVATURE = 1e-4
"""Normalized determinant of the relative curvature below which contact rates are meaningless;
two cylinders whose axes differ by 0.6 deg have it."""


class End(StrEnum):
    """Why a path ends."""

    COMPLETE = "complete"
    RATES = "limits"
    STATICS = "statics"
    SINGULAR = "singular contact"
    PROJECTION = "projection"


@dataclass(frozen=True)
class Mechanism:
    """Tool and hand at one pose of one candidate, about to turn."""

    kernels: PoseKernels
    bounds: tuple[Array, Array]  # of x = [u, a], each (n_u + 4n,) [mm, rad]
    design: Array  # (n_d,) [mm, rad]
    hand: Array  # (6,) pose of H in O [mm, rad]
    rate_weight: float
    max_joint_rate: float  # [rad/s] at a tool rate of 1 rad/s
    qp: Backend
    graph: Kernel | None = None
    """The whole step compiled for this pose, see :mod:`fpcad.wield.graph`."""


class Rates(NamedTuple):
    """Motion at one state for a tool rate of +-1 rad/s."""

    x: Array  # (n_u + 4n,) rates of [u, a]
    sliding: Array  # (n,) sliding speeds [mm/s]


def solve_rates(m: Mechanism, turn: float, x: Array, direction: float, dt: float) -> Rates | End:
    """Rates at state x = [u, a], or why there are none.

    Args:
        turn: tool angle [rad].
        direction: tool rate, +1 or -1 [rad/s].
        dt: time [s] over which bounds and margins are looked ahead.
    """
    S, s0, N, n0, C, c0, determinants = m.kernels.rates(m.design, m.hand, turn, x)
    if determinants.min() < SINGULAR_CURVATURE:
        return End.SINGULAR
    g, G, g0 = _margin_rates(m, turn, x, C, c0)
    program = _rate_program(m, x, (S, direction * s0, N, direction * n0), dt)
    contact_low, contact_high = _look_ahead(m.bounds, x, dt, slice(len(program.f), None))
    bounded = np.isfinite(contact_low)
    rows = [program.A, C[bounded], G]
    low = [program.row_lower, (contact_low - direction * c0)[bounded], -g / dt - direction * g0]
    high = [program.row_upper, (contact_high - direction * c0)[bounded], np.full(len(g), UNBOUNDED)]
    solution = m.qp(
        QuadraticProgram(
            program.H,
            program.f,
            program.lower,
            program.upper,
            np.vstack(rows),
            np.concatenate(low),
            np.concatenate(high),
        )
    )
    if solution is None:
        return End.RATES
    u_rate = solution.x
    sliding = (S @ u_rate + direction * s0).reshape(-1, 2)
    a_rate = C @ u_rate + direction * c0
    return Rates(np.concatenate([u_rate, a_rate]), np.linalg.norm(sliding, axis=1))


def _rate_program(
    m: Mechanism, x: Array, motion: tuple[Array, Array, Array, Array], dt: float
) -> QuadraticProgram:
    """Least sliding under the contact equations and the joints' bounds."""
    S, s0, N, n0 = motion
    n_u = S.shape[1]
    lower, upper = _look_ahead(m.bounds, x, dt, slice(0, n_u))
    lower, upper = np.maximum(lower, -m.max_joint_rate), np.minimum(upper, m.max_joint_rate)
    H = 2 * (S.T @ S + m.rate_weight * np.eye(n_u))
    return QuadraticProgram(H, 2 * S.T @ s0, lower, upper, N, -n0, -n0)


def _margin_rates(
    m: Mechanism, turn: float, x: Array, C: Array, c0: Array
) -> tuple[Array, Array, Array]:
    """Margins (m_g,) [mm] and their rates as matrix on the joint rates and constant."""
    *_, g, J = m.kernels.constraints(m.design, turn, np.concatenate([m.hand, x]))
    layout = m.kernels.layout
    by_contacts = J[:, layout.contacts]
    return g, J[:, layout.joints] + by_contacts @ C, J[:, layout.size] + by_contacts @ c0


def _look_ahead(
    bounds: tuple[Array, Array], x: Array, dt: float, part: slice
) -> tuple[Array, Array]:
    """Rates that one explicit Euler step of length dt takes to the bounds."""
    return (bounds[0][part] - x[part]) / dt, (bounds[1][part] - x[part]) / dt
