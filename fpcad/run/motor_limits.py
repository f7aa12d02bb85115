"""What motors may do, beside what joints may: a box of joints is no box of motors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.acceptance import Violation, first_violation
from fpcad.run.limits import JointLimits
from fpcad.run.messages import Reason
from fpcad.run.quintic import Knots
from fpcad.run.transmission import Transmission, motor_type_of
from fpcad.spec.catalogue import motor, motor_types

Array = NDArray[np.float64]

TURN_RAD = 2 * np.pi
"""How far a motor may be turned from its zero, either way."""
NO_LOAD_SPEED_RAD_S = 4.71
"""Of motors that nobody named: an STS3215 at 12 V."""
ACCELERATION_RAD_S2 = 100.0
"""Far below what a servo's own rotor could do, far above what joints are allowed."""


@dataclass(frozen=True)
class MotorLimits:
    """Limits of n motors, in the order of the transmission's rows."""

    lower_rad: Array  # (n,)
    upper_rad: Array  # (n,)
    velocity_rad_s: Array  # (n,)
    acceleration_rad_s2: Array  # (n,)


def motor_limits_of(limits: JointLimits) -> MotorLimits:
    """Limits of the motors that the joints' configuration names, or of common servos."""
    name = motor_type_of(limits.configuration)
    speed = motor(name).no_load_speed_rad_s if name in motor_types() else NO_LOAD_SPEED_RAD_S
    return MotorLimits(
        *(np.full(len(limits.names), x) for x in (-TURN_RAD, TURN_RAD, speed, ACCELERATION_RAD_S2))
    )


def first_motor_violation(
    knots: Knots, transmission: Transmission, motors: MotorLimits
) -> Violation | None:
    """First segment of joint knots (N, n) in which a motor leaves its limits, if any.

    `joint` of the answer is the motor's number.
    """
    matrix = transmission.matrix.T
    turned = Knots(
        knots.time_s,
        knots.position @ matrix + transmission.offset_rad,
        knots.velocity @ matrix,
        knots.acceleration @ matrix,
    )
    count = len(motors.velocity_rad_s)
    box = JointLimits(
        tuple(map(str, range(count))),
        motors.lower_rad,
        motors.upper_rad,
        motors.velocity_rad_s,
        motors.acceleration_rad_s2,
    )
    # A count in each joint is more than one in a motor.
    found = first_violation(turned, box, 1 + np.abs(transmission.matrix).sum(axis=1))
    if found is None:
        return None
    return Violation(
        MOTOR_REASON[found.reason], found.joint, found.time_s, found.value, found.limit
    )


MOTOR_REASON = {
    Reason.POSITION_LIMIT: Reason.MOTOR_POSITION_LIMIT,
    Reason.VELOCITY_LIMIT: Reason.MOTOR_VELOCITY_LIMIT,
    Reason.ACCELERATION_LIMIT: Reason.MOTOR_ACCELERATION_LIMIT,
}
