"""Static equilibrium as exact linear programs: least joint torque, and greatest tip force."""

from __future__ import annotations

from dataclasses import dataclass

import daqp
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TORQUE_UNIT_NMM = 1000.0
"""Torques enter the programs in N m, so that all of their variables are of order one."""
LEVER_UNIT_MM = 10.0
"""Moments enter in units of 10 N mm, for the same reason."""
UNBOUNDED = 1e30
OPTIMAL = 1
EQUALITY, INEQUALITY = 5, 0


@dataclass(frozen=True)
class Holding:
    """How a hand holds the tool against a tip force."""

    largest_torque_nmm: float
    """Largest absolute joint torque of the equilibrium that makes it least [N mm]."""
    torque_nmm: Array
    """(n_joints,) joint torques of that equilibrium [N mm]."""
    forces_n: Array
    """(n m,) force along each cone edge [N]; an edge's normal part is 1."""


def least_torque(
    wrench: Array, torque: Array, load: Array, max_torque_nmm: float
) -> Holding | None:
    """The equilibrium with the least largest |joint torque|; None when there is none.

    minimize t  subject to  W f = -load,  |T f| <= t <= max_torque,  f >= 0.

    Args:
        wrench: (6, k) force [-] over moment [mm] on the tool along each cone edge.
        torque: (n_joints, k) joint torque [mm] along each edge.
        load: (6,) external force [N] over moment [N mm] on the tool.
        max_torque_nmm: cap on the torque, without which it grows without bound where friction
            alone still balances.
    """
    joints, edges = torque.shape
    scaled = torque / TORQUE_UNIT_NMM
    column = np.ones((joints, 1))
    rows = np.vstack(
        [
            np.hstack([_balance(wrench), np.zeros((6, 1))]),
            np.hstack([scaled, -column]),
            np.hstack([-scaled, -column]),
        ]
    )
    bound = np.concatenate([-_balance(load), np.zeros(2 * joints)])
    cost = np.zeros(edges + 1)
    cost[-1] = 1.0
    upper = np.full(edges + 1, UNBOUNDED)
    upper[-1] = max_torque_nmm / TORQUE_UNIT_NMM
    solution = _solve(cost, rows, bound, upper)
    if solution is None:
        return None
    forces = solution[:-1]
    return Holding(float(solution[-1] * TORQUE_UNIT_NMM), torque @ forces, forces)


def greatest_load(wrench: Array, motor_torque: Array, load: Array, limit_nmm: Array) -> float:
    """Largest factor F such that F times `load` can be held within the motors' torque.

    maximize F  subject to  W f = -F load,  |M f| <= limit,  f >= 0,  F >= 0.

    Args:
        wrench: (6, k) as in :func:`least_torque`.
        motor_torque: (n_motors, k) motor torque [mm] along each edge.
        load: (6,) external wrench of unit size.
        limit_nmm: (n_motors,) torque that each motor can give [N mm].
    """
    motors, edges = motor_torque.shape
    scaled, limit = motor_torque / TORQUE_UNIT_NMM, limit_nmm / TORQUE_UNIT_NMM
    rows = np.vstack(
        [
            np.hstack([_balance(wrench), _balance(load)[:, None]]),
            np.hstack([scaled, np.zeros((motors, 1))]),
            np.hstack([-scaled, np.zeros((motors, 1))]),
        ]
    )
    bound = np.concatenate([np.zeros(6), limit, limit])
    cost = np.zeros(edges + 1)
    cost[-1] = -1.0
    solution = _solve(cost, rows, bound, np.full(edges + 1, UNBOUNDED))
    return 0.0 if solution is None else float(solution[-1])


def _balance(wrench: Array) -> Array:
    """Wrench rows with moments in their own unit."""
    scale = np.array([1.0, 1.0, 1.0] + [1 / LEVER_UNIT_MM] * 3)
    return wrench * (scale if wrench.ndim == 1 else scale[:, None])


def _solve(cost: Array, rows: Array, bound: Array, upper: Array) -> Array | None:
    """Least cost x >= 0 under six equalities and then inequalities `rows x <= bound`."""
    n, m = len(cost), len(bound)
    sense = np.full(n + m, INEQUALITY, dtype=np.int32)
    sense[n : n + 6] = EQUALITY
    lower = np.concatenate([np.zeros(n), bound[:6], np.full(m - 6, -UNBOUNDED)])
    x, _, flag, _ = daqp.solve(None, cost, rows, np.concatenate([upper, bound]), lower, sense)
    return x if flag == OPTIMAL else None
