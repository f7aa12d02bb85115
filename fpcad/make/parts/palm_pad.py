"""The palm's pad: a skin let into the palmar face of the palm's longest free bar.

Its face is the palm's own: the bar's primitive where the fingers' grooves leave it, else the grooves'
floor. Plugs hold it, which are pulled through the palm to the dorsal side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.parts.dimensions import Dimensions, roof_height
from fpcad.make.parts.flange_dimensions import FlangeDimensions
from fpcad.make.parts.palm_room import below_roof, link_room
from fpcad.make.parts.part import FIXED_LINK
from fpcad.make.parts.solids import FAR_MM, Solid, ball, box, cleaned, palm_primitive, placed, rod
from fpcad.model.geometry import HandGeometry, PalmShape

Array = NDArray[np.float64]

NAME = f"{FIXED_LINK}_pad"
LEAST_SPAN_MM = 16.0
"""On less, two plugs have no room."""
PLUG_MM, HEAD_MM = 1.5, 2.1
"""Radius of a plug's neck and of the ball at its end, which is pulled through the neck's hole."""
PLUG_MARGIN_MM = 3.5
"""From the middle of a plug to the end of the pad."""
BESIDE_INSERT_MM = 0.8
"""Least wall between the flange's inserts and a plug's way."""
BOSS_MM = 1.2
"""Wall around an insert's hole that the pad leaves of the palm."""
SUNK_MM = 0.5
"""Plugs end that far below the seat of the flange's foot."""
LIP_MM = 0.5
"""The pad's sides reach so far beyond its floor over the grooves."""
MOUNT_GAP_MM = 0.05
"""What the palm is cut back for the pad keeps so far from the fingers' primitives: they stay whole."""
SPACING_MM = 0.5


@dataclass(frozen=True)
class PadPlace:
    """Where a hand's pad is, and its plugs."""

    bar: PalmShape
    plugs: tuple[Array, Array]
    """Points (3,) [mm] of the bar's axis in H: above them plugs go through the palm."""
    inserts: tuple[Array, ...]
    """Axes of the flange's inserts' holes, as points (3,) [mm] in H at their lower ends."""
    insert_mm: float
    """Radius of these holes."""
    seat_mm: float
    """Height z of the flange's seat in H, below which plugs end."""


def pad_place(geometry: HandGeometry, flange: FlangeDimensions) -> PadPlace | None:
    """On the longest stretch of a level bar that is outside of all fingers' primitives.

    None where it is too short, or where inserts leave no room for two plugs.
    """
    bars = [s for s in geometry.palm if s.finger is None and _is_level(s)]
    found = [(bar, *ends) for bar in bars for ends in _free_stretches(geometry, bar)]
    bar, low, high = max(found, key=lambda f: f[2] - f[1], default=(None, 0.0, 0.0))
    if bar is None or high - low < LEAST_SPAN_MM:
        return None
    inserts = tuple(
        (flange.T_palm_foot @ [side * flange.screw_at, 0.0, -flange.insert_depth, 1.0])[:3]
        for side in (-1, 1)
    )
    radius = flange.insert.hole_mm / 2
    apart = radius + BESIDE_INSERT_MM + HEAD_MM + 0.5
    steps = np.arange(low + PLUG_MARGIN_MM, high - PLUG_MARGIN_MM, SPACING_MM)
    axis = (bar.end_mm - bar.start_mm) / np.linalg.norm(bar.end_mm - bar.start_mm)
    points = bar.start_mm + np.outer(steps, axis)
    clear = [p for p in points if all(math.dist(p[:2], i[:2]) > apart for i in inserts)]
    if len(clear) < 2 or math.dist(clear[0], clear[-1]) < 2 * apart:
        return None
    seat = float(flange.T_palm_foot[2, 3])
    return PadPlace(bar, (clear[0], clear[-1]), inserts, radius, seat)


def _is_level(bar: PalmShape) -> bool:
    axis = bar.end_mm - bar.start_mm
    return float(np.linalg.norm(axis)) > 0 and abs(float(axis[2])) < 1e-6


def _free_stretches(geometry: HandGeometry, bar: PalmShape) -> list[tuple[float, float]]:
    """Stretches along a bar [mm] whose points are outside of the fingers' primitives."""
    length = float(np.linalg.norm(bar.end_mm - bar.start_mm))
    along = np.linspace(0.0, length, 2 + int(length / SPACING_MM))
    points = bar.start_mm + np.outer(along / length, bar.end_mm - bar.start_mm)
    free = np.ones(len(along), dtype=bool)
    for shape in geometry.palm:
        if shape.finger is not None:
            level = np.column_stack(
                [np.broadcast_to(shape.start_mm[:2], (len(points), 2)), points[:, 2]]
            )
            free &= np.linalg.norm(points - level, axis=1) > shape.radius_mm + 2 * MOUNT_GAP_MM
    edges = np.flatnonzero(np.diff(np.concatenate([[False], free, [False]]).astype(int)))
    return [(float(along[a]), float(along[b - 1])) for a, b in edges.reshape(-1, 2)]


def pad_solid(geometry: HandGeometry, place: PadPlace, d: Dimensions) -> Solid:
    """The pad in H."""
    thick = geometry.radius_mm - d.skin_inner
    top = roof_height(geometry) + thick + LIP_MM
    outside = _rod(place.bar, 0.0).intersect(_below(top))
    outside = outside.cut(*_mounts(geometry, MOUNT_GAP_MM + d.clearance))
    outside = outside.cut(*_grooves(geometry, d, 0.0), *_bosses(place, d.clearance))
    plugs = [_plug(place, point, 0.0) for point in place.plugs]
    core = _core(geometry, place.bar, d, thick).intersect(_below(top)).cut(*plugs)
    pad = outside.cut(core).fuse(*[plug.intersect(_above(top - LIP_MM / 2)) for plug in plugs])
    return max(cleaned(pad).Solids(), key=lambda piece: piece.Volume())


def pad_recess(geometry: HandGeometry, place: PadPlace, d: Dimensions) -> list[Solid]:
    """What the palm lacks for the pad, with a clearance all around."""
    deep = geometry.radius_mm - d.skin_inner + d.clearance
    top = roof_height(geometry) + deep + LIP_MM
    room = _rod(place.bar, -1.0).intersect(_below(top)).cut(*_mounts(geometry, MOUNT_GAP_MM))
    room = room.cut(_core(geometry, place.bar, d, deep), *_bosses(place, 0.0))
    return [room, *(_plug(place, point, d.clearance) for point in place.plugs)]


def _bosses(place: PadPlace, wider: float) -> list[Solid]:
    """What stays of the palm around the flange's inserts."""
    radius, far = place.insert_mm + BOSS_MM + wider, np.array([0.0, 0.0, FAR_MM])
    return [rod(point - far, point + far, radius) for point in place.inserts]


def _core(geometry: HandGeometry, bar: PalmShape, d: Dimensions, deep: float) -> Solid:
    """What is left of a bar below a layer `deep` [mm] under its palmar face."""
    return _rod(bar, deep).cut(*_grooves(geometry, d, deep))


def _grooves(geometry: HandGeometry, d: Dimensions, deep: float) -> list[Solid]:
    """The room of all proximal links, wider by `deep` [mm] all around, below a roof higher by as much."""
    cut, far = below_roof(geometry, deep), d.proximal_length + d.skin_outer
    room = link_room(d, d.mcp_abd, far, deep)
    return [placed(room, geometry.T_palm_root[f]).intersect(cut) for f in geometry.fingers]


def _mounts(geometry: HandGeometry, wider: float) -> list[Solid]:
    return [palm_primitive(shape, -wider) for shape in geometry.palm if shape.finger is not None]


def _plug(place: PadPlace, point: Array, wider: float) -> Solid:
    """A neck from the bar's palmar face up to a ball; with a clearance `wider` [mm], the ball's way out too."""
    x, y = float(point[0]), float(point[1])
    bottom = float(point[2]) - place.bar.radius_mm + SUNK_MM
    head = np.array([x, y, place.seat_mm - SUNK_MM - HEAD_MM])
    neck = rod((x, y, bottom), head, PLUG_MM + wider)
    if not wider:
        return neck.fuse(ball(head, HEAD_MM))
    out = rod(head, (x, y, place.seat_mm + place.bar.radius_mm), HEAD_MM + wider)
    return neck.fuse(ball(head, HEAD_MM + wider), out)


def _rod(bar: PalmShape, inset: float) -> Solid:
    return rod(bar.start_mm, bar.end_mm, bar.radius_mm - inset)


def _below(height: float) -> Solid:
    return box((-FAR_MM,) * 3, (FAR_MM, FAR_MM, height))


def _above(height: float) -> Solid:
    return box((-FAR_MM, -FAR_MM, height), (FAR_MM, FAR_MM, FAR_MM))
