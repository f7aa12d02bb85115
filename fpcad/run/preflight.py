"""What is known before a port is opened: whether motors can do what a trajectory asks of the joints.

Positions, velocities and accelerations of joints were checked when the motion was planned. Here follow
those of the motors, for a box of joints is no box of motors, the torque that the motion takes, and whether
parts of the hand meet.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.run.errors import CollisionError, MotorLimitsError
from fpcad.run.hand_files import HandFiles
from fpcad.run.messages import Reason
from fpcad.run.motor_limits import first_motor_violation, motor_limits_of
from fpcad.run.quintic import Knots, evaluate
from fpcad.run.self_collision import nearest_meeting
from fpcad.run.urdf_chain import Chain, read_chain
from fpcad.spec.catalogue import motor
from fpcad.units import M_PER_MM

Array = NDArray[np.float64]

MEETING_M = 1e-4
"""Overlap of solids that counts as a collision: what a motion between two kept postures may do."""
_GRAVITY_M_S2 = 9.81
_QUANTITIES = {
    Reason.MOTOR_POSITION_LIMIT: ("position", "rad"),
    Reason.MOTOR_VELOCITY_LIMIT: ("velocity", "rad/s"),
    Reason.MOTOR_ACCELERATION_LIMIT: ("acceleration", "rad/s^2"),
}


def preflight(hand: HandFiles, knots: Knots) -> None:
    """Raise :class:`MotorLimitsError` or :class:`CollisionError` at the first thing that cannot be."""
    chain = read_chain(hand.urdf)
    require_motors(hand, knots)
    require_torque(hand, chain, knots)
    require_apart(hand, chain, knots)


def require_motors(hand: HandFiles, knots: Knots) -> None:
    """Position, velocity and acceleration of each motor, from end to end of each segment."""
    found = first_motor_violation(knots, hand.transmission, motor_limits_of(hand.limits))
    if found is not None:
        quantity, unit = _QUANTITIES[found.reason]
        raise MotorLimitsError(
            f"{hand.motors[found.joint]}: its {quantity} reaches {found.value:.4g} {unit} after "
            f"{found.time_s:.2f} s; allowed is {found.limit:.4g} {unit}; run it slower"
        )


def require_torque(hand: HandFiles, chain: Chain, knots: Knots) -> None:
    """Torque of each motor: a bound on weight and inertia in any orientation, plus the grip's."""
    through = np.abs(np.linalg.inv(hand.transmission.matrix.T))  # tau_m = A^-T tau_q
    moving = through @ joint_torque_bound(hand, chain, knots)
    needed = moving + preload_torque(hand, knots)
    limit = motor(hand.spec.motors.type).stall_torque_nm
    worst = int(needed.argmax())
    if needed[worst] > limit:
        raise MotorLimitsError(
            f"{hand.motors[worst]}: would need {needed[worst]:.2f} N m, and a {hand.spec.motors.type} "
            f"stalls at {limit:.2f}; grip less tightly, or take stronger motors"
        )


def require_apart(hand: HandFiles, chain: Chain, knots: Knots) -> None:
    """No two solids of the hand meet, at knots and in the middle between two."""
    time_s = motion_times(knots)
    found = nearest_meeting(chain, hand.limits.names, evaluate(knots, time_s).position)
    if found is not None and found.gap_m < -MEETING_M:
        raise CollisionError(
            f"{found.first} and {found.second} would meet after {time_s[found.row]:.2f} s, "
            f"{-1e3 * found.gap_m:.1f} mm deep; make the trajectory anew with `fpcad design`"
        )


def joint_torque_bound(hand: HandFiles, chain: Chain, knots: Knots) -> Array:
    """Torque (n,) [N m] that no instant of the motion exceeds, whichever way is down.

    A link's acceleration is at most the sum over the joints above it of arm times angular
    acceleration, and of arm times the square of all joints' speeds together.
    """
    names = hand.limits.names
    alpha, omega = np.abs(knots.acceleration).max(axis=0), np.abs(knots.velocity).max(axis=0)
    torque = np.zeros(len(names))
    for link, mass in chain.mass_kg.items():
        path = chain.above(link)
        reach = float(np.linalg.norm(chain.com_m[link]))
        arms: list[tuple[int, float]] = []
        for joint in reversed(path):
            if joint.axis is not None:
                arms.append((names.index(joint.name), reach))
            reach += float(np.linalg.norm(joint.T_parent[:3, 3]))
        spin = sum(omega[j] for j, _ in arms)
        speed_up = sum(arm * (alpha[j] + spin**2) for j, arm in arms)
        for j, arm in arms:
            torque[j] += mass * arm * (_GRAVITY_M_S2 + speed_up)
    return torque


def preload_torque(hand: HandFiles, knots: Knots) -> Array:
    """Largest torque (n,) [N m] of the motors when the fingers are kept from going to the grip's goals."""
    if knots.preload is None:
        return np.zeros(len(hand.motors))
    grip, spool_mm = hand.spec.grip, hand.spec.motors.transmission.spool_radius_mm
    stiffness = grip.tendon_stiffness_n / grip.tendon_length_mm * spool_mm**2 * M_PER_MM
    return stiffness * np.abs(knots.preload @ hand.transmission.matrix.T).max(axis=0)


def motion_times(knots: Knots) -> Array:
    """Times (M,) [s] that are looked at: every knot and the middle between two."""
    middles = (knots.time_s[1:] + knots.time_s[:-1]) / 2
    return np.sort(np.concatenate([knots.time_s, middles]))
