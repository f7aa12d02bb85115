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
BALANCE = np.array([1.0, 1.0, 1.0] + [1 / LEVER_UNIT_MM] * 3)
"""What a wrench is multiplied with in the programs' equations."""
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
    """(3n,) normal force and friction along both tangents at each contact; friction in units of its
    coefficient, see :func:`fpcad.model.statics.cone_axes` [N]."""


def least_torque(
    wrench: Array, torque: Array, load: Array, max_torque_nmm: float, facets: Array
) -> Holding | None:
    """The equilibrium with the least largest |joint torque|; None when there is none.

    minimize t  subject to  W f = -load,  |T f| <= t <= max_torque,  each f_i in its cone.

    Args:
        wrench: (6, 3n) force [-] over moment [mm] on the tool of unit forces along the cones' axes.
        torque: (n_joints, 3n) joint torque [mm] of the same.
        load: (6,) external force [N] over moment [N mm] on the tool.
        max_torque_nmm: cap on the torque, without which it grows without bound where friction
            alone still balances.
        facets: (m, 3) sides of one contact's friction pyramid.
    """
    joints = len(torque)
    cones = _cones(facets, torque.shape[1])
    rows, bound = _rows(wrench, cones, torque, np.zeros(joints))
    rows[-2 * joints :, -1] = -1.0
    bound[:6] = -BALANCE * load
    solution = _solve(rows, bound, 1.0, max_torque_nmm / TORQUE_UNIT_NMM)
    if solution is None:
        return None
    forces = solution[:-1]
    return Holding(float(solution[-1] * TORQUE_UNIT_NMM), torque @ forces, forces)


def greatest_load(
    wrench: Array, motor_torque: Array, load: Array, limit_nmm: Array, facets: Array
) -> float:
    """Largest factor F such that F times `load` can be held within the motors' torque.

    maximize F  subject to  W f = -F load,  |M f| <= limit,  each f_i in its cone,  F >= 0.

    Args:
        wrench: (6, 3n) as in :func:`least_torque`.
        motor_torque: (n_motors, 3n) motor torque [mm] of unit forces along the cones' axes.
        load: (6,) external wrench of unit size.
        limit_nmm: (n_motors,) torque that each motor can give [N mm].
        facets: (m, 3) as in :func:`least_torque`.
    """
    cones = _cones(facets, motor_torque.shape[1])
    rows, bound = _rows(wrench, cones, motor_torque, limit_nmm / TORQUE_UNIT_NMM)
    rows[:6, -1] = BALANCE * load
    solution = _solve(rows, bound, -1.0, UNBOUNDED)
    return 0.0 if solution is None else float(solution[-1])


def _cones(facets: Array, size: int) -> Array:
    """(n m, 3n) rows that are <= 0 where every contact's force is inside its pyramid."""
    return np.asarray(np.kron(np.eye(size // 3), facets), dtype=np.float64)


def _rows(wrench: Array, cones: Array, torque: Array, limit: Array) -> tuple[Array, Array]:
    """Rows and bounds on [f, last]: balance of the forces, cones, torques within +-limit [N m]."""
    sides, forces = cones.shape
    rows = np.zeros((6 + sides + 2 * len(torque), forces + 1))
    rows[:6, :-1] = BALANCE[:, None] * wrench
    rows[6 : 6 + sides, :-1] = cones
    rows[6 + sides : -len(torque), :-1] = torque / TORQUE_UNIT_NMM
    rows[-len(torque) :, :-1] = -rows[6 + sides : -len(torque), :-1]
    return rows, np.concatenate([np.zeros(6 + sides), limit, limit])


def _solve(rows: Array, bound: Array, cost: float, most: float) -> Array | None:
    """Least cost of the last variable in [0, most]; the first six rows are equations."""
    n, m = rows.shape[1], len(bound)
    lower, upper = np.full(n + m, -UNBOUNDED), np.full(n + m, UNBOUNDED)
    lower[n - 1], upper[n - 1] = 0.0, most
    lower[n : n + 6], upper[n:] = bound[:6], bound
    sense = np.full(n + m, INEQUALITY, dtype=np.int32)
    sense[n : n + 6] = EQUALITY
    gradient = np.zeros(n)
    gradient[-1] = cost
    x, _, flag, _ = daqp.solve(None, gradient, rows, upper, lower, sense)
    return x if flag == OPTIMAL else None
