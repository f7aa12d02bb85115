"""Where the hand touches the tool, and how the joints move the touching points; many states at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.grip import Grip, link_axis
from fpcad.model.geometry import HandGeometry

Array = NDArray[np.float64]

FORCE_AXES = 3
"""Components of a contact force: along the normal, along the tool, around it."""


@dataclass(frozen=True)
class Touch:
    """All contacts of N states in H; n contacts, n_u joints."""

    points_mm: Array
    """(N, n, 3) on the tool's surface."""
    axes: Array
    """(N, n, 3, 3) columns: direction in which the finger presses, then two tangents."""
    jacobians_mm: Array
    """(N, n, 3, n_u) of the links' material points [mm/rad]."""
    joint_axes: Array
    """(N, n_u, 3) directions of the joints' axes."""
    centre_mm: Array
    """(N, 3) centre of the tool's axis."""

    @property
    def torque_map(self) -> Array:
        """(N, n_u, 3n) joint torques [N mm] for contact forces on the tool, in the contacts' axes."""
        torque = np.einsum("knij,knia->kjna", self.jacobians_mm, self.axes)
        return torque.reshape(*torque.shape[:2], -1)

    @property
    def grasp_map(self) -> Array:
        """(N, 6, 3n) wrench on the tool, force [N] over moment about `centre_mm` [N mm].

        Murray, Li, Sastry (1994), eq. 5.6.
        """
        arms = self.points_mm - self.centre_mm[:, None]
        moments = np.cross(arms[:, :, None], np.swapaxes(self.axes, 2, 3))  # (N, n, axis, 3)
        both = np.concatenate([self.axes, np.swapaxes(moments, 2, 3)], axis=2)  # (N, n, 6, 3)
        return np.moveaxis(both, 1, 2).reshape(len(both), 6, -1)


def touch(grip: Grip, joints: Array, angles: Array) -> Touch:
    """The contacts of states in contact.

    Args:
        grip: hand, tool, and which links touch.
        joints: (N, n_u) [rad], finger by finger.
        angles: (N,) tool angle [rad].
    """
    origin, orientation = grip.tool_poses(angles)
    along = orientation.apply([1.0, 0.0, 0.0])
    back, tip = origin + grip.tool.back_mm * along, origin + grip.tool.tip_mm * along
    turning = {f: joint_axes(grip.geometry, f, joints) for f in grip.geometry.fingers}
    points, axes, jacobians = [], [], []
    for contact in grip.contacts:
        start, end = link_axis(grip.geometry, contact, joints)
        on_link, on_tool = nearest_points(start, end, back, tip)
        push = on_tool - on_link
        push /= np.linalg.norm(push, axis=1)[:, None]
        lengthwise = along - np.einsum("ij,ij->i", along, push)[:, None] * push
        lengthwise /= np.linalg.norm(lengthwise, axis=1)[:, None]
        points.append(on_tool - grip.tool.radius_mm * push)
        axes.append(np.stack([push, lengthwise, np.cross(push, lengthwise)], axis=2))
        first = 3 * grip.geometry.fingers.index(contact.finger)
        moving = turning[contact.finger][: 3 if contact.link == "distal" else 2]
        jacobians.append(_jacobian(moving, first, points[-1], joints.shape[1]))
    return Touch(
        np.stack(points, axis=1),
        np.stack(axes, axis=1),
        np.stack(jacobians, axis=1),
        np.stack([axis for finger in turning.values() for axis, _ in finger], axis=1),
        (back + tip) / 2,
    )


def _jacobian(moving: list[tuple[Array, Array]], first: int, points: Array, n_u: int) -> Array:
    """Velocity (N, 3, n_u) [mm/rad] of points (N, 3) that joints `first`, `first` + 1 ... move."""
    jacobian = np.zeros((len(points), 3, n_u))
    for number, (axis, at) in enumerate(moving):
        jacobian[:, :, first + number] = np.cross(axis, points - at)
    return jacobian


def joint_axes(geometry: HandGeometry, finger: str, joints: Array) -> list[tuple[Array, Array]]:
    """Direction (N, 3) and a point (N, 3) [mm] of each joint axis of a finger in H."""
    first = 3 * geometry.fingers.index(finger)
    T_palm_root = geometry.T_palm_root[finger]
    root = Rotation.from_matrix(T_palm_root[:3, :3])
    start = np.broadcast_to(T_palm_root[:3, 3], (len(joints), 3))
    flexed = root * Rotation.from_euler("y", joints[:, first, None])
    proximal = flexed * Rotation.from_euler("z", joints[:, first + 1, None])
    ip_axis = start + proximal.apply([geometry.proximal_length_mm, 0.0, 0.0])
    flexion = np.broadcast_to(root.apply([0.0, 1.0, 0.0]), start.shape)
    return [
        (flexion, start),
        (flexed.apply([0.0, 0.0, 1.0]), start),
        (proximal.apply([0.0, 1.0, 0.0]), ip_axis),
    ]


def nearest_points(
    start_a: Array, end_a: Array, start_b: Array, end_b: Array
) -> tuple[Array, Array]:
    """The points (N, 3) of N pairs of segments, not parallel, that are nearest to each other."""
    a, b, offset = end_a - start_a, end_b - start_b, start_b - start_a
    aa, ab, bb = (np.einsum("ij,ij->i", *pair) for pair in ((a, a), (a, b), (b, b)))
    ao, bo = np.einsum("ij,ij->i", a, offset), np.einsum("ij,ij->i", b, offset)
    s = np.clip((ao * bb - bo * ab) / (aa * bb - ab * ab), 0.0, 1.0)
    t = np.clip((s * ab - bo) / bb, 0.0, 1.0)
    s = np.clip((t * ab + ao) / aa, 0.0, 1.0)  # with t at an end, s is not yet its nearest point
    return start_a + s[:, None] * a, start_b + t[:, None] * b
