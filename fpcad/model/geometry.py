"""One hand in numbers: what the parts, the description and the pictures are made from."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.frames import Frame
from fpcad.model.hand import HandTemplate

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PalmShape:
    """A palm primitive in H; a sphere has equal ends."""

    name: str
    start_mm: Array  # (3,)
    end_mm: Array  # (3,)
    radius_mm: float
    finger: str | None
    """Finger that roots in the primitive, if any."""


@dataclass(frozen=True)
class HandGeometry:
    """Dimensions and root frames of one hand design."""

    fingers: tuple[str, ...]
    radius_mm: float
    """Radius of all finger links, skin included."""
    proximal_length_mm: float
    """From the finger's root (both MCP axes) to the IP axis."""
    distal_length_mm: float
    """From the IP axis to the fingertip's apex."""
    T_palm_root: dict[str, Array]
    """(4, 4) pose [mm] of each finger's root frame in H."""
    palm: tuple[PalmShape, ...]


def hand_geometry(template: HandTemplate, design: Array) -> HandGeometry:
    """Numbers of the hand with design vector (n_d,) [mm, rad]."""
    d = ca.DM(design)
    proximal, distal = template.link_shape("proximal", d), template.link_shape("distal", d)
    roots = {f: homogeneous(template.root_frame(f, d)) for f in template.names.fingers}
    palm = tuple(
        PalmShape(s.name, _vector(s.start), _vector(s.end), s.radius, s.exempt_finger)
        for s in template.palm(d)
    )
    return HandGeometry(
        fingers=template.names.fingers,
        radius_mm=float(distal.radius),
        proximal_length_mm=float(proximal.axis_length),
        distal_length_mm=float(distal.axis_length + distal.radius),
        T_palm_root=roots,
        palm=palm,
    )


def link_poses(template: HandTemplate, design: Array, joints: Array) -> dict[str, dict[str, Array]]:
    """Pose (4, 4) [mm] in H of each link of each finger, for joints (n_fingers, n_joints) [rad]."""
    d, poses = ca.DM(design), {}
    for finger, u in zip(template.names.fingers, np.asarray(joints), strict=True):
        frames = template.link_frames(finger, d, ca.DM(u))
        poses[finger] = {link: homogeneous(frame) for link, frame in frames.items()}
    return poses


def homogeneous(frame: Frame) -> Array:
    """(4, 4) matrix of a numerical frame."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = np.array(ca.DM(frame.R)), _vector(frame.p)
    return matrix


def _vector(value: ca.DM) -> Array:
    return np.array(ca.DM(value)).reshape(-1)
