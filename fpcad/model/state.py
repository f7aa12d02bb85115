"""Pose states in numbers: between the spec's words and the solvers' vectors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.model.pose import CONTACT_SIZE, StateLayout
from fpcad.spec.pose import InitialPose
from fpcad.spec.templates import TemplateNames
from fpcad.units import RAD_PER_DEG

Array = NDArray[np.float64]


def pose_state(initial: InitialPose, names: TemplateNames) -> Array:
    """State vector y [mm, rad] of a pose that a spec gives in words."""
    joints = np.concatenate([initial.joints_deg[finger] for finger in names.fingers])
    contacts = [
        (c.axial_mm, c.angle_deg * RAD_PER_DEG, c.arclength_mm, c.finger_angle_deg * RAD_PER_DEG)
        for c in initial.contacts
    ]
    hand = np.concatenate(
        [initial.hand_position_mm, np.array(initial.hand_rotation_deg) * RAD_PER_DEG]
    )
    return np.concatenate([hand, joints * RAD_PER_DEG, np.array(contacts).ravel()])


def state_columns(pose: str, names: TemplateNames, layout: StateLayout) -> list[str]:
    """Names of a state's entries in tables: units in the suffix, `pose.` in front."""
    hand = [
        "hand_x_mm",
        "hand_y_mm",
        "hand_z_mm",
        "hand_roll_rad",
        "hand_pitch_rad",
        "hand_yaw_rad",
    ]
    joints = [f"{finger}_{joint}_rad" for finger in names.fingers for joint in names.joints]
    kinds = ("tool_axial_mm", "tool_angle_rad", "arclength_mm", "finger_angle_rad")
    contacts = [
        f"contact{i}_{kinds[k]}" for i in range(layout.n_contacts) for k in range(CONTACT_SIZE)
    ]
    return [f"{pose}.{column}" for column in hand + joints + contacts]
