"""A wielding path: the states that the hand passes while it turns the tool."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.model.pose import CONTACT_SIZE, StateLayout
from fpcad.wield.trace import Trace

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WieldingPath:
    """One pose's path, from its minus end through the pose to its plus end; N states."""

    pose: str
    tool_angle_rad: Array  # (N,) strictly increasing; exactly 0 at the pose
    joints_rad: Array  # (N, n_fingers, n_joints)
    contacts: (
        Array  # (N, n_contacts, 4): tool axial [mm], tool angle, arc length [mm], finger angle
    )
    torque_nmm: Array  # (N,) least largest joint torque against the tip force
    tip_force_n: Array  # (N,) largest tip force within the motors' continuous torque
    hand_in_tool: Array  # (6,): xyz [mm], roll pitch yaw [rad] of H in O
    end_minus: str
    """Why the path ends where it does on the minus side."""
    end_plus: str
    """Why it ends on the plus side."""


def join_traces(
    pose: str, layout: StateLayout, hand: Array, minus: Trace, plus: Trace
) -> WieldingPath:
    """One path from the two directions; both begin with the same state, the pose itself."""
    states = [*reversed(minus.states), *plus.states[1:]]
    torque = [state.torque_nmm for state in states]
    force = [state.tip_force_n for state in states]
    at_pose = len(minus.states) - 1
    torque[at_pose] = max(torque[at_pose], plus.states[0].torque_nmm)
    force[at_pose] = min(force[at_pose], plus.states[0].tip_force_n)
    x = np.array([state.x for state in states])
    return WieldingPath(
        pose=pose,
        tool_angle_rad=np.array([state.turn for state in states]),
        joints_rad=x[:, : layout.n_u].reshape(len(x), layout.n_fingers, layout.n_joints),
        contacts=x[:, layout.n_u :].reshape(len(x), layout.n_contacts, CONTACT_SIZE),
        torque_nmm=np.array(torque),
        tip_force_n=np.array(force),
        hand_in_tool=hand,
        end_minus=minus.end.value,
        end_plus=plus.end.value,
    )
