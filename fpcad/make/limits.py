"""What a spec lets the joints of a trajectory do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.make.quintic import MotionLimits
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import RAD_PER_DEG

Array = NDArray[np.float64]


def motion_limits(spec: Spec, joint_speed_limit: Array) -> MotionLimits:
    """The spec's limits, and the motors' `joint_speed_limit` [rad/s], (n_joints,) or by fingers."""
    motors = np.asarray(joint_speed_limit, dtype=float).ravel()
    return MotionLimits(
        tool_speed=spec.motion.tool_speed_deg_s * RAD_PER_DEG,
        joint_speed=np.minimum(spec.motion.joint_speed_deg_s * RAD_PER_DEG, motors),
        joint_acceleration=np.full(
            motors.shape, spec.motion.joint_acceleration_deg_s2 * RAD_PER_DEG
        ),
        offset_speed=spec.motion.grip_speed_deg_s * RAD_PER_DEG,
    )


def joint_ranges(spec: Spec) -> Array:
    """(2, n_joints) least and greatest angles [rad], finger by finger."""
    names = TEMPLATES[spec.hand.template]
    one = np.array([spec.hand.joint_limits_deg[joint] for joint in names.joints]).T * RAD_PER_DEG
    return np.tile(one, len(names.fingers))
