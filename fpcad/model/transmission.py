"""How the motors' spools act on the joints: theta_m = A q, tau_q = A^T tau_m. docs/model.md."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.spec.hardware import Transmission

Array = NDArray[np.float64]


def finger_transmission(routing: Transmission) -> Array:
    """Matrix A (3, 3) [-] of one finger: motor turns (m1, m2, m3) per joint turns, root outwards.

    m1 and m2 drive the differential: alike they flex the MCP joint, opposed they abduct it. m3
    drives the IP joint by strands that cross the MCP joint on idlers, so flexion turns it too.
    """
    rho = routing.input_pulley_radius_mm / routing.spool_radius_mm
    kappa = routing.output_pulley_radius_mm / routing.input_pulley_radius_mm
    crossing = routing.idler_radius_mm / routing.spool_radius_mm
    rho_ip = routing.ip_pulley_radius_mm / routing.spool_radius_mm
    rows = [[rho, rho * kappa, 0.0], [rho, -rho * kappa, 0.0], [crossing, 0.0, rho_ip]]
    return np.array(rows, dtype=np.float64)


def hand_transmission(routing: Transmission, n_fingers: int) -> Array:
    """Matrix A (3 n, 3 n) [-] of a hand of n fingers alike, finger by finger."""
    return np.kron(np.eye(n_fingers), finger_transmission(routing)).astype(np.float64)


def motor_angles(A: Array, joints: Array) -> Array:
    """Motor angles (..., n) [rad] for joint angles (..., n) [rad]; both are zero together."""
    return joints @ A.T


def joint_torques(A: Array, motor_torques: Array) -> Array:
    """Joint torques (..., n) for motor torques (..., n), in the same unit: tau_q = A^T tau_m."""
    return motor_torques @ A


def motor_torques(A: Array, joint_torques: Array) -> Array:
    """Motor torques (..., n) that hold joint torques (..., n), in the same unit."""
    return np.asarray(np.linalg.solve(A.T, joint_torques[..., None])[..., 0], dtype=np.float64)


def single_axis_torque_limits(A: Array, motor_torque: float) -> Array:
    """Largest torque (n,) of each joint while the others carry none, for motors alike.

    Joints share motors, so no box of joint torques is exact: this is what one joint can do alone.
    """
    return motor_torque / np.abs(np.linalg.inv(A.T)).max(axis=0)


def single_axis_speed_limits(A: Array, motor_speed: float) -> Array:
    """Largest speed (n,) of each joint while the others stand still, for motors alike."""
    return motor_speed / np.abs(A).max(axis=0)
