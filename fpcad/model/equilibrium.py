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
_BALANCE = np.array([1.0, 1.0, 1.0] + [1 / LEVER_UNIT_MM] * 3)
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
    rows = np.zeros((6 + 2 * joints, edges + 1))
    rows[:6, :edges] = _BALANCE[:, None] * wrench
    rows[6 : 6 + joints, :edges] = torque / TORQUE_UNIT_NMM
    rows[6 + joints :, :edges] = -rows[6 : 6 + joints, :edges]
    rows[6:, edges] = -1.0
    bound = np.zeros(6 + 2 * joints)
    bound[:6] = -_BALANCE * load
    cost = np.zeros(edges + 1)
    cost[edges] = 1.0
    upper = np.full(edges + 1, UNBOUNDED)
    upper[edges] = max_torque_nmm / TORQUE_UNIT_NMM
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
    rows = np.zeros((6 + 2 * motors, edges + 1))
    rows[:6, :edges] = _BALANCE[:, None] * wrench
    rows[:6, edges] = _BALANCE * load
    rows[6 : 6 + motors, :edges] = motor_torque / TORQUE_UNIT_NMM
    rows[6 + motors :, :edges] = -rows[6 : 6 + motors, :edges]
    bound = np.zeros(6 + 2 * motors)
    bound[6 : 6 + motors] = bound[6 + motors :] = limit_nmm / TORQUE_UNIT_NMM
    cost = np.zeros(edges + 1)
    cost[edges] = -1.0
    solution = _solve(cost, rows, bound, np.full(edges + 1, UNBOUNDED))
    return 0.0 if solution is None else float(solution[-1])


def _solve(cost: Array, rows: Array, bound: Array, upper: Array) -> Array | None:
    """Least cost x >= 0 under six equalities and then inequalities `rows x <= bound`."""
    n, m = len(cost), len(bound)
    sense = np.full(n + m, INEQUALITY, dtype=np.int32)
    sense[n : n + 6] = EQUALITY
    lower = np.full(n + m, -UNBOUNDED)
    lower[:n] = 0.0
    lower[n : n + 6] = bound[:6]
    x, _, flag, _ = daqp.solve(None, cost, rows, np.concatenate([upper, bound]), lower, sense)
    return x if flag == OPTIMAL else None
