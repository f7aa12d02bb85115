"""What is known before a port is opened: whether joints and motors can do what a trajectory asks."""

from __future__ import annotations

import numpy as np

from fpcad.run.errors import MotorLimitsError
from fpcad.run.hand_files import HandFiles
from fpcad.run.messages import Reason
from fpcad.run.motor_limits import first_motor_violation, motor_limits_of
from fpcad.run.quintic import Knots

_QUANTITIES = {
    Reason.MOTOR_POSITION_LIMIT: ("position", "rad"),
    Reason.MOTOR_VELOCITY_LIMIT: ("velocity", "rad/s"),
    Reason.MOTOR_ACCELERATION_LIMIT: ("acceleration", "rad/s^2"),
}


def preflight(hand: HandFiles, knots: Knots) -> None:
    """Raise where motors cannot follow; joints were checked when the motion was planned."""
    require_motors(hand, knots)


def require_motors(hand: HandFiles, knots: Knots) -> None:
    """Raise :class:`MotorLimitsError` where any instant of the motion asks too much of a motor."""
    found = first_motor_violation(knots, hand.transmission, motor_limits_of(hand.limits))
    if found is not None:
        quantity, unit = _QUANTITIES[found.reason]
        raise MotorLimitsError(
            f"{hand.motors[found.joint]}: its {quantity} reaches {found.value:.4g} {unit} after "
            f"{found.time_s:.2f} s; allowed is {found.limit:.4g} {unit}; run it slower"
        )


def motion_times(knots: Knots) -> np.ndarray:
    """Times (M,) [s] that are looked at: every knot and the middle between two."""
    middles = (knots.time_s[1:] + knots.time_s[:-1]) / 2
    return np.sort(np.concatenate([knots.time_s, middles]))
