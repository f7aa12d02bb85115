"""Ways of the six strands of a finger from its pulleys through the palm, in planes across the flexion axis.

Angles about the flexion axis count from dorsal (z of the root's frame) to the front (x), so that
flexion adds to them: the point at angle a and radius r is (x, z) = r (sin a, cos a).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.mcp_clearances import SPOKE_BACK_MM
from fpcad.make.parts.mcp_dimensions import Mcp

Array = NDArray[np.float64]

TUBE = "PTFE-1x2"
"""The tubes in which strands leave the palm."""
EXIT_MM = 20.0
"""Distance from the flexion axis at which strands have left the palm."""
TUBE_SEAT_MM = 15.5
"""Distance from the flexion axis from which a strand's way is as wide as its tube."""
EXIT_SIDE_MM = 3.0
"""Strands of one pulley leave the palm that far to both sides of its middle."""
GUIDE_MM = 11.4
"""Distance from the flexion axis at which a strand that cannot go straight is turned."""


@dataclass(frozen=True)
class Strand:
    """A strand's way from where it leaves its pulley to where it leaves the palm, root's frame [mm]."""

    name: str
    """`m1_flexor` and so on; a motor's flexor shortens when its joint flexes."""
    side: float
    """The plane's y."""
    radius: float
    """Pitch radius of the pulley."""
    sense: int
    """1 where the strand leaves its pulley towards growing angles."""
    points: tuple[tuple[float, float], ...]
    """(x, z) from the pulley outwards: tangent point, a guide where it must turn, the exit."""

    @property
    def tangent_angle(self) -> float:
        """Angle [rad] at which the strand leaves the pulley."""
        return math.atan2(*self.points[0])

    def outside(self) -> Array:
        """(n, 3) the points in the root's frame [mm]."""
        return np.array([(x, self.side, z) for x, z in self.points])


def strands(d: Dimensions, T_palm_root: Array) -> tuple[Strand, ...]:
    """The six strands of one finger, given its root's pose (4, 4) in the palm [mm]."""
    m, dorsal = d.mcp, dorsal_angle(T_palm_root)
    found = []
    for motor, hand in (("m1", 1), ("m2", -1)):
        for name, sense in (("flexor", 1), ("extensor", -1)):
            exit_point = _exit(dorsal, sense)
            tangent = _tangent(exit_point, m.input_radius, sense)
            points = (_at(m.input_radius, tangent), exit_point)
            found.append(
                Strand(f"{motor}_{name}", hand * m.pulley_side, m.input_radius, sense, points)
            )
    for name, sense in (("flexor", 1), ("extensor", -1)):
        points = _through_cross(d, dorsal, sense)
        found.append(Strand(f"m3_{name}", sense * m.drum_side, m.drum_radius, sense, points))
    return tuple(found)


def dorsal_angle(T_palm_root: Array) -> float:
    """Angle [rad] of the palm's dorsal side about a finger's flexion axis."""
    dorsal = T_palm_root[:3, :3].T @ np.array([0.0, 0.0, 1.0])
    return math.atan2(dorsal[0], dorsal[2])


def _exit(dorsal: float, sense: int) -> tuple[float, float]:
    """Where a strand leaves the palm: those that leave towards growing angles on the lesser side."""
    across = -sense * EXIT_SIDE_MM
    x, z = _at(EXIT_MM, dorsal)
    return x + across * math.cos(dorsal), z - across * math.sin(dorsal)


def _tangent(point: tuple[float, float], radius: float, sense: int) -> float:
    """Angle of the tangent point of a line from a pulley to a point."""
    return math.atan2(*point) - sense * math.acos(radius / math.hypot(*point))


def _at(radius: float, angle: float) -> tuple[float, float]:
    return radius * math.sin(angle), radius * math.cos(angle)


def _through_cross(d: Dimensions, dorsal: float, sense: int) -> tuple[tuple[float, float], ...]:
    """Way of an IP strand: straight where the turning cross lets it pass, else by a guide."""
    m, exit_point = d.mcp, _exit(dorsal, sense)
    low, high = free_tangents(m, d.mcp_flex, sense)
    wish = _tangent(exit_point, m.drum_radius, sense)
    wish += 2 * math.pi * round(((low + high) / 2 - wish) / (2 * math.pi))
    tangent = min(max(wish, low), high)
    if tangent == wish:
        return _at(m.drum_radius, tangent), exit_point
    angle = tangent + sense * math.acos(m.drum_radius / GUIDE_MM)
    return _at(m.drum_radius, tangent), _at(GUIDE_MM, angle), exit_point


def free_tangents(m: Mcp, flexion: tuple[float, float], sense: int) -> tuple[float, float]:
    """Least and greatest angle [rad] at which an IP strand may leave the drum.

    Between the palmar side of cross and discs at full flexion and their dorsal side at full
    extension, at every radius that they sweep, and with a gap.
    """
    lows, highs = [], []
    for x, z in _corners(m):
        radius = math.hypot(x, z)
        margin = (m.strand + m.gap) / radius
        lead = sense * math.acos(m.drum_radius / radius)
        lows.append(flexion[1] + math.pi - math.atan2(x, z) + margin - lead)
        highs.append(flexion[0] + 2 * math.pi + math.atan2(x, z) - margin - lead)
    return max(lows), min(highs)


def _corners(m: Mcp) -> list[tuple[float, float]]:
    """Rearmost points (x, z) of cross and discs in the plane of the IP strands, dorsal side."""
    return [
        (m.bar_back, m.bridge_inner),
        (m.bar_back, m.bridge_outer),
        (SPOKE_BACK_MM, m.disc_inner),
        (SPOKE_BACK_MM, m.arm_outer),
    ]
