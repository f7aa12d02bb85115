"""The forces of the grip along a path: one quadratic program over all its states."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.preload.touch import FORCE_AXES, Touch
from fpcad.solve.qp import UNBOUNDED, QuadraticProgram, solve_daqp

Array = NDArray[np.float64]

FACETS = 16
"""Edges of the pyramid inside each friction cone; it holds 98 % of the cone."""
SLACK_PRICE = 1e3
"""Price [N] of a newton beyond the planned share of the cone: paid only where nothing else balances."""
SLACK_WEIGHT = 1e-2
"""Makes the program strictly convex in the slacks too."""
TOLERANCE_N = 1e-3
"""Largest change of a force in a sweep with which the sweeps are done."""
MAX_SWEEPS = 60
LEVER_MM = 30.0
"""Moments count in newtons at this lever, so that the program's rows are of one size."""


@dataclass(frozen=True)
class GripDemand:
    """What the forces must do."""

    load: Array
    """(N, 6) wrench on the tool that they balance: force [N] over moment [N mm] at its centre."""
    least_normal_n: Array
    """(N,)"""
    most_normal_n: Array
    """(N,)"""
    friction: float
    """Coefficient of friction [-] that may be used: the planned share of the real one."""
    motor_limit_nmm: float
    spacing_rad: Array
    """(N - 1,) turn of the tool between neighbouring states."""
    smoothing_rad: float


def grip_forces(touch: Touch, motor_torque: Array, demand: GripDemand) -> Array:
    """Contact forces (N, 3n) on the tool [N], in the contacts' axes.

    The least squares of forces and of their changes along the path, under balance with the load,
    least normal forces, the motors' torque and the planned share of the friction cone. Where the
    path leaves no balance within that share, forces exceed it by as little as can be.

    Neighbours share no constraint, so the states' programs are solved in turn, each with its
    neighbours held, until nothing changes: block descent, which ends at the whole's minimum.

    Args:
        touch: the contacts of N states.
        motor_torque: (N, n_motors, 3n) motor torques [N mm] for unit forces.
        demand: what the forces must do.

    Raises:
        MakeError: no forces balance within the motors' torque.
    """
    rows, low, high = _rows(touch, motor_torque, demand)
    pull = np.concatenate([[0.0], (demand.smoothing_rad / demand.spacing_rad) ** 2, [0.0]])
    size = touch.grasp_map.shape[2]
    forces = np.zeros((len(rows), size))
    for sweep in range(MAX_SWEEPS):
        before = forces.copy()
        for k in range(len(rows)):
            # In the first sweep the next state is not known yet, so it does not pull.
            pulls = pull[k], pull[k + 1] if sweep else 0.0
            aim = pulls[0] * forces[k - 1] + pulls[1] * forces[(k + 1) % len(rows)]
            forces[k] = _state_forces(1.0 + sum(pulls), aim, rows[k], low[k], high[k], demand, k)
        if np.abs(forces - before).max() < TOLERANCE_N:
            break
    return forces


def balance_residual(touch: Touch, forces: Array, load: Array) -> Array:
    """The least forces (N, 3n) [N] whose removal makes forces (N, 3n) balance the load (N, 6)."""
    grasp = touch.grasp_map / _wrench_units()
    missing = np.einsum("kij,kj->ki", grasp, forces) + load / _wrench_units()[:, 0]
    return np.einsum("kij,kj->ki", np.linalg.pinv(grasp), missing)


def _state_forces(
    weight: float, aim: Array, rows: Array, low: Array, high: Array, demand: GripDemand, k: int
) -> Array:
    """Forces (3n,) of one state; its variables are forces, then what each exceeds its cone by."""
    size, contacts = len(aim), len(aim) // FORCE_AXES
    least, most = np.full(size, -UNBOUNDED), np.full(size, UNBOUNDED)
    least[::FORCE_AXES] = demand.least_normal_n[k]
    most[::FORCE_AXES] = np.minimum(demand.most_normal_n[k], UNBOUNDED)
    program = QuadraticProgram(
        H=np.diag(np.repeat([weight, SLACK_WEIGHT], [size, contacts])),
        f=np.concatenate([-aim, np.full(contacts, SLACK_PRICE)]),
        lower=np.concatenate([least, np.zeros(contacts)]),
        upper=np.concatenate([most, np.full(contacts, UNBOUNDED)]),
        A=rows,
        row_lower=low,
        row_upper=high,
    )
    solution = solve_daqp(program)
    if solution is None:
        raise MakeError(
            "no forces grip the tool within the motors' torque: lower grip.min_normal_force_n, or "
            "take stronger motors"
        )
    return solution.x[:size]


def _rows(touch: Touch, motor_torque: Array, demand: GripDemand) -> tuple[Array, Array, Array]:
    """Rows (N, m, 4n) of balance, cones and motors, with their bounds (N, m) each."""
    states, contacts = touch.points_mm.shape[:2]
    cones = np.broadcast_to(
        _cones(contacts, demand.friction), (states, contacts * FACETS, 4 * contacts)
    )
    balance = _padded(touch.grasp_map / _wrench_units(), contacts)
    motors = _padded(motor_torque / demand.motor_limit_nmm, contacts)
    carried = -demand.load / _wrench_units()[:, 0]
    unbounded, none = (
        np.full((states, contacts * FACETS), -UNBOUNDED),
        np.zeros((states, contacts * FACETS)),
    )
    whole = np.ones(motors.shape[:2])
    return (
        np.concatenate([balance, cones, motors], axis=1),
        np.hstack([carried, unbounded, -whole]),
        np.hstack([carried, none, whole]),
    )


def _cones(contacts: int, friction: float) -> Array:
    """Facets (n FACETS, 4n) of the cones, which the slacks widen."""
    angles = 2 * np.pi * np.arange(FACETS) / FACETS
    inside = friction * np.cos(np.pi / FACETS)
    facets = np.column_stack([np.full(FACETS, -inside), np.cos(angles), np.sin(angles)])
    widened = np.kron(np.eye(contacts), np.full((FACETS, 1), -1.0))
    return np.asarray(np.hstack([np.kron(np.eye(contacts), facets), widened]), dtype=np.float64)


def _padded(rows: Array, contacts: int) -> Array:
    """Rows (N, k, 3n) with no part for the slacks, (N, k, 4n)."""
    return np.concatenate([rows, np.zeros((*rows.shape[:2], contacts))], axis=2)


def _wrench_units() -> Array:
    """(6, 1) units of a wrench's components."""
    return np.array([[1.0]] * 3 + [[LEVER_MM]] * 3)
