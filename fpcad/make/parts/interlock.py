"""Lugs inside the skins and pockets in the bones: a sleeve can neither spin nor slide off."""

from __future__ import annotations

from typing import Literal

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.solids import Solid, box, rod

Link = Literal["proximal", "distal"]

LUG_MM = 0.7
"""How far a lug reaches into the bone."""
LONGEST_MM = 6.0
WIDTH_SHARE = 0.6
"""Width of a lug, as a share of the bone's radius."""
FLOOR_MM = 0.2
"""What a pocket is deeper and wider than its lug."""


def lug_range(d: Dimensions, link: Link) -> tuple[float, float]:
    """Where along a link its lugs lie [mm], away from knuckle and bend plane."""
    keep = d.bone + 1.0
    if link == "distal":
        low, high = keep, d.distal_axis_length
    else:
        low, high = d.shaft_start + 1.0, d.proximal_length - keep
    middle, half = (low + high) / 2, min((high - low) / 2, LONGEST_MM / 2)
    return middle - half, middle + half


def lugs(d: Dimensions, link: Link) -> list[Solid]:
    """What the skin has more than its bore: one lug on each side."""
    low, high = lug_range(d, link)
    return _blocks(d, (low, high), d.bone - LUG_MM, d.skin_inner + 0.1, 0.0)


def pockets(d: Dimensions, link: Link) -> list[Solid]:
    """What the bone lacks for them."""
    low, high = lug_range(d, link)
    ends = low - FLOOR_MM, high + FLOOR_MM
    return _blocks(d, ends, d.bone - LUG_MM - FLOOR_MM, d.bone + 5.0, FLOOR_MM)


def _blocks(
    d: Dimensions, reach: tuple[float, float], inner: float, outer: float, wider: float
) -> list[Solid]:
    """Blocks to both sides, round outside so that they end within a sleeve."""
    half = WIDTH_SHARE * d.bone / 2 + wider
    hull = rod((reach[0], 0, 0), (reach[1], 0, 0), outer)
    found = []
    for side in (-1, 1):
        low, high = sorted((side * inner, side * 2 * outer))
        found.append(hull.intersect(box((reach[0], low, -half), (reach[1], high, half))))
    return found
