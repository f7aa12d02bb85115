"""The bench stand: a wall with the pattern of the flange, and a plate with a channel for each jig."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fpcad.make.parts.catalogue import Flange, Screw, lookup
from fpcad.make.parts.solids import FAR_MM, Solid, box, placed, prism, rod, union
from fpcad.make.stand.jig import RIB_MM, foot_frame, rib_width
from fpcad.make.stand.jig_place import FOOT_BEFORE_MM, JigPlace

Array = NDArray[np.float64]

WALL_MM, PLATE_MM = 10.0, 12.0
"""Thickness of wall and plate."""
AROUND_MM = 6.0
"""What the plate reaches beyond feet and wall."""
GUSSET_MM = 6.0
BEHIND_MM = 18.0
"""What the plate reaches behind the wall."""
LEAST_WIDTH_MM = 110.0
JOINT_MM = 30.0
"""Width of the tongue that joins both halves of a plate."""
JOINT_LONG_MM, JOINT_TAPER_MM = 16.0, 5.0


def bench_solids(
    places: Sequence[JigPlace], floor_mm: float, flange: Flange, clearance: float, longest_mm: float
) -> list[Solid]:
    """The stand in its own frame: in one piece, or where the plate is longer than a bed in two.

    They are joined by a tongue that widens: the front one is lowered onto it.
    """
    low, high = plate_corners(places, floor_mm, flange)
    plate = box(low, high)
    channels = [_channel(place, floor_mm, n, clearance) for n, place in enumerate(places)]
    top = flange.outer_mm / 2 + AROUND_MM
    half = min(-low[1], high[1], flange.outer_mm / 2 + AROUND_MM)
    wall = box((-WALL_MM, -half, low[2]), (0, half, top)).cut(*_pattern(flange))
    gussets = [_gusset(side * half, floor_mm) for side in (-1, 1)]
    stand = union([plate, wall, *gussets])
    stand = (stand.cut(*channels) if channels else stand).clean()
    if high[0] - low[0] <= longest_mm:
        return [stand]
    return _halves(stand, (low[0] + high[0] - JOINT_LONG_MM) / 2, clearance)


def plate_corners(
    places: Sequence[JigPlace], floor_mm: float, flange: Flange
) -> tuple[Array, Array]:
    """Least and greatest coordinates (3,) [mm] of the plate."""
    reach = [np.array([[0.0, -LEAST_WIDTH_MM / 2], [flange.outer_mm, LEAST_WIDTH_MM / 2]])]
    reach += [place.foot for place in places]
    points = np.vstack(reach)
    least, most = points.min(axis=0) - AROUND_MM, points.max(axis=0) + AROUND_MM
    return np.array([-WALL_MM - BEHIND_MM, least[1], floor_mm - PLATE_MM]), np.array(
        [*most, floor_mm]
    )


def _channel(place: JigPlace, floor_mm: float, number: int, clearance: float) -> Solid:
    """Where a rib slides in from the plate's edge up to its end."""
    half, gap = rib_width(number) / 2 + clearance, clearance
    room = box((-FOOT_BEFORE_MM - gap, -half, -RIB_MM - gap), (FAR_MM, half, PLATE_MM))
    return placed(room, foot_frame(place, floor_mm))


def _pattern(flange: Flange) -> list[Solid]:
    """Holes of the flange's screws, and the recess of its boss, right through the wall."""
    screw, radius = lookup("screws", Screw, flange.screw), flange.circle_mm / 2
    angles = [
        math.pi / flange.screws + 2 * math.pi * k / flange.screws for k in range(flange.screws)
    ]
    at = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    holes = [rod((-FAR_MM, y, z), (FAR_MM, y, z), screw.clearance_hole_mm / 2) for y, z in at]
    return [*holes, rod((-FAR_MM, 0, 0), (FAR_MM, 0, 0), flange.boss_mm / 2)]


def _gusset(y: float, floor_mm: float) -> Solid:
    """Between plate and wall, behind one of the wall's edges: in front of it the hand's base may be."""
    outline = [
        (-WALL_MM / 2, floor_mm - PLATE_MM / 2),
        (-WALL_MM - BEHIND_MM, floor_mm - PLATE_MM / 2),
        (-WALL_MM - BEHIND_MM, floor_mm),
        (-WALL_MM / 2, floor_mm / 2),
    ]
    low, middle = (
        sorted((y, y - math.copysign(GUSSET_MM, y))),
        (2 * y - math.copysign(GUSSET_MM, y)) / 2,
    )
    return prism(outline, (low[1] - low[0]) / 2).translate((0, middle, 0))


def _halves(stand: Solid, x: float, clearance: float) -> list[Solid]:
    """The stand cut across, and joined by a tongue of the rear half."""
    half, long, more = JOINT_MM / 2, JOINT_LONG_MM, JOINT_TAPER_MM
    behind = box((-FAR_MM,) * 3, (x, FAR_MM, FAR_MM))

    def tongue(wider: float) -> Solid:
        outline = [
            (x - 1.0, -half - wider), (x + long + wider, -half - more - wider),
            (x + long + wider, half + more + wider), (x - 1.0, half + wider),
        ]  # fmt: skip
        return prism(outline, FAR_MM).rotate((0, 0, 0), (1, 0, 0), 90)

    rear = stand.intersect(behind.fuse(tongue(0.0)))
    front = stand.cut(behind.fuse(tongue(clearance)))
    return [rear.clean(), front.clean()]
