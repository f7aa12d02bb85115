"""The MCP differential's own parts: cross, input pulleys, drum. docs/parts.md, "The differential"."""

from __future__ import annotations

import math

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.mcp_clearances import horn_inner, spoke_back
from fpcad.make.parts.mcp_dimensions import Mcp
from fpcad.make.parts.solids import FAR_MM, Solid, box, rod, union

ANCHOR_MM = 0.4
"""Radius of the holes that strands go through to their knots."""
KNOT_MM = 1.4
"""Radius of a knot's pocket."""


def mcp_cross(d: Dimensions) -> Solid:
    """Two cheeks on the flexion axle, two bridges with the abduction pins. Turns with flexion."""
    m = d.mcp
    front, high = m.cross_front, m.bridge_outer
    back = -(m.axle + m.slip + 1.6)
    solids = []
    for side in (-1, 1):
        low, top = sorted((side * m.cheek_inner, side * m.cheek_outer))
        solids.append(box((back, low, -high), (front, top, high)))
        z = sorted((side * m.bridge_inner, side * high))
        solids.append(box((m.bar_back, -m.cheek_outer, z[0]), (front, m.cheek_outer, z[1])))
        solids.append(box((0.0, -m.boss, z[0]), (front, m.boss, z[1])))
        solids.append(rod((0, 0, z[0]), (0, 0, z[1]), m.boss))
    rounded = rod((0, 0, -high), (0, 0, high), m.cross_reach)
    cross = union(solids).intersect(rounded)
    pins = [rod((0, 0, side), (0, 0, side * FAR_MM), m.pivot + m.hold) for side in (-1, 1)]
    return cross.cut(_along_y(-FAR_MM, FAR_MM, m.axle + m.slip), *pins).clean()


def input_pulley(d: Dimensions) -> Solid:
    """The pulley on the +y side: a transfer groove towards the root, the motor's groove beyond it."""
    m = d.mcp
    body = _along_y(m.pulley_inner, m.pulley_outer, m.input_radius - m.strand)
    lips = (m.pulley_lip, m.pulley_lip + m.lip), (m.pulley_outer - m.lip, m.pulley_outer)
    body = body.fuse(*[_along_y(low, high, m.pulley_rim) for low, high in lips])
    transfer = (m.pulley_inner + m.pulley_lip) / 2
    knots = [_knot(m, y, angle) for y, angle in ((transfer, math.pi), (m.pulley_side, 0.0))]
    return body.cut(_along_y(0.0, FAR_MM, m.axle + m.slip), *knots).clean()


def idler_pulley(d: Dimensions) -> Solid:
    """The dorsal pulley about the abduction axis: free, it leads one input pulley's strand to the other."""
    m = d.mcp
    hub = rod((0, 0, m.disc_inner), (0, 0, m.disc_outer), m.boss)
    hole = rod((0, 0, 0), (0, 0, FAR_MM), m.pivot + m.slip)
    return abduction_plate(d, 1).fuse(hub).cut(hole).clean()


def abduction_plate(d: Dimensions, side: int) -> Solid:
    """A pulley about the abduction axis, dorsal (1) or palmar (-1), that turns by the abduction alone.

    So it needs no more than its front half, horns at both sides, and a spoke; where the IP strands
    pass behind, it is cut out.
    """
    m = d.mcp

    def between(low: float, high: float, radius: float) -> Solid:
        return rod((0, 0, side * low), (0, 0, side * high), radius)

    plate = between(m.disc_inner, m.disc_outer, m.output_radius - m.strand)
    plate = plate.fuse(between(m.disc_lip, m.disc_outer, m.disc_rim))
    back, horn = spoke_back(m, d.widest_abduction), horn_inner(m, d.widest_abduction)
    for hand in (-1, 1):
        low, high = sorted((hand * m.boss, hand * horn))
        plate = plate.cut(box((-FAR_MM, low, -FAR_MM), (back, high, FAR_MM)))
    plate = plate.cut(box((-FAR_MM, -FAR_MM, -FAR_MM), (-m.horn_back, FAR_MM, FAR_MM)))
    plate = plate.cut(box((-FAR_MM, -m.boss, -FAR_MM), (0, m.boss, FAR_MM)))
    knot = between(0.0, FAR_MM, ANCHOR_MM).translate((0.72 * m.output_radius, 0, 0))
    return plate.cut(knot)


def _knot(m: Mcp, y: float, angle: float) -> Solid:
    """A hole from the groove at `y` inwards, and a pocket for the knot, open to the outer face."""
    radius = m.input_radius - m.strand
    inner = (radius + m.axle) / 2
    c, s = math.cos(angle), math.sin(angle)
    hole = rod((c * inner, y, s * inner), (c * FAR_MM, y, s * FAR_MM), ANCHOR_MM)
    pocket = rod((c * inner, y - ANCHOR_MM, s * inner), (c * inner, FAR_MM, s * inner), KNOT_MM)
    return hole.fuse(pocket)


def ip_drum(d: Dimensions) -> Solid:
    """The drum that leads the IP strands across: in its middle the finger's, beside it the motor's."""
    m = d.mcp
    root, half = m.drum_radius - m.strand, m.groove / 2
    body = _along_y(-m.drum_half, m.drum_half, root)
    inner, outer = (half, m.drum_side - half), (m.drum_side + half, m.drum_half)
    for low, high in (inner, outer):
        body = body.fuse(_along_y(low, high, m.drum_rim), _along_y(-high, -low, m.drum_rim))
    notch = box((root - 0.2, -m.drum_side, -ANCHOR_MM), (FAR_MM, m.drum_side, ANCHOR_MM))
    return body.cut(_along_y(-FAR_MM, FAR_MM, m.axle + m.slip), notch).clean()


def _along_y(low: float, high: float, radius: float) -> Solid:
    return rod((0, low, 0), (0, high, 0), radius)
