"""Hand and tool as capsules in the stand's frame, at a pose and with its fingers opened a little."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.gates.postures import hand_postures
from fpcad.make.grip import ContactLink, link_axis
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import RAD_PER_DEG

Array = NDArray[np.float64]

OPENED_DEG = 12.0
"""How far every flexion joint is opened from a pose while the tool is put in, as its limits allow."""
OPENING = (0.0, 0.5, 1.0)
ABDUCTION = "abd"


@dataclass(frozen=True)
class Capsules:
    """Capsules [mm] in one frame."""

    starts: Array  # (n, 3)
    ends: Array  # (n, 3)
    radii: Array  # (n,)


@dataclass(frozen=True)
class PoseScene:
    """What a jig has to do with at one pose, in the stand's frame [mm]."""

    pose: str
    obstacles: Capsules
    """Links at the pose, half opened and opened, and the palm's primitives."""
    T_stand_tool: Array  # (4, 4)
    joints: tuple[Array, ...]
    """Joint angles (n_fingers, 3) [rad]: at the pose, half opened, opened."""


def stand_frame(T_palm_base: Array) -> Array:
    """T_palm_stand (4, 4): x from the base's face to the hand, z up, which is the base's y."""
    axes = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
    pose = np.eye(4)
    pose[:3, :3] = T_palm_base[:3, :3] @ axes
    pose[:3, 3] = T_palm_base[:3, 3]
    return pose


def pose_scene(
    spec: Spec, geometry: HandGeometry, pose: str, trajectory: Trajectory, T_palm_stand: Array
) -> PoseScene:
    """The scene at the first knot of a trajectory."""
    at = hand_postures(spec.hand, geometry, {pose: trajectory})[1]
    assert at.tool is not None
    closed = at.joints[0]
    joints = tuple(opened(spec, closed, share) for share in OPENING)
    T_stand_palm = np.asarray(np.linalg.inv(T_palm_stand), dtype=np.float64)
    radius = geometry.radius_mm + spec.print.skin_oversize_mm
    starts, ends, radii = [], [], []
    for finger in geometry.fingers:
        for link in ("proximal", "distal"):
            rows = np.stack(joints).reshape(len(joints), -1)
            a, b = link_axis(geometry, ContactLink(finger, link), rows)
            starts.extend(a)
            ends.extend(b)
            radii.extend([radius] * len(joints))
    for shape in geometry.palm:
        starts.append(shape.start_mm)
        ends.append(shape.end_mm)
        radii.append(shape.radius_mm)
    starts, ends = (moved(T_stand_palm, np.array(points)) for points in (starts, ends))
    return PoseScene(
        pose, Capsules(starts, ends, np.array(radii)), T_stand_palm @ at.tool[0], joints
    )


def opened(spec: Spec, joints: Array, share: float) -> Array:
    """Joints (n_fingers, n) [rad] with a share of the opening, which ends at the joints' limits."""
    names = TEMPLATES[spec.hand.template].joints
    less = np.array(
        [0.0 if name.endswith(ABDUCTION) else share * OPENED_DEG * RAD_PER_DEG for name in names]
    )
    low = np.array([spec.hand.joint_limits_deg[name][0] * RAD_PER_DEG for name in names])
    return np.maximum(joints - less, np.minimum(low, joints))


def moved(T: Array, points: Array) -> Array:
    """Points (n, 3) moved by a pose (4, 4)."""
    return points @ T[:3, :3].T + T[:3, 3]
