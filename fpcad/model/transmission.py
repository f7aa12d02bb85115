"""Tendon transmission: motor angles theta_m = A q + b, joint torques tau_q = A' tau_m.

Per finger, with rho = input pulley / spool radius, kappa = output / input pulley radius and
c1 = idler / spool radius: two motors turn the differential's input pulleys, alike for flexion and
opposed for abduction; the third pulls the IP joint, whose strands cross the MCP joint on idlers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.spec.catalogue import motor
from fpcad.spec.hardware import Transmission
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import NM_PER_NMM

Array = NDArray[np.float64]


def finger_transmission(transmission: Transmission) -> Array:
    """A (3, 3) of one finger [-]: motors m1, m2, m3 against flexion, abduction, IP flexion."""
    spool = transmission.spool_radius_mm
    rho = transmission.input_pulley_radius_mm / spool
    kappa = transmission.output_pulley_radius_mm / transmission.input_pulley_radius_mm
    c1, rho_ip = transmission.idler_radius_mm / spool, transmission.ip_pulley_radius_mm / spool
    return np.array([[rho, rho * kappa, 0.0], [rho, -rho * kappa, 0.0], [c1, 0.0, rho_ip]])


def hand_transmission(spec: Spec) -> Array:
    """A (n_u, n_u) of the whole hand [-], finger by finger."""
    fingers = TEMPLATES[spec.hand.template].fingers
    return np.kron(np.eye(len(fingers)), finger_transmission(spec.motors.transmission))


def single_axis_torque_nmm(spec: Spec) -> Array:
    """Torque (3,) [N mm] that a finger's motors give to one joint while the others carry none."""
    A = finger_transmission(spec.motors.transmission)
    limit = motor(spec.motors.type).continuous_torque_nm / NM_PER_NMM
    return limit / np.abs(np.linalg.inv(A.T)).max(axis=0)


def single_axis_speed_rad_s(spec: Spec) -> Array:
    """Speed (3,) [rad/s] of each joint of a finger while the others stand still, without load."""
    A = finger_transmission(spec.motors.transmission)
    return motor(spec.motors.type).no_load_speed_rad_s / np.abs(A).max(axis=0)
