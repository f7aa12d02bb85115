"""The forces of the grip along a path: one quadratic program over all its states."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import osqp
from numpy.typing import NDArray
from scipy import sparse

from fpcad.errors import MakeError
from fpcad.make.preload.touch import FORCE_AXES, Touch

Array = NDArray[np.float64]

FACETS = 16
"""Edges of the pyramid inside each friction cone; it holds 98 % of the cone."""
SLACK_PRICE = 1e3
"""Price [N] of a newton beyond the planned share of the cone: paid only where nothing else balances."""
TOLERANCE_N = 1e-3
MAX_ITERATIONS = 200_000
LEVER_MM = 30.0
"""Moments count in newtons at this lever, so that the program's rows are of one size."""
TORQUE_UNIT_NMM = 30.0
"""Motor torques count in newtons at this lever, for the same reason."""


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

    Args:
        touch: the contacts of N states.
        motor_torque: (N, n_motors, 3n) motor torques [N mm] for unit forces.
        demand: what the forces must do.

    Raises:
        MakeError: no forces balance within the motors' torque.
    """
    states, contacts = touch.points_mm.shape[:2]
    P, rows, low, high = _program(touch, motor_torque, demand)
    price = np.tile(np.repeat([0.0, SLACK_PRICE], [FORCE_AXES * contacts, contacts]), states)
    solver = osqp.OSQP()
    solver.setup(
        P, price, rows, low, high,
        eps_abs=TOLERANCE_N, eps_rel=0.0, max_iter=MAX_ITERATIONS, polishing=True, verbose=False,
    )  # fmt: skip
    found = solver.solve()
    if found.info.status != "solved":
        raise MakeError(
            f"no forces grip the tool within the motors' torque ({found.info.status}): lower "
            "grip.min_normal_force_n, or take stronger motors"
        )
    forces = found.x.reshape(states, -1)[:, : FORCE_AXES * contacts]
    return forces - balance_residual(touch, forces, demand.load)


def balance_residual(touch: Touch, forces: Array, load: Array) -> Array:
    """The least forces (N, 3n) [N] whose removal makes forces (N, 3n) balance the load (N, 6)."""
    grasp = touch.grasp_map / _wrench_units()
    missing = np.einsum("kij,kj->ki", grasp, forces) + load / _wrench_units()[:, 0]
    return np.einsum("kij,kj->ki", np.linalg.pinv(grasp), missing)


def _program(
    touch: Touch, motor_torque: Array, demand: GripDemand
) -> tuple[sparse.csc_matrix, sparse.csc_matrix, Array, Array]:
    """Hessian, rows and their bounds; variables are each state's forces, then its slacks."""
    states, contacts = touch.points_mm.shape[:2]
    forces = FORCE_AXES * contacts
    grasp = touch.grasp_map / _wrench_units()
    motor = motor_torque / TORQUE_UNIT_NMM
    blocks = [
        sparse.csc_matrix(np.vstack([_balance, _contact_rows(contacts, demand.friction), _motor]))
        for _balance, _motor in zip(_padded(grasp, contacts), _padded(motor, contacts), strict=True)
    ]
    limit = np.full(motor.shape[1], demand.motor_limit_nmm / TORQUE_UNIT_NMM)
    normal = np.repeat(demand.least_normal_n[:, None], contacts, axis=1)
    most = np.repeat(demand.most_normal_n[:, None], contacts, axis=1)
    low = np.concatenate([np.zeros(contacts), np.full(contacts * FACETS, -np.inf), -limit])
    high = np.concatenate([np.full(contacts, np.inf), np.zeros(contacts * FACETS), limit])
    balance = -demand.load / _wrench_units()[:, 0]
    lows = np.hstack([balance, normal, np.tile(low, (states, 1))]).ravel()
    highs = np.hstack([balance, most, np.tile(high, (states, 1))]).ravel()
    change = np.diff(np.eye(states), axis=0) * (demand.smoothing_rad / demand.spacing_rad)[:, None]
    over_path = sparse.csc_matrix(np.eye(states) + change.T @ change)
    kinds = sparse.diags(np.repeat([1.0, 0.0], [forces, contacts]))
    P = sparse.csc_matrix(sparse.triu(sparse.kron(over_path, kinds)))
    return P, sparse.csc_matrix(sparse.block_diag(blocks)), lows, highs


def _contact_rows(contacts: int, friction: float) -> Array:
    """Normal forces, slacks, and facets of the cones (n FACETS, 4n) that slacks widen."""
    angles = 2 * np.pi * np.arange(FACETS) / FACETS
    inside = friction * np.cos(np.pi / FACETS)
    facets = np.column_stack([np.full(FACETS, -inside), np.cos(angles), np.sin(angles)])
    cones = np.kron(np.eye(contacts), facets)
    widened = np.kron(np.eye(contacts), np.full((FACETS, 1), -1.0))
    normal = np.kron(np.eye(contacts), [[1.0, 0.0, 0.0]])
    none = np.zeros((contacts, contacts))
    rows = [[normal, none], [np.zeros_like(normal), np.eye(contacts)], [cones, widened]]
    return np.asarray(np.block(rows), dtype=np.float64)


def _padded(rows: Array, contacts: int) -> Array:
    """Rows (N, k, 3n) with no part for the slacks, (N, k, 4n)."""
    return np.concatenate([rows, np.zeros((*rows.shape[:2], contacts))], axis=2)


def _wrench_units() -> Array:
    """(6, 1) units of a wrench's components."""
    return np.array([[1.0]] * 3 + [[LEVER_MM]] * 3)
