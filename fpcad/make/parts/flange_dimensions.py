"""Where the flange stands on the palm's back, and its lengths: from the design's numbers alone.

Its foot is a saddle on the palm's bar: one of the palm's primitives that no finger roots in. It lies as near to the
bar's middle as the strands, which leave the palm beside the fingers' roots, and the roots' own solids allow.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fpcad.errors import MakeError
from fpcad.make.parts.catalogue import Flange, Insert, Screw, Tube, lookup
from fpcad.make.parts.dimensions import Dimensions, roof_height
from fpcad.make.parts.part import Array
from fpcad.make.parts.routing import TUBE, strands
from fpcad.model.geometry import HandGeometry, PalmShape
from fpcad.spec.mount import Mount

FOOT_SCREW = "M3"
SEAT_MM = 1.0
"""The palm's bar is flat under the foot, that far below its top: so the foot cannot roll on it."""
PAD_MM = 4.0
"""Thickness of the foot under its screws' heads."""
SKIRT_MM = 2.0
"""How far the foot reaches beyond the bar on both sides."""
SKIRT_DEPTH = 0.6
"""The skirts reach down by this share of the bar's radius."""
STEM_MM = 9.0
"""Radius of the stem."""
KEY_MM = 0.5
"""Room around the head of a screw."""
BESIDE_TUBES_MM = 0.6
"""Gap between the foot and the strands' tubes."""
HEIGHTS_MM = (-6.0, 8.0)
"""Between these heights about the seat, inserts, foot and screws' heads keep clear of the tubes."""
FLOOR_MM = 1.0
"""What is left of the palm under an insert's hole."""
AXIS_STEP_MM = 1.0
LEVEL = 1e-6
"""Largest slope of a bar's axis against the hand's plane."""


@dataclass(frozen=True)
class FlangeDimensions:
    """Lengths [mm] of the flange, and where it stands."""

    T_palm_foot: Array
    """(4, 4): origin on the seat, x along the bar, z dorsal."""
    bar: PalmShape
    """The primitive that it sits on."""
    half_length: float
    """Half of the foot along the bar."""
    half_width: float
    """Half of the foot across it."""
    skirt: float
    """How far the skirts reach below the seat."""
    seat_half: float
    """Half width of the flat that the foot stands on."""
    screw_at: float
    """The foot's two screws sit on the bar's axis, that far from the stem's axis to both sides."""
    screw_length: float
    insert: Insert
    screw: Screw
    stem: float
    """From the seat to the face on the robot's side."""
    flange: Flange
    flange_screw: Screw
    flange_screw_length: float

    @property
    def insert_depth(self) -> float:
        """Depth of the inserts' holes below the seat: the screw's tip and a gap."""
        return max(self.screw_length - PAD_MM, self.insert.length_mm) + 0.5

    @property
    def cone_start(self) -> float:
        """Height at which the stem widens to the disc, by 45 deg: so it prints without support."""
        return self.stem - self.flange.disc_mm - (self.flange.outer_mm / 2 - STEM_MM)

    @property
    def T_palm_flange(self) -> Array:
        """Pose (4, 4) [mm] in H: the middle of the face on the robot's side, z away from the hand."""
        pose = self.T_palm_foot.copy()
        pose[:3, 3] += self.stem * pose[:3, 2]
        return pose

    @property
    def screw_places(self) -> tuple[tuple[float, float], ...]:
        """(x, y) of the flange's screws about its middle: the first one 45 deg from x for four."""
        n, radius = self.flange.screws, self.flange.circle_mm / 2
        angles = [math.pi / n + 2 * math.pi * k / n for k in range(n)]
        return tuple((radius * math.cos(a), radius * math.sin(a)) for a in angles)


def flange_dimensions(
    mount: Mount, geometry: HandGeometry, d: Dimensions, nut_mm: float
) -> FlangeDimensions:
    """The flange of a hand; raises :class:`MakeError` with figures where its foot has no room.

    `nut_mm` is how far behind the face the nuts of the motors' box end.
    """
    screw, insert = lookup("screws", Screw, FOOT_SCREW), lookup("inserts", Insert, FOOT_SCREW)
    flange = lookup("flanges", Flange, mount.flange)
    screw_at = STEM_MM + KEY_MM + screw.head_diameter_mm / 2
    half_length = screw_at + screw.head_diameter_mm / 2 + KEY_MM
    bar, middle = _seat(geometry, d, half_length)
    radius = bar.radius_mm - SEAT_MM
    flange_screw = lookup("screws", Screw, flange.screw)
    found = FlangeDimensions(
        T_palm_foot=_pose(bar, middle),
        bar=bar,
        half_length=half_length,
        half_width=bar.radius_mm + SKIRT_MM,
        skirt=SKIRT_DEPTH * bar.radius_mm - SEAT_MM,
        seat_half=0.9 * math.sqrt(bar.radius_mm**2 - radius**2),
        screw_at=screw_at,
        screw_length=screw.longest(PAD_MM + insert.length_mm + 0.5),
        insert=insert,
        screw=screw,
        stem=mount.stem_mm,
        flange=flange,
        flange_screw=flange_screw,
        flange_screw_length=flange_screw.shortest(flange.disc_mm + nut_mm)
        if mount.box
        else flange_screw.longest(flange.disc_mm + flange_screw.thread_mm),
    )
    _check_floor(found, geometry)
    return found


def _check_floor(f: FlangeDimensions, geometry: HandGeometry) -> None:
    """The inserts' holes end above the rooms in which the fingers move."""
    floor = float(f.T_palm_foot[2, 3]) - f.insert_depth - roof_height(geometry)
    if floor < FLOOR_MM:
        raise MakeError(
            f"palm: {f.bar.name} leaves {floor:.1f} mm under the flange's inserts, "
            f"{FLOOR_MM:g} mm are needed"
        )


def _pose(bar: PalmShape, along: float) -> Array:
    """The foot's frame on a bar, `along` [mm] from its start."""
    x_axis = (bar.end_mm - bar.start_mm) / np.linalg.norm(bar.end_mm - bar.start_mm)
    z_axis = np.array([0.0, 0.0, 1.0])
    pose = np.eye(4)
    pose[:3, :3] = np.stack([x_axis, np.cross(z_axis, x_axis), z_axis], axis=1)
    pose[:3, 3] = bar.start_mm + along * x_axis + (bar.radius_mm - SEAT_MM) * z_axis
    return pose


def _seat(geometry: HandGeometry, d: Dimensions, half_length: float) -> tuple[PalmShape, float]:
    """The bar with the longest free stretch, and where on it the foot's middle lies."""
    bars = [shape for shape in geometry.palm if _is_bar(shape)]
    if not bars:
        raise MakeError("hand.palm: a flange needs a level capsule to stand on, there is none")
    stretches = [_longest(_free(bar, geometry, d), bar) for bar in bars]
    low, high, bar = max(stretches, key=lambda found: found[1] - found[0])
    if high - low < 2 * half_length:
        raise MakeError(
            f"palm: the flange's foot needs {2 * half_length:.1f} mm of {bar.name}, "
            f"{max(high - low, 0.0):.1f} mm are free between the fingers' roots"
        )
    middle = float(np.linalg.norm(bar.end_mm - bar.start_mm)) / 2
    return bar, min(max(middle, low + half_length), high - half_length)


def _is_bar(shape: PalmShape) -> bool:
    axis = shape.end_mm - shape.start_mm
    length = float(np.linalg.norm(axis))
    return shape.finger is None and length > 0 and abs(axis[2]) <= LEVEL * length


def _longest(
    blocked: Iterator[tuple[float, float]], bar: PalmShape
) -> tuple[float, float, PalmShape]:
    """The longest stretch of a bar that nothing blocks."""
    length = float(np.linalg.norm(bar.end_mm - bar.start_mm))
    low, best = 0.0, (0.0, 0.0)
    for start, end in sorted([*blocked, (length, length)]):
        best = max(best, (low, start), key=lambda gap: gap[1] - gap[0])
        low = max(low, end)
    return (*best, bar)


def _free(bar: PalmShape, geometry: HandGeometry, d: Dimensions) -> Iterator[tuple[float, float]]:
    """Stretches of a bar that strands' tubes and other solids of the palm take up at the seat."""
    T_foot_palm = np.asarray(np.linalg.inv(_pose(bar, 0.0)), dtype=np.float64)
    half = bar.radius_mm + SKIRT_MM
    tube = lookup("tubes", Tube, TUBE).outer_mm / 2 + BESIDE_TUBES_MM
    for finger in geometry.fingers:
        T = T_foot_palm @ geometry.T_palm_root[finger]
        for strand in strands(d, geometry.T_palm_root[finger]):
            last, end = (strand.outside() @ T[:3, :3].T + T[:3, 3])[-2:]
            slope = (end - last) / (end[2] - last[2])
            ends = np.array([end + (z - end[2]) * slope for z in HEIGHTS_MM])
            if np.abs(ends[:, 1]).min() < half + tube:
                yield float(ends[:, 0].min()) - tube, float(ends[:, 0].max()) + tube
    for shape in geometry.palm:
        if shape is not bar:
            yield from _crossed(shape, T_foot_palm, half)


def _crossed(shape: PalmShape, T_foot_palm: Array, half: float) -> Iterator[tuple[float, float]]:
    """Where another primitive stands out above the seat within the foot's width."""
    start, end = (
        T_foot_palm[:3, :3] @ p + T_foot_palm[:3, 3] for p in (shape.start_mm, shape.end_mm)
    )
    count = 2 + int(np.linalg.norm(end - start) / AXIS_STEP_MM)
    for centre in np.linspace(start, end, count):
        square = shape.radius_mm**2 - centre[2] ** 2
        reach = math.sqrt(square) if square > 0 and centre[2] > -shape.radius_mm else 0.0
        if reach and abs(centre[1]) < half + reach:
            yield float(centre[0] - reach), float(centre[0] + reach)
