"""A URDF's chain of links as arrays: where links are at many postures, their solids and masses."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.run.errors import TrajectoryError
from fpcad.run.limits import parse_urdf

Array = NDArray[np.float64]

CAPSULE_MIDDLE = "_cylinder"
"""How the names of cylinders end that have a sphere at each end."""


@dataclass(frozen=True)
class Capsule:
    """All points within `radius_m` of a segment; a sphere where its ends are one."""

    link: str
    name: str
    start_m: Array  # (3,) in the link's frame
    end_m: Array  # (3,)
    radius_m: float


@dataclass(frozen=True)
class Block:
    """A box, or a disc that is taken as one: as a capsule it would reach far beyond its flat sides."""

    link: str
    name: str
    T_link: Array  # (4, 4) of its middle
    half_m: Array  # (3,)


@dataclass(frozen=True)
class Joint:
    """How a child link hangs on its parent."""

    name: str
    parent: str
    child: str
    T_parent: Array  # (4, 4) of the child at angle 0
    axis: Array | None  # (3,) in the child's frame, None where it is fixed


@dataclass(frozen=True)
class Chain:
    """Joints in an order in which parents come first."""

    root: str
    joints: tuple[Joint, ...]
    capsules: tuple[Capsule, ...]
    blocks: tuple[Block, ...]
    mass_kg: dict[str, float]
    com_m: dict[str, Array]

    def frames(self, names: tuple[str, ...], position_rad: Array) -> dict[str, Array]:
        """Poses (M, 4, 4) of all links in the root link at postures (M, n) of the named joints."""
        count = len(position_rad)
        frames = {self.root: np.broadcast_to(np.eye(4), (count, 4, 4))}
        for joint in self.joints:
            T = frames[joint.parent] @ joint.T_parent
            if joint.axis is not None:
                angle = position_rad[:, names.index(joint.name)]
                turn = np.broadcast_to(np.eye(4), (count, 4, 4)).copy()
                turn[:, :3, :3] = Rotation.from_rotvec(angle[:, None] * joint.axis).as_matrix()
                T = T @ turn
            frames[joint.child] = T
        return frames

    def above(self, link: str) -> list[Joint]:
        """Joints from the root down to a link."""
        by_child = {joint.child: joint for joint in self.joints}
        path = []
        while link in by_child:
            path.append(by_child[link])
            link = by_child[link].parent
        return path[::-1]


def read_chain(urdf: Path) -> Chain:
    """The chain of a URDF whose collision solids are cylinders, spheres and boxes."""
    root = parse_urdf(urdf)
    waiting = [_joint(element) for element in root.iter("joint")]
    children = {joint.child for joint in waiting}
    base = next((j.parent for j in waiting if j.parent not in children), "")
    order: list[Joint] = []
    known = {base}
    while waiting:
        ready = [joint for joint in waiting if joint.parent in known]
        if not ready:
            raise TrajectoryError(f"{urdf}: joint {waiting[0].name} hangs on nothing")
        order += ready
        known |= {joint.child for joint in ready}
        waiting = [joint for joint in waiting if joint not in ready]
    solids = [c for link in root.iter("link") for c in _solids(link, urdf)]
    masses = {link.get("name", ""): _mass(link) for link in root.iter("link")}
    return Chain(
        base,
        tuple(order),
        tuple(solid for solid in solids if isinstance(solid, Capsule)),
        tuple(solid for solid in solids if isinstance(solid, Block)),
        {name: mass for name, (mass, _) in masses.items()},
        {name: com for name, (_, com) in masses.items()},
    )


def _joint(element: Element) -> Joint:
    parent, child = element.find("parent"), element.find("child")
    assert parent is not None and child is not None, "a URDF joint has a parent and a child"
    axis = None
    if element.get("type") != "fixed":
        given = element.find("axis")
        axis = _numbers("1 0 0" if given is None else given.get("xyz", "1 0 0"))
        axis = axis / np.linalg.norm(axis)
    return Joint(
        element.get("name", ""),
        parent.get("link", ""),
        child.get("link", ""),
        _origin(element),
        axis,
    )


def _solids(link: Element, urdf: Path) -> list[Capsule | Block]:
    found: list[Capsule | Block] = []
    name = link.get("name", "")
    for solid in link.iter("collision"):
        T = _origin(solid)
        cylinder, sphere = solid.find("geometry/cylinder"), solid.find("geometry/sphere")
        block = _block_half(solid)
        if block is not None:
            found.append(Block(name, solid.get("name", ""), T, block))
            continue
        half = np.zeros(3)
        if cylinder is not None:
            half = T[:3, 2] * float(cylinder.get("length", "0")) / 2
            radius = float(cylinder.get("radius", "0"))
        elif sphere is not None:
            radius = float(sphere.get("radius", "0"))
        else:
            raise TrajectoryError(
                f"{urdf}: {name}: a collision solid is no cylinder, no sphere and no box"
            )
        centre = T[:3, 3]
        found.append(Capsule(name, solid.get("name", ""), centre - half, centre + half, radius))
    return found


def _block_half(solid: Element) -> Array | None:
    """Half extents (3,) [m] of a box, or of a cylinder that is flatter than a ball."""
    box, cylinder = solid.find("geometry/box"), solid.find("geometry/cylinder")
    if box is not None:
        return _numbers(box.get("size", "0 0 0")) / 2
    if cylinder is not None:
        half, radius = float(cylinder.get("length", "0")) / 2, float(cylinder.get("radius", "0"))
        if half < radius and not solid.get("name", "").endswith(CAPSULE_MIDDLE):
            return np.array([radius, radius, half])
    return None


def _mass(link: Element) -> tuple[float, Array]:
    inertial = link.find("inertial")
    mass = None if inertial is None else inertial.find("mass")
    if inertial is None or mass is None:
        return 0.0, np.zeros(3)
    return float(mass.get("value", "0")), _origin(inertial)[:3, 3]


def _origin(element: Element) -> Array:
    T, origin = np.eye(4), element.find("origin")
    if origin is not None:
        T[:3, 3] = _numbers(origin.get("xyz", "0 0 0"))
        rpy = _numbers(origin.get("rpy", "0 0 0"))
        T[:3, :3] = Rotation.from_euler("xyz", rpy).as_matrix()
    return T


def _numbers(text: str) -> Array:
    return np.array([float(part) for part in text.split()])
