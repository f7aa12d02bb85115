"""A wielding path: the states that the hand passes while it turns the tool."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WieldingPath:
    """One pose's path, from its minus end through the pose to its plus end; N states."""

    pose: str
    tool_angle_rad: Array  # (N,) strictly increasing; exactly 0 at the pose
    joints_rad: Array  # (N, n_fingers, n_joints)
    contacts: Array  # (N, n_contacts, 4): tool axial [mm], tool angle, arc length [mm], finger angle
    hand_in_tool: Array  # (6,): xyz [mm], roll pitch yaw [rad] of H in O
    end_minus: str
    """Why the path ends where it does on the minus side."""
    end_plus: str
    """Why it ends on the plus side."""
