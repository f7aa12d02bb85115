"""Solids that several parts are cut from. All lengths in mm, angles in rad."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.toolchain import cadquery, modelling
from fpcad.model.geometry import PalmShape

log = logging.getLogger(__name__)

Solid = Any
"""A cadquery shape; untyped because cadquery is imported on first use."""

Point = Sequence[float] | NDArray[np.float64]

FAR_MM = 500.0  # beyond any hand: what cuts "everything on this side" reaches this far


def rod(start: Point, end: Point, radius: float) -> Solid:
    """A cylinder with flat ends between two points."""
    cq = cadquery()
    axis = cq.Vector(*end) - cq.Vector(*start)
    return cq.Solid.makeCylinder(radius, axis.Length, cq.Vector(*start), axis)


def ball(centre: Point, radius: float) -> Solid:
    """A full sphere."""
    cq = cadquery()
    up = cq.Vector(0, 0, 1)
    return cq.Solid.makeSphere(radius, cq.Vector(*centre), up, -90, 90, 360)


def box(low: Point, high: Point) -> Solid:
    """An axis-parallel box between two corners."""
    cq = cadquery()
    size = [float(b - a) for a, b in zip(low, high, strict=True)]
    return cq.Solid.makeBox(*size, cq.Vector(*low))


def capsule(start: Point, end: Point, radius: float) -> Solid:
    """A cylinder with hemispheres about both ends."""
    return rod(start, end, radius).fuse(ball(start, radius), ball(end, radius))


def palm_primitive(shape: PalmShape, inset: float) -> Solid:
    """A primitive of the palm in H, its surface moved inwards by `inset` [mm]."""
    radius = shape.radius_mm - inset
    if np.allclose(shape.start_mm, shape.end_mm):
        return ball(shape.start_mm, radius)
    return capsule(shape.start_mm, shape.end_mm, radius)


def union(solids: Sequence[Solid]) -> Solid:
    """All solids as one."""
    return solids[0].fuse(*solids[1:]) if len(solids) > 1 else solids[0]


def cleaned(solid: Solid) -> Solid:
    """The solid with faces merged where they are one, or as it is where the CAD kernel cannot merge them."""
    try:
        with modelling("clean-up"):
            return solid.clean()
    except MakeError as error:
        log.debug("faces stay apart: %s", error)
        return solid


def finger_core(length: float, radius: float) -> Solid:
    """Half a capsule along x: flat at x = 0, a hemisphere about x = length."""
    cq = cadquery()
    diagonal = radius * math.sqrt(0.5)
    outline = [
        cq.Edge.makeLine(cq.Vector(0, 0, 0), cq.Vector(0, radius, 0)),
        cq.Edge.makeLine(cq.Vector(0, radius, 0), cq.Vector(length, radius, 0)),
        cq.Edge.makeThreePointArc(
            cq.Vector(length, radius, 0),
            cq.Vector(length + diagonal, diagonal, 0),
            cq.Vector(length + radius, 0, 0),
        ),
        cq.Edge.makeLine(cq.Vector(length + radius, 0, 0), cq.Vector(0, 0, 0)),
    ]
    wire = cq.Wire.assembleEdges(outline)
    return cq.Solid.revolve(wire, [], 360, cq.Vector(0, 0, 0), cq.Vector(1, 0, 0))


def prism(outline_xz: Sequence[tuple[float, float]], half_width: float) -> Solid:
    """A polygon in the plane y = 0, extruded to both sides of it."""
    cq = cadquery()
    points = [cq.Vector(x, -half_width, z) for x, z in outline_xz]
    wire = cq.Wire.makePolygon(points, close=True)
    return cq.Solid.extrudeLinear(wire, [], cq.Vector(0, 2 * half_width, 0))


def extruded(outline: Sequence[tuple[float, float]], low: float, high: float) -> Solid:
    """A polygon in x, y, extruded along z from `low` to `high`."""
    cq = cadquery()
    wire = cq.Wire.makePolygon([cq.Vector(x, y, low) for x, y in outline], close=True)
    return cq.Solid.extrudeLinear(wire, [], cq.Vector(0, 0, high - low))


def behind_bend(ip_flex: tuple[float, float], gap: float) -> Solid:
    """All that a distal link must leave free at its IP joint (at the origin, distal along x).

    Two links that keep `gap` from the plane that halves their angle at full flexion, palmar (-z)
    and dorsal, do not meet anywhere in the joint's range.
    """
    palmar = gap + FAR_MM * math.tan(max(ip_flex[1], 0.0) / 2)
    dorsal = gap + FAR_MM * math.tan(max(-ip_flex[0], 0.0) / 2)
    outline = [(gap, 0.0), (palmar, -FAR_MM), (-FAR_MM, -FAR_MM), (-FAR_MM, FAR_MM)]
    return prism([*outline, (dorsal, FAR_MM)], FAR_MM)


def beyond_flat(depth: float) -> Solid:
    """All with y < -depth."""
    return box((-FAR_MM,) * 3, (FAR_MM, -depth, FAR_MM))


def mirrored_at(solid: Solid, x: float) -> Solid:
    """The solid seen in a mirror at the plane x = 0, then shifted along x."""
    return solid.mirror("YZ").translate(cadquery().Vector(x, 0, 0))


def swept_link(
    reach: tuple[float, float],
    half_width: float,
    half_height: float,
    flexion: tuple[float, float],
    abduction: tuple[float, float],
) -> Solid:
    """A hull of what a straight link passes about a universal joint at the origin.

    The link runs along x over `reach`, `half_width` to each side (y) and `half_height` up and down
    (z); it is abducted about z, then flexed about y. Flexion must span less than half a turn.
    """
    cq = cadquery()
    near, far = reach
    left, right = max(abduction[1], 0.0), max(-abduction[0], 0.0)
    corners = [
        (x, side * (x * math.tan(angle) + half_width / math.cos(angle)))
        for x, side, angle in ((near, -1, right), (far, -1, right), (far, 1, left), (near, 1, left))
    ]
    plan = cq.Wire.makePolygon([cq.Vector(x, y, 0) for x, y in corners], close=True)
    ring = cq.Solid.revolve(plan, [], 360, cq.Vector(0, 0, 0), cq.Vector(0, 1, 0))
    return ring.intersect(prism(_flexion_wedge(half_height, flexion, 4 * far), 4 * far))


def _flexion_wedge(
    half_height: float, flexion: tuple[float, float], far: float
) -> list[tuple[float, float]]:
    """Outline in x, z of a strip that starts at the origin and turns about y over `flexion`."""

    def polar(radius: float, angle: float) -> tuple[float, float]:
        return radius * math.cos(angle), -radius * math.sin(angle)

    def beside(offset: float, along: float, angle: float) -> tuple[float, float]:
        (x0, z0), (x1, z1) = polar(offset, angle + math.pi / 2), polar(along, angle)
        return x0 + x1, z0 + z1

    low, high = flexion
    return [
        beside(-half_height, 0.0, low),
        beside(-half_height, far, low),
        polar(2 * far, (low + high) / 2),
        beside(half_height, far, high),
        beside(half_height, 0.0, high),
    ]


def placed(solid: Solid, pose: NDArray[np.float64]) -> Solid:
    """The solid moved by a pose (4, 4) [mm]."""
    cq = cadquery()
    x_axis, z_axis, origin = (tuple(map(float, pose[:3, column])) for column in (0, 2, 3))
    return solid.moved(cq.Location(cq.Plane(origin, x_axis, z_axis)))
