"""Poses and primitive shapes as URDF elements. All lengths in m, angles in rad."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def vector_text(values: Iterable[float]) -> str:
    """Numbers with full precision, one space apart; -0.0 is written as 0.0."""
    return " ".join(repr(float(value) + 0.0) for value in values)


def roll_pitch_yaw(R: Array) -> Array:
    """Angles (3,) with R = Rz(yaw) Ry(pitch) Rx(roll), exact at pitch = +-90 deg too."""
    yaw = math.atan2(R[1, 0], R[0, 0])
    c, s = math.cos(yaw), math.sin(yaw)
    unyawed = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ R
    pitch = math.atan2(-R[2, 0], unyawed[0, 0])
    roll = math.atan2(-unyawed[1, 2], unyawed[1, 1])
    return np.array([roll, pitch, yaw])


def pose_along(position: Array, z_axis: Array | None = None) -> Array:
    """Pose (4, 4) at a position, with its z along a unit vector if one is given."""
    pose = np.eye(4)
    pose[:3, 3] = position
    if z_axis is not None:
        helper = np.eye(3)[int(np.argmin(np.abs(z_axis)))]
        x_axis = np.cross(helper, z_axis)
        x_axis /= np.linalg.norm(x_axis)
        pose[:3, :3] = np.column_stack([x_axis, np.cross(z_axis, x_axis), z_axis])
    return pose


def origin_element(parent: ET.Element, pose: Array) -> None:
    """An `origin` with the pose (4, 4)."""
    ET.SubElement(
        parent,
        "origin",
        xyz=vector_text(pose[:3, 3]),
        rpy=vector_text(roll_pitch_yaw(pose[:3, :3])),
    )


def capsule_collision(link: ET.Element, name: str, start: Array, end: Array, radius: float) -> None:
    """Collision elements that make up a capsule: URDF has none, so a cylinder and two spheres.

    A capsule whose ends coincide is one sphere.
    """
    length = float(np.linalg.norm(end - start))
    if length == 0.0:
        _sphere(link, name, start, radius)
        return
    cylinder_collision(link, f"{name}_cylinder", start, end, radius)
    _sphere(link, f"{name}_start", start, radius)
    _sphere(link, f"{name}_end", end, radius)


def cylinder_collision(
    link: ET.Element, name: str, start: Array, end: Array, radius: float
) -> None:
    """A collision element with flat ends at two points."""
    length = float(np.linalg.norm(end - start))
    middle = pose_along((start + end) / 2, (end - start) / length)
    cylinder = _collision(link, name, middle)
    ET.SubElement(cylinder, "cylinder", radius=repr(float(radius)), length=repr(length))


def box_collision(link: ET.Element, name: str, pose: Array, size: Array) -> None:
    """A box of a size (3,) about its middle, which stands at a pose (4, 4)."""
    ET.SubElement(_collision(link, name, pose), "box", size=vector_text(size))


def _sphere(link: ET.Element, name: str, centre: Array, radius: float) -> None:
    sphere = _collision(link, name, pose_along(centre))
    ET.SubElement(sphere, "sphere", radius=repr(float(radius)))


def _collision(link: ET.Element, name: str, pose: Array) -> ET.Element:
    collision = ET.SubElement(link, "collision", name=name)
    origin_element(collision, pose)
    return ET.SubElement(collision, "geometry")
