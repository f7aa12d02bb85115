"""The printed skins: their outer surface is the contact capsule itself, lugs inside hold the bone."""

from __future__ import annotations

import math

from fpcad.make.parts import interlock
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.solids import Solid, behind_bend, beyond_flat, finger_core, mirrored_at, rod


def distal_skin(d: Dimensions) -> Solid:
    """Fingertip's skin in the distal frame: closed at the tip, cut to the IP joint's bend plane."""
    outer = finger_core(d.distal_axis_length, d.skin_outer)
    bore = finger_core(d.distal_axis_length, d.skin_inner).cut(_beyond_flat(d))
    cap = outer.cut(bore).cut(behind_bend(d.ip_flex, d.clearance))
    return cap.fuse(*interlock.lugs(d, "distal"))


def proximal_skin(d: Dimensions) -> Solid:
    """Sleeve of the proximal link in its frame, from the root's sphere to the bend plane."""
    ends = (d.shaft_start, 0.0, 0.0), (d.proximal_length, 0.0, 0.0)
    sleeve = rod(*ends, d.skin_outer).cut(rod(*ends, d.skin_inner).cut(_beyond_flat(d)))
    sleeve = sleeve.cut(mirrored_at(behind_bend(d.ip_flex, d.clearance), d.proximal_length))
    return sleeve.fuse(*interlock.lugs(d, "proximal"))


def _beyond_flat(d: Dimensions) -> Solid:
    """Where the skin is thicker because the bone is flat; the gap between them is as anywhere else."""
    return beyond_flat(d.flat + d.skin_inner - d.bone)


def open_share(d: Dimensions) -> float:
    """Share [-] of a finger's contact capsules that no skin covers: near the root and at the bend."""
    r, width = d.skin_outer, 2 * math.pi * d.skin_outer
    bend = 2 * r**2 * math.tan(d.ip_flex[1] / 2) + width * d.clearance
    whole = width * (d.proximal_length + d.distal_axis_length) + width * r
    return (width * d.shaft_start + 2 * bend) / whole
