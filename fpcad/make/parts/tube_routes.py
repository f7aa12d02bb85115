"""The tubes from the palm to the motors' box, and which motor sits in which place of the box.

Each strand has a tube of its own: straight out of the palm, along a cubic curve, and straight into its port. Motors are
given places so that all tubes together are shortest, tight bends and tubes close to the flange counted as
longer. That is an assignment problem, solved exactly (Crouse 2016, as in scipy).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from fpcad.make.parts.catalogue import Tube, lookup
from fpcad.make.parts.curves import hermite, length_of
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.flange_dimensions import PAD_MM, STEM_MM, FlangeDimensions
from fpcad.make.parts.motor_box_dimensions import MotorBox, MotorSlot
from fpcad.make.parts.part import Array
from fpcad.make.parts.routing import EXIT_MM, TUBE, TUBE_SEAT_MM, strands
from fpcad.model.geometry import HandGeometry

MOTORS = ("m1", "m2", "m3")
HANDLES = (0.5, 0.8, 1.1, 1.5, 2.0)
"""Derivatives at a curve's ends that are tried, in shares of the distance between them."""
GENTLE_MM = 25.0
"""A bend of this radius or more costs nothing."""
CLEAR_MM = 2.0
"""Gap to flange and stem from which on closeness costs nothing."""
BEND_COST = 20.0
"""What a millimetre that the radius lacks counts, in millimetres of tube."""
CLEAR_COST = 200.0
QUARTER_TURNS = 4
"""The flange's screws allow the box to be turned by a quarter."""
LOOSE_END_MM = 40.0
"""So much is drawn of a tube whose box stands elsewhere."""


@dataclass(frozen=True)
class TubeEnd:
    """Where a strand's tube begins in the palm, in H."""

    strand: str
    """`index_m1_flexor` and so on."""
    start: Array  # (3,) [mm]
    ahead: Array  # (3,) unit vector out of the palm


@dataclass(frozen=True)
class TubeRoute:
    """A tube from the palm to its port."""

    strand: str
    points: Array
    """(n, 3) its centre line in H [mm]."""
    length_mm: float
    bend_mm: float
    """Least radius that it is bent to; infinite where it is straight."""


@dataclass(frozen=True)
class TubeRoutes:
    """All tubes of a hand, and where its motors sit."""

    T_palm_box: Array
    """(4, 4) pose of the box in H [mm]."""
    slots: dict[str, int]
    """Number of the place of each motor, by `index_m1` and so on."""
    routes: tuple[TubeRoute, ...]


def tube_ends(geometry: HandGeometry, d: Dimensions) -> list[TubeEnd]:
    """Where the tubes of all strands begin, finger by finger and motor by motor."""
    found = []
    for finger in geometry.fingers:
        T = geometry.T_palm_root[finger]
        for strand in strands(d, T):
            last, end = (strand.outside() @ T[:3, :3].T + T[:3, 3])[-2:]
            ahead = (end - last) / np.linalg.norm(end - last)
            start = end - (EXIT_MM - TUBE_SEAT_MM) * ahead
            found.append(TubeEnd(f"{finger}_{strand.name}", start, ahead))
    return found


def loose_routes(geometry: HandGeometry, d: Dimensions, length_mm: float) -> tuple[TubeRoute, ...]:
    """Tubes of a length [mm] to a box that stands elsewhere; only their beginnings are drawn."""
    return tuple(
        TubeRoute(
            end.strand,
            np.array([end.start, end.start + min(length_mm, LOOSE_END_MM) * end.ahead]),
            length_mm,
            math.inf,
        )
        for end in tube_ends(geometry, d)
    )


def tube_routes(
    geometry: HandGeometry, d: Dimensions, flange: FlangeDimensions, box: MotorBox
) -> TubeRoutes:
    """The shortest set of tubes over all places of the motors and all quarter turns of the box."""
    ends = tube_ends(geometry, d)
    found = [_in_place(ends, flange, box, turn) for turn in range(QUARTER_TURNS)]
    return min(found, key=lambda cost_and_routes: cost_and_routes[0])[1]


def _in_place(
    ends: Sequence[TubeEnd], flange: FlangeDimensions, box: MotorBox, quarter_turns: int
) -> tuple[float, TubeRoutes]:
    """Cost [mm] and tubes of the best assignment with the box turned by so many quarters."""
    T_palm_box = flange.T_palm_flange @ _turned(quarter_turns)
    curves = _Curves(ends, box.slots, T_palm_box, flange)
    motors = list(dict.fromkeys(end.strand.rpartition("_")[0] for end in ends))
    own = np.array([motors.index(end.strand.rpartition("_")[0]) for end in ends])
    cost = np.zeros((len(motors), len(box.slots)))
    np.add.at(cost, own, curves.cost)
    rows, columns = linear_sum_assignment(cost)
    slots = {motors[row]: int(column) for row, column in zip(rows, columns, strict=True)}
    routes = tuple(curves.route(i, slots[motors[own[i]]]) for i in range(len(ends)))
    return round(float(cost[rows, columns].sum()), 6), TubeRoutes(T_palm_box, slots, routes)


class _Curves:
    """Every strand's tube to its port in every place of the box."""

    def __init__(
        self,
        ends: Sequence[TubeEnd],
        slots: Sequence[MotorSlot],
        T_palm_box: Array,
        flange: FlangeDimensions,
    ) -> None:
        self._ends = ends
        seat = EXIT_MM - TUBE_SEAT_MM
        start = np.array([end.start + seat * end.ahead for end in ends])[:, None, None]
        ahead = np.array([end.ahead for end in ends])[:, None, None]
        ports = np.array([[_port(slot, end.strand) for slot in slots] for end in ends])
        ports = (ports @ T_palm_box[:3, :3].T + T_palm_box[:3, 3])[:, :, None]
        reach = np.linalg.norm(ports - start, axis=-1, keepdims=True)
        k = np.stack(np.meshgrid(HANDLES, HANDLES, indexing="ij"), axis=-1).reshape(-1, 2)
        into = T_palm_box[:3, 2]
        points, bend = hermite(start, ports, k[:, :1] * reach * ahead, k[:, 1:] * reach * into)
        radius = 1.0 / np.maximum(bend.max(axis=-1), 1e-9)
        tube = lookup("tubes", Tube, TUBE).outer_mm / 2
        gap = flange_gap(flange, points).min(axis=-1) - tube
        cost = length_of(points) + BEND_COST * np.maximum(GENTLE_MM - radius, 0.0)
        cost += CLEAR_COST * np.maximum(CLEAR_MM - gap, 0.0)
        best = np.argmin(cost, axis=-1)[..., None]
        self.cost = np.take_along_axis(cost, best, axis=-1)[..., 0]
        """(strands, places) [mm]."""
        self._radius = np.take_along_axis(radius, best, axis=-1)[..., 0]
        self._points = np.take_along_axis(points, best[..., None, None], axis=2)[:, :, 0]

    def route(self, end: int, slot: int) -> TubeRoute:
        points = np.vstack([self._ends[end].start, self._points[end, slot]])
        radius = float(self._radius[end, slot])
        return TubeRoute(self._ends[end].strand, points, float(length_of(points)), radius)


def _port(slot: MotorSlot, strand: str) -> tuple[float, float, float]:
    return slot.flexor_port if strand.endswith("flexor") else slot.extensor_port


def _turned(quarters: int) -> Array:
    cosine, sine = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters]
    pose = np.eye(4)
    pose[:2, :2] = [[cosine, -sine], [sine, cosine]]
    return pose


def flange_gap(f: FlangeDimensions, points: Array) -> Array:
    """Distance (...) [mm] of points (..., 3) in H to foot, stem and disc; negative inside them.

    The foot is taken with the heads of its screws.
    """
    T = np.linalg.inv(f.T_palm_foot)
    x, y, z = np.moveaxis(points @ T[:3, :3].T + T[:3, 3], -1, 0)
    across, disc, under = np.hypot(x, y), f.flange.outer_mm / 2, f.stem - f.flange.disc_mm
    cone = math.sqrt(0.5) * (across - STEM_MM - (z - f.cone_start))
    beside = np.where(z < under, np.minimum(across - STEM_MM, cone), across - disc)
    top = PAD_MM + f.screw.head_height_mm
    away = [np.abs(x) - f.half_length, np.abs(y) - f.half_width, z - top]
    foot = np.linalg.norm(np.maximum(away, 0.0), axis=0) + np.minimum(np.max(away, axis=0), 0.0)
    return np.minimum(np.where(z > f.stem, np.inf, beside), foot)
