"""Meshes that exist and have a robot's size, and collision shapes where there is something to hit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fpcad.check_description.check import Fault
from fpcad.check_description.package import Package
from fpcad.check_description.shapes import Shape
from fpcad.check_description.urdf import Link, Urdf

SIZE_M = (5e-4, 3.0)
"""Plausible size of a link."""
SIZE_RATIO = 4.0
"""Largest ratio of the sizes of what is seen and what is touched of a link."""
SLACK_M = 1e-4
"""How far a mesh may stand out of the shape that covers it."""


def meshes(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Meshes that are missing or cannot be read."""
    for link in robot.links:
        for shape in (*link.visuals, *link.collisions):
            try:
                triangles = len(shape.mesh.faces)
            except ValueError as error:
                yield Fault(f"link {link.name}", str(error))
            else:
                if not triangles:
                    yield Fault(f"link {link.name}", f"its {shape.kind} has no triangles")


def scale(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Links of absurd size, as when millimetres are taken for metres, or beside their own shapes."""
    for link in robot.links:
        for kind, shapes in (("visual", link.visuals), ("collision", link.collisions)):
            if shapes and not SIZE_M[0] <= (size := _size(shapes)) <= SIZE_M[1]:
                yield Fault(
                    f"link {link.name}",
                    f"its {kind} is {size:.3g} m long; plausible are {SIZE_M[0]:g} to {SIZE_M[1]:g}",
                )
        if link.visuals and link.collisions:
            yield from _differing(link)


def collision(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Links that are seen and cannot be touched, unless neighbours' shapes cover them at zero."""
    by_name = {link.name: link for link in robot.links}
    if not any(link.collisions for link in robot.links):
        yield Fault("robot", "has no collision shape at all")
        return
    for link in robot.links:
        if link.visuals and not link.collisions and not _is_covered(link, robot, by_name):
            yield Fault(
                f"link {link.name}", "has a visual, no collision, and no neighbour covers it"
            )


def _differing(link: Link) -> Iterator[Fault]:
    ratio = _size(link.visuals) / _size(link.collisions)
    if not 1 / SIZE_RATIO <= ratio <= SIZE_RATIO:
        yield Fault(
            f"link {link.name}", f"its visual is {ratio:.3g} times as long as its collision"
        )
    else:
        (low, high), (other_low, other_high) = _bounds(link.visuals), _bounds(link.collisions)
        gap = float(np.maximum(low - other_high, other_low - high).max())
        if gap > _size(link.visuals):
            yield Fault(f"link {link.name}", f"its visual and its collision are {gap:.3g} m apart")


def _is_covered(link: Link, robot: Urdf, by_name: dict[str, Link]) -> bool:
    points = np.vstack([shape.mesh.vertices for shape in link.visuals])
    covered = np.zeros(len(points), dtype=bool)
    for joint in robot.joints:
        if joint.child == link.name and joint.parent in by_name:
            outside = points @ joint.pose[:3, :3].T + joint.pose[:3, 3]
            shapes = by_name[joint.parent].collisions
        elif joint.parent == link.name and joint.child in by_name:
            outside = (points - joint.pose[:3, 3]) @ joint.pose[:3, :3]
            shapes = by_name[joint.child].collisions
        else:
            continue
        for shape in shapes:
            covered |= shape.contains(outside, SLACK_M)
    return bool(covered.all())


def _bounds(shapes: tuple[Shape, ...]) -> tuple[np.ndarray, np.ndarray]:
    bounds = np.array([shape.mesh.bounds for shape in shapes])
    return bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)


def _size(shapes: tuple[Shape, ...]) -> float:
    low, high = _bounds(shapes)
    return float((high - low).max())
