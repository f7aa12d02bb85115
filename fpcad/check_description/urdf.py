"""A URDF as it is written: nothing is repaired, and what is there twice is kept twice."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.check_description.shapes import Shape

Array = NDArray[np.float64]
FindMesh = Callable[[str], Path]


class UnreadableError(Exception):
    """A file that cannot be read as what it is; the message tells what and where."""


@dataclass(frozen=True)
class Inertial:
    """Mass [kg], centre [m] and inertia [kg m^2] about it, along the link's axes."""

    mass: float
    centre: Array  # (3,)
    tensor: Array  # (3, 3)


@dataclass(frozen=True)
class Link:
    """A rigid body."""

    name: str
    inertial: Inertial | None
    visuals: tuple[Shape, ...]
    collisions: tuple[Shape, ...]


@dataclass(frozen=True)
class Limit:
    """Hard limits in SI units; nan where nothing is said."""

    lower: float
    upper: float
    effort: float
    velocity: float
    soft: tuple[float, float] | None


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint between two links."""

    name: str
    type: str
    parent: str
    child: str
    pose: Array  # (4, 4) [m]
    axis: Array  # (3,)
    limit: Limit | None
    mimics: str | None

    @property
    def is_moving(self) -> bool:
        """Whether it has a degree of freedom."""
        return self.type != "fixed"


@dataclass(frozen=True)
class Urdf:
    """A robot."""

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]

    def moving(self) -> list[Joint]:
        """Joints with a degree of freedom."""
        return [joint for joint in self.joints if joint.is_moving]


def read_urdf(text: str, find_mesh: FindMesh) -> Urdf:
    """Read a URDF; :class:`UnreadableError` where it is none.

    Args:
        text: the XML.
        find_mesh: the file that a mesh's name stands for.
    """
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise UnreadableError(f"not XML: {error}") from error
    if root.tag != "robot":
        raise UnreadableError(f"the root is <{root.tag}>, not <robot>")
    links = tuple(_link(element, find_mesh) for element in root.findall("link"))
    joints = tuple(_joint(element) for element in root.findall("joint"))
    return Urdf(root.get("name", ""), links, joints)


def _link(element: ET.Element, find_mesh: FindMesh) -> Link:
    where, body = f"link {element.get('name', '')}", element.find("inertial")
    return Link(
        name=element.get("name", ""),
        inertial=None if body is None else _inertial(body, where),
        visuals=tuple(_shape(e, where, find_mesh) for e in element.findall("visual")),
        collisions=tuple(_shape(e, where, find_mesh) for e in element.findall("collision")),
    )


def _inertial(element: ET.Element, where: str) -> Inertial:
    pose, tensor = _pose(element.find("origin"), where), np.zeros((3, 3))
    entries = _child(element, "inertia", where)
    for i in range(3):
        for j in range(i, 3):
            tensor[i, j] = tensor[j, i] = _number(entries, f"i{'xyz'[i]}{'xyz'[j]}", where)
    R = pose[:3, :3]
    return Inertial(
        _number(_child(element, "mass", where), "value", where), pose[:3, 3], R @ tensor @ R.T
    )


def _shape(element: ET.Element, where: str, find_mesh: FindMesh) -> Shape:
    geometry, pose = _child(element, "geometry", where), _pose(element.find("origin"), where)
    if len(geometry) != 1:
        raise UnreadableError(f"{where}: a geometry holds one shape, not {len(geometry)}")
    shape = geometry[0]
    if shape.tag == "mesh":
        scale = _vector(shape, "scale", where, (1.0, 1.0, 1.0))
        return Shape("mesh", pose, tuple(scale), find_mesh(shape.get("filename", "")))
    if shape.tag == "box":
        return Shape("box", pose, tuple(_vector(shape, "size", where)))
    if shape.tag in ("cylinder", "capsule"):
        size = _number(shape, "radius", where), _number(shape, "length", where)
        return Shape(shape.tag, pose, size)
    if shape.tag == "sphere":
        return Shape("sphere", pose, (_number(shape, "radius", where),))
    raise UnreadableError(f"{where}: no shape is called <{shape.tag}>")


def _joint(element: ET.Element) -> Joint:
    where = f"joint {element.get('name', '')}"
    axis, mimic = element.find("axis"), element.find("mimic")
    return Joint(
        name=element.get("name", ""),
        type=element.get("type", ""),
        parent=_child(element, "parent", where).get("link", ""),
        child=_child(element, "child", where).get("link", ""),
        pose=_pose(element.find("origin"), where),
        axis=np.array([1.0, 0.0, 0.0]) if axis is None else _vector(axis, "xyz", where),
        limit=_limit(element, where),
        mimics=None if mimic is None else mimic.get("joint", ""),
    )


def _limit(element: ET.Element, where: str) -> Limit | None:
    limit, soft = element.find("limit"), element.find("safety_controller")
    if limit is None:
        return None
    inside = None
    if soft is not None and "soft_lower_limit" in soft.attrib:
        ends = (_number(soft, f"soft_{end}_limit", where) for end in ("lower", "upper"))
        inside = next(ends), next(ends)
    return Limit(
        lower=_number(limit, "lower", where, math.nan),
        upper=_number(limit, "upper", where, math.nan),
        effort=_number(limit, "effort", where, math.nan),
        velocity=_number(limit, "velocity", where, math.nan),
        soft=inside,
    )


def _pose(origin: ET.Element | None, where: str) -> Array:
    pose = np.eye(4)
    if origin is not None:
        zero = (0.0, 0.0, 0.0)
        pose[:3, 3] = _vector(origin, "xyz", where, zero)
        angles = _vector(origin, "rpy", where, zero)
        pose[:3, :3] = Rotation.from_euler("xyz", angles).as_matrix()
    return pose


def _child(element: ET.Element, tag: str, where: str) -> ET.Element:
    child = element.find(tag)
    if child is None:
        raise UnreadableError(f"{where}: <{element.tag}> lacks <{tag}>")
    return child


def _number(element: ET.Element, key: str, where: str, default: float | None = None) -> float:
    text = element.get(key)
    if text is None and default is not None:
        return default
    try:
        value = float(text or "")
    except ValueError:
        raise UnreadableError(f"{where}: {key}={text!r} of <{element.tag}> is no number") from None
    if not math.isfinite(value):
        raise UnreadableError(f"{where}: {key}={text!r} of <{element.tag}> is not finite")
    return value


def _vector(
    element: ET.Element, key: str, where: str, default: tuple[float, ...] | None = None
) -> Array:
    text = element.get(key)
    if text is None and default is not None:
        return np.array(default)
    try:
        values = np.array([float(word) for word in (text or "").split()])
    except ValueError:
        values = np.array([np.nan])
    if values.shape != (3,) or not np.all(np.isfinite(values)):
        raise UnreadableError(f"{where}: {key}={text!r} of <{element.tag}> is not three numbers")
    return values
