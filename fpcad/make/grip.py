"""Gaps between the contacting links and the turning tool, in numbers, for many states at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.model.geometry import HandGeometry
from fpcad.spec.pose import Turning
from fpcad.spec.tool import CylinderTool

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ContactLink:
    """A link that touches the tool."""

    finger: str
    link: str


@dataclass(frozen=True)
class Grip:
    """A hand that holds a tool in one pose; H stands still and the tool turns."""

    geometry: HandGeometry
    tool: CylinderTool
    turning: Turning
    hand_in_tool: Array
    """(6,): xyz [mm], roll pitch yaw [rad] of H in O before the tool turns."""
    contacts: tuple[ContactLink, ...]

    def tool_poses(self, angles: Array) -> tuple[Array, Rotation]:
        """Positions (N, 3) [mm] and N orientations in H of O turned by `angles` (N,) [rad]."""
        axis = np.array(self.turning.axis) / np.linalg.norm(self.turning.axis)
        pivot = np.array(self.turning.pivot_mm)
        turn = Rotation.from_rotvec(np.multiply.outer(angles, axis))
        roll, pitch, yaw = self.hand_in_tool[3:]
        R_palm_tool = Rotation.from_euler("ZYX", [yaw, pitch, roll]).inv()
        origin = pivot - turn.apply(pivot) - self.hand_in_tool[:3]
        return R_palm_tool.apply(origin), R_palm_tool * turn

    def gaps(self, joints: Array, angles: Array) -> Array:
        """Gap (N, n_contacts) [mm] between contacting capsules and the tool's cylinder.

        Args:
            joints: (N, 3 n_fingers) [rad], finger by finger.
            angles: (N,) tool angle [rad].
        """
        axes = [link_axis(self.geometry, contact, joints) for contact in self.contacts]
        radii = [self.geometry.radius_mm] * len(axes)
        return self._distances(axes, radii, angles)

    def clearances(self, joints: Array, angles: Array) -> Array:
        """Clearance (N, n) [mm] of the tool to every other link and to the palm's primitives."""
        others = [
            link
            for finger in self.geometry.fingers
            for link in (ContactLink(finger, "proximal"), ContactLink(finger, "distal"))
            if link not in self.contacts
        ]
        axes = [link_axis(self.geometry, link, joints) for link in others]
        shape = (len(joints), 3)
        axes += [
            (np.broadcast_to(s.start_mm, shape), np.broadcast_to(s.end_mm, shape))
            for s in self.geometry.palm
        ]
        radii = [self.geometry.radius_mm] * len(others)
        return self._distances(axes, radii + [s.radius_mm for s in self.geometry.palm], angles)

    def errors(self, joints: Array, angles: Array) -> Array:
        """How far each state (N,) [mm] is from contact where it should be and only there."""
        gap = np.abs(self.gaps(joints, angles)).max(axis=1)
        return np.maximum(gap, -self.clearances(joints, angles).min(axis=1))

    def _distances(
        self, axes: list[tuple[Array, Array]], radii: list[float], angles: Array
    ) -> Array:
        origin, orientation = self.tool_poses(angles)
        along = orientation.apply([1.0, 0.0, 0.0])
        back, tip = origin + self.tool.back_mm * along, origin + self.tool.tip_mm * along
        columns = [
            segment_distance(*axis, back, tip) - radius - self.tool.radius_mm
            for axis, radius in zip(axes, radii, strict=True)
        ]
        return np.stack(columns, axis=1)


def link_axis(geometry: HandGeometry, contact: ContactLink, joints: Array) -> tuple[Array, Array]:
    """Both ends (N, 3) [mm] in H of the axis of a link's capsule, for joints (N, 3 n_fingers)."""
    first = 3 * geometry.fingers.index(contact.finger)
    flexion, abduction, ip = joints[:, first : first + 3].T
    T_palm_root = geometry.T_palm_root[contact.finger]
    root = Rotation.from_matrix(T_palm_root[:3, :3])
    proximal = root * Rotation.from_euler("YZ", np.stack([flexion, abduction], axis=1))
    start = np.broadcast_to(T_palm_root[:3, 3], (len(joints), 3))
    ip_axis = start + proximal.apply([geometry.proximal_length_mm, 0.0, 0.0])
    if contact.link == "proximal":
        return start, ip_axis
    distal = proximal * Rotation.from_euler("y", ip[:, None])
    cylinder = geometry.distal_length_mm - geometry.radius_mm
    return ip_axis, ip_axis + distal.apply([cylinder, 0.0, 0.0])


def segment_distance(start_a: Array, end_a: Array, start_b: Array, end_b: Array) -> Array:
    """Distance (N,) of N pairs of segments with ends (N, 3), which may be points.

    The least distance is either between the two lines, where both feet lie on the segments, or from
    an end of one segment to the other segment.
    """
    a, b, offset = end_a - start_a, end_b - start_b, start_b - start_a
    aa, ab, bb = _dot(a, a), _dot(a, b), _dot(b, b)
    determinant = aa * bb - ab * ab
    parallel = determinant <= 1e-12 * aa * bb
    safe = np.where(parallel, 1.0, determinant)
    s = (_dot(a, offset) * bb - _dot(b, offset) * ab) / safe
    t = (_dot(a, offset) * ab - _dot(b, offset) * aa) / safe
    inside = ~parallel & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    between_lines = np.linalg.norm(offset + t[:, None] * b - s[:, None] * a, axis=1)
    from_ends = np.min(
        [
            _point_distance(start_a, start_b, end_b),
            _point_distance(end_a, start_b, end_b),
            _point_distance(start_b, start_a, end_a),
            _point_distance(end_b, start_a, end_a),
        ],
        axis=0,
    )
    return np.where(inside, between_lines, from_ends)


def _point_distance(point: Array, start: Array, end: Array) -> Array:
    along = end - start
    length = np.maximum(_dot(along, along), np.finfo(float).tiny)
    share = np.clip(_dot(point - start, along) / length, 0.0, 1.0)
    return np.linalg.norm(point - start - share[:, None] * along, axis=1)


def _dot(a: Array, b: Array) -> Array:
    return np.einsum("ij,ij->i", a, b)
