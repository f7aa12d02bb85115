"""The palm: the template's primitives, less the room in which the fingers' roots move."""

from __future__ import annotations

import math

import numpy as np

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.solids import (
    FAR_MM,
    Solid,
    ball,
    box,
    capsule,
    placed,
    rod,
    swept_link,
    union,
)
from fpcad.model.geometry import HandGeometry, PalmShape
from fpcad.spec.base import Interval

ROOF_MM = 7.5
"""Thickness of the palm's dorsal roof, which no link's sweep enters: it holds the palm together."""

INSET_STEP_MM = 0.2
"""Primitives are inset by multiples of this, because surfaces that only touch break solid modelling."""


def palm_solid(geometry: HandGeometry, d: Dimensions) -> Solid:
    """The palm in the hand frame H."""
    roots = [geometry.T_palm_root[finger] for finger in geometry.fingers]
    below_roof = box((-FAR_MM,) * 3, (FAR_MM, FAR_MM, roof_height(geometry)))
    balls = [ball(root[:3, 3], d.root - d.clearance) for root in roots]
    body = union([*_bars_with_grooves(geometry, d, below_roof), *balls])
    for root in roots:
        sweeps = placed(_near_link_room(d), root), placed(_neck_room(d), root)
        body = body.cut(*[sweep.intersect(below_roof) for sweep in sweeps])
        body = body.cut(placed(_cross_room(d), root), placed(_pin_hole(d), root))
    return body.clean()


def _bars_with_grooves(geometry: HandGeometry, d: Dimensions, below_roof: Solid) -> list[Solid]:
    """The palm's bars less all that the proximal links pass below the roof.

    What lies in any finger's root sphere stays: it ties that finger's ears to the roof.
    """
    shapes = [shape for shape in geometry.palm if shape.finger is None]
    if not shapes:
        return []
    bars = union([_bar(shape, n * INSET_STEP_MM) for n, shape in enumerate(shapes, start=1)])
    roots = [geometry.T_palm_root[finger] for finger in geometry.fingers]
    kept = [ball(root[:3, 3], d.root - 2 * d.clearance) for root in roots]
    for root in roots:
        groove = placed(_link_room(d, d.mcp_abd, d.proximal_length + d.skin_outer), root)
        bars = bars.cut(groove.intersect(below_roof).cut(*kept))
    return [bars]


def roof_height(geometry: HandGeometry) -> float:
    """Height z [mm] in H up to which the fingers' cavities may reach."""
    tops = [max(s.start_mm[2], s.end_mm[2]) + s.radius_mm for s in geometry.palm]
    return float(max(tops)) - ROOF_MM


def _bar(shape: PalmShape, inset: float) -> Solid:
    radius = shape.radius_mm - inset
    if np.allclose(shape.start_mm, shape.end_mm):
        return ball(shape.start_mm, radius)
    return capsule(shape.start_mm, shape.end_mm, radius)


def _link_room(d: Dimensions, abduction: Interval, far: float) -> Solid:
    """What the proximal link with its skin passes, up to a distance `far` from the root."""
    half = d.skin_outer + d.clearance
    widest = max(abs(angle) for angle in abduction)
    near = d.shaft_start * math.cos(widest) - half * math.sin(widest)
    return swept_link((max(near, 0.0), far), half, half, d.mcp_flex, abduction)


def _near_link_room(d: Dimensions) -> Solid:
    """What the link passes in pure flexion close to its root: it cuts only its neighbours' ears."""
    room = _link_room(d, (0.0, 0.0), 2 * d.root)
    return room.cut(ball((0, 0, 0), d.root - d.clearance / 2))


def _neck_room(d: Dimensions) -> Solid:
    """What the proximal bone's neck passes between the palm's ears."""
    reach = (0.0, d.shaft_start + d.clearance)
    half_width, half_height = d.neck_half_width + d.clearance, d.fork_outer + d.clearance
    return swept_link(reach, half_width, half_height, d.mcp_flex, d.mcp_abd)


def _cross_room(d: Dimensions) -> Solid:
    """What the MCP cross and the proximal bone's fork pass."""
    half_width = d.hub + d.clearance
    return rod((0, -half_width, 0), (0, half_width, 0), d.mcp_cavity)


def _pin_hole(d: Dimensions) -> Solid:
    """The flexion pin's hole, long enough to push the pin in from the side."""
    return rod((0, -2.5 * d.root, 0), (0, 2.5 * d.root, 0), d.pin_hole)
