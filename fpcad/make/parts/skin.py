"""The printed skins: their outer surface is the contact capsule itself."""

from __future__ import annotations

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.solids import Solid, behind_bend, finger_core, mirrored_at, rod


def distal_skin(d: Dimensions) -> Solid:
    """Fingertip's skin in the distal frame: closed at the tip, cut to the IP joint's bend plane."""
    outer = finger_core(d.distal_axis_length, d.skin_outer)
    bore = finger_core(d.distal_axis_length, d.skin_inner)
    return outer.cut(bore).cut(behind_bend(d.ip_flex, d.clearance))


def proximal_skin(d: Dimensions) -> Solid:
    """Sleeve of the proximal link in its frame, from the root's sphere to the bend plane."""
    ends = (d.shaft_start, 0.0, 0.0), (d.proximal_length, 0.0, 0.0)
    sleeve = rod(*ends, d.skin_outer).cut(rod(*ends, d.skin_inner))
    return sleeve.cut(mirrored_at(behind_bend(d.ip_flex, d.clearance), d.proximal_length))
