"""The IP joint's hardware: the largest bearing that a finger has room for, else bushes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from fpcad.make.parts.catalogue import Bearing, lookup, table

SEAT_WALL_MM = {"ball": 1.0, "bush": 0.8}
"""Around a bearing's seat, at its outer face."""
INNER_MM = {"ball": 0.92, "bush": 0.4}
"""|y| of a bearing's inner face: between the two lies the strands' groove."""
WIDE_INNER_MM = 1.45
"""The same for a bearing whose seat is larger than the groove's root: a wall must lie between them."""
WIDE_OUTER_MM = 7.5
PRONG_MM = 0.8
"""Least thickness of the clevis's prongs."""
PIN_WALL_MM = 0.8
"""Around the pin, at the outer face of a prong."""
PRONG_MOST_MM = 3.0


@dataclass(frozen=True)
class Knuckle:
    """The IP joint. All that turns lies in a ball of the bones' radius about its axis; all in mm."""

    bearing: Bearing
    tongue_half: float
    """Half width of the distal bone's tongue, which holds the bearings flush with its sides."""
    prong_inner: float
    prong_outer: float

    @property
    def bearing_inner(self) -> float:
        """|y| of the bearings' inner faces."""
        return self.tongue_half - self.bearing.width_mm


def half_width(bearing: Bearing) -> float:
    """Half width [mm] of a tongue that holds two of a bearing beside the strands' groove."""
    inner = WIDE_INNER_MM if bearing.outer_mm > WIDE_OUTER_MM else INNER_MM[bearing.kind]
    return inner + bearing.width_mm


def bone_needed(bearing: Bearing, gap: float) -> float:
    """Least radius [mm] of a bone whose knuckle holds a bearing."""
    half = half_width(bearing)
    seat = math.hypot(bearing.outer_mm / 2 + SEAT_WALL_MM[bearing.kind], half)
    prong = math.hypot(bearing.bore_mm / 2 + PIN_WALL_MM, half + gap + PRONG_MM)
    return max(seat, prong)


def finger_needed(bearing: Bearing, gap: float, skin: float) -> float:
    """Least diameter [mm] of a finger whose knuckle holds a bearing."""
    return 2 * (bone_needed(bearing, gap) + gap + skin)


def fitting(bone: float, gap: float) -> Iterator[Bearing]:
    """Bearings that a bone of this radius [mm] has room for, in the catalogue's order."""
    for size in table("bearings"):
        bearing = lookup("bearings", Bearing, size)
        if bone_needed(bearing, gap) <= bone + 1e-9:
            yield bearing


def knuckle(bone: float, gap: float) -> Knuckle | None:
    """The knuckle of a bone of this radius [mm], or None where nothing fits."""
    rows = list(fitting(bone, gap))
    if not rows:
        return None
    best = max(rows, key=lambda row: (row.kind == "ball", row.static_load_n))
    half = half_width(best)
    room = math.sqrt(bone**2 - (best.bore_mm / 2 + PIN_WALL_MM) ** 2)
    return Knuckle(best, half, half + gap, min(room, half + gap + PRONG_MOST_MM))
