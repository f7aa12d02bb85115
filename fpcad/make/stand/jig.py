"""A jig as a solid: arms with V-notches, stop, spine, column and a foot that slides into the stand's plate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.make.parts.solids import Solid, ball, box, placed, rod, union
from fpcad.make.stand.jig_place import (
    ARM_MORE_MM,
    BEHIND_MM,
    COLUMN_MM,
    FOOT_BEFORE_MM,
    FOOT_MM,
    SPINE_MM,
    STOP_MM,
    JigPlace,
)
from fpcad.spec.tool import CylinderTool

Array = NDArray[np.float64]

RIB_MM, RIB_WIDTH_MM, RIB_STEP_MM = 5.0, 10.0, 2.0
"""Depth of the rib below a foot, width of the first jig's; each further one is wider and fits no narrower channel."""
TOUCH_MM = 0.02
"""Notches and stop keep that far from the tool: what meets is not to overlap in numbers."""
KNOB_MM = 0.5
"""Balls at both ends of the spine stand out by so much: of surfaces that touch along a line, the kernel loses pieces."""


def jig_solid(place: JigPlace, tool: CylinderTool, floor_mm: float, number: int) -> Solid:
    """The jig in the stand's frame; `number` tells the width of its rib."""
    low, high = place.spine
    foot_at = np.array([low[0], low[1], floor_mm])
    arms = [_arm(place, along, tool.radius_mm) for along in place.along_mm]
    stop = rod(
        place.on_axis(place.stop_mm) + place.away, place.on_spine(place.stop_mm), STOP_MM - TOUCH_MM
    )
    corners = [ball(low, COLUMN_MM + KNOB_MM), ball(high, SPINE_MM + KNOB_MM)]
    column = rod(foot_at + np.array([0, 0, FOOT_MM[2] / 2]), low, COLUMN_MM)
    return union(
        [rod(low, high, SPINE_MM), *arms, stop, *corners, column, _foot(place, floor_mm, number)]
    )


def rib_width(number: int) -> float:
    """Width [mm] of the rib below a jig's foot."""
    return RIB_WIDTH_MM + RIB_STEP_MM * number


def foot_frame(place: JigPlace, floor_mm: float) -> Array:
    """T_stand_foot (4, 4): origin on the plate below the column, x away from the hand, z up."""
    low, _ = place.spine
    pose = np.eye(4)
    pose[:3, :3] = np.stack([place.away, np.cross([0, 0, 1], place.away), [0, 0, 1]], axis=1)
    pose[:3, 3] = low[0], low[1], floor_mm
    return pose


def _foot(place: JigPlace, floor_mm: float, number: int) -> Solid:
    """A plate on the stand's, and below it the rib that lies in the channel."""
    length, wide, thick = FOOT_MM
    ends = -FOOT_BEFORE_MM, length - FOOT_BEFORE_MM
    rib = rib_width(number) / 2
    foot = box((ends[0], -wide / 2, 0), (ends[1], wide / 2, thick))
    foot = foot.fuse(box((ends[0], -rib, -RIB_MM), (ends[1], rib, thick / 2)))
    return placed(foot, foot_frame(place, floor_mm))


def _arm(place: JigPlace, along: float, radius: float) -> Solid:
    """From the spine to the tool's axis, less a V of a right angle that opens towards the hand."""
    tip, root = place.on_axis(along), place.on_spine(along)
    arm = rod(tip, root, radius + ARM_MORE_MM)
    return arm.cut(placed(_notch(radius + TOUCH_MM), _notch_frame(place, along)))


def _notch_frame(place: JigPlace, along: float) -> Array:
    """T_stand_notch (4, 4): x along the tool's axis, z away from the hand and across the axis."""
    x_axis = place.T_stand_tool[:3, 0]
    z_axis = place.away - (place.away @ x_axis) * x_axis
    z_axis = z_axis / np.linalg.norm(z_axis)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([x_axis, np.cross(z_axis, x_axis), z_axis], axis=1)
    pose[:3, 3] = place.on_axis(along)
    return pose


def _notch(radius: float) -> Solid:
    """Prism along x with its edge at z = radius sqrt(2): both sides touch a rod of this radius."""
    edge, far = radius * np.sqrt(2.0), BEHIND_MM
    square = box((-far, 0, 0), (far, 2 * far, 2 * far)).rotate((0, 0, 0), (1, 0, 0), -135)
    return square.translate((0, 0, float(edge)))
