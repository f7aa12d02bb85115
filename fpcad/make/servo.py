"""What a servo does between its target and its torque, estimated from its catalogue row."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fpcad.spec.catalogue import Motor

PROPORTIONAL_BAND_RAD = math.radians(5.0)
"""Error at which a servo gives its stall torque. An estimate [ours], until a calibration tells."""
TIME_CONSTANT_S = 0.04
"""Time in which an unloaded motor reaches 63 % of its speed. An estimate [ours], as above."""


@dataclass(frozen=True)
class Servo:
    """A position servo at its output shaft: torque = stiffness * error - damping * speed, limited."""

    torque_nm: float
    """Largest torque that it can hold for long."""
    stiffness_nm_rad: float
    damping_nms_rad: float
    inertia_kgm2: float
    """Rotor and gears, as felt at the shaft."""

    def behind_tendon(self, stiffness_nm_rad: float) -> Servo:
        """The same servo with its tendon as one: softer, and as quick to follow its target.

        Damping and inertia shrink with the stiffness, for what follows the target is the rotor,
        which does not feel how soft the tendon is that it pulls.
        """
        share = stiffness_nm_rad / self.stiffness_nm_rad
        return Servo(
            self.torque_nm,
            stiffness_nm_rad,
            share * self.damping_nms_rad,
            share * self.inertia_kgm2,
        )


def servo_of(row: Motor) -> Servo:
    """Estimate from stall torque and no-load speed.

    The slope from stall to no load is the damping by the motor's own voltage, and with the time
    constant it gives the inertia. The servo adds damping until its shaft alone settles without
    overshoot.
    """
    own_damping = row.stall_torque_nm / row.no_load_speed_rad_s
    stiffness = row.stall_torque_nm / PROPORTIONAL_BAND_RAD
    inertia = own_damping * TIME_CONSTANT_S
    critical = 2.0 * math.sqrt(stiffness * inertia)
    return Servo(row.continuous_torque_nm, stiffness, max(own_damping, critical), inertia)
