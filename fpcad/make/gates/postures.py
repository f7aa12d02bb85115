"""The postures that a hand must pass: at rest, at its poses, and along its trajectories."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.trajectory import ToolMotion, Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.hand import Hand
from fpcad.spec.templates import TEMPLATES
from fpcad.units import M_PER_MM, RAD_PER_DEG

Array = NDArray[np.float64]

STEP_RAD = 2.0 * RAD_PER_DEG
"""Between neighbouring postures no joint, nor the tool, turns by more."""


@dataclass(frozen=True)
class Postures:
    """Postures that a hand takes one after the other."""

    name: str
    joints: Array
    """(N, n_fingers, 3) [rad]."""
    tool: Array | None = None
    """(N, 4, 4) pose of the tool in H [mm]."""
    touching: frozenset[tuple[str, str]] = frozenset()
    """Finger and link of what touches the tool."""


def rest_joints(hand: Hand, geometry: HandGeometry) -> Array:
    """Joint angles (n_fingers, 3) [rad] of the spec's rest posture."""
    one = [hand.rest_posture_deg[joint] * RAD_PER_DEG for joint in TEMPLATES[hand.template].joints]
    return np.tile(one, (len(geometry.fingers), 1))


def hand_postures(
    hand: Hand, geometry: HandGeometry, trajectories: Mapping[str, Trajectory]
) -> list[Postures]:
    """At rest, then each pose with its tool, then each trajectory with its tool."""
    at_rest = Postures("at rest", rest_joints(hand, geometry)[None])
    along = [_along(name, trajectory, geometry) for name, trajectory in trajectories.items()]
    at_poses = [_at_pose(name, trajectory, geometry) for name, trajectory in trajectories.items()]
    return [at_rest, *at_poses, *along]


def _at_pose(name: str, trajectory: Trajectory, geometry: HandGeometry) -> Postures:
    return _of_knots(f"at {name}", trajectory, geometry, [0])


def _along(name: str, trajectory: Trajectory, geometry: HandGeometry) -> Postures:
    """From the plus end to the minus end: what comes before and after passes the same postures."""
    angle = trajectory.tool.angle_rad
    first, last = int(np.argmax(angle)), int(np.argmin(angle))
    if first > last:
        first, last = 0, len(angle) - 1
    kept = [first]
    turned = np.column_stack([trajectory.position_rad, angle])
    for knot in range(first + 1, last + 1):
        if np.abs(turned[min(knot + 1, last)] - turned[kept[-1]]).max() > STEP_RAD or knot == last:
            kept.append(knot)
    return _of_knots(f"along {name}", trajectory, geometry, kept)


def _of_knots(
    name: str, trajectory: Trajectory, geometry: HandGeometry, knots: list[int]
) -> Postures:
    joints = trajectory.position_rad[knots].reshape(len(knots), len(geometry.fingers), -1)
    touching = frozenset((contact.finger, contact.link) for contact in trajectory.contacts)
    return Postures(name, joints, _tool_poses(trajectory.tool, knots), touching)


def _tool_poses(tool: ToolMotion, knots: list[int]) -> Array:
    rows = tool.pose_palm[knots]
    poses = np.broadcast_to(np.eye(4), (len(rows), 4, 4)).copy()
    poses[:, :3, 3] = rows[:, :3] / M_PER_MM
    poses[:, :3, :3] = Rotation.from_quat(rows[:, 3:], scalar_first=True).as_matrix()
    return poses
