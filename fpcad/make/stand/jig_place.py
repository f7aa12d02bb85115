"""Where a jig may hold a tool: searched among directions to draw it away, and places along the tool.

A jig is two arms with V-notches and a stop at one of the tool's ends, on a spine, on a column that
stands on the stand's plate. All of it is capsules here, and keeps a clearance to the hand's capsules
from the pose on until it is drawn away.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from fpcad.make.grip import segment_distance
from fpcad.make.stand.scene import Capsules, PoseScene
from fpcad.spec.tool import CylinderTool

Array = NDArray[np.float64]

CLEAR_MM = 1.5
"""Least distance of a jig to the hand, at the pose, opened, and while it is drawn away."""
AWAY_MM, AWAY_STEP_MM = 90.0, 4.5
"""How far a jig is drawn away in a straight line, and at what steps it is looked at."""
DIRECTIONS = 36
ACROSS = 0.35
"""Largest product of the tool's axis and the direction: the notches must hold the tool across it."""
ALONG_STEP_MM, APART_MM, END_MM = 6.0, 24.0, 6.0
"""Between places tried along the tool; least distance of both arms, and of an arm to the tool's ends."""
ARM_MORE_MM = 2.5
"""Radius of an arm beyond the tool's."""
PLENTY_MM = 6.0
"""Beyond this clearance arms farther apart are better than more of it."""
APART_WORTH = 0.03
"""A millimetre between the arms counts as so much clearance."""
BEHIND_MM = 24.0
"""From the tool's axis to the spine's."""
SPINE_MM, COLUMN_MM, STOP_MM = 6.0, 7.0, 4.0
"""Radii."""
FOOT_MM = (48.0, 30.0, 6.0)
"""Length along the channel, width and thickness of a foot."""
FOOT_BEFORE_MM = 12.0
"""What of a foot lies before the column, on the hand's side."""
WALL_MM = 25.0
"""A jig keeps that far from the stand's upright wall."""


@dataclass(frozen=True)
class JigPlace:
    """One jig, in the stand's frame [mm]."""

    pose: str
    away: Array
    """(3,) level unit vector in which it is drawn away."""
    along_mm: tuple[float, float]
    """Places of both arms along the tool's axis, in the tool's frame."""
    stop_mm: float
    """Place of the stop's axis along the tool's."""
    T_stand_tool: Array  # (4, 4)
    clearance_mm: float
    """Least distance to the hand's capsules, all along."""

    def on_axis(self, along_mm: float) -> Array:
        """Point (3,) of the tool's axis."""
        return self.T_stand_tool[:3, 3] + along_mm * self.T_stand_tool[:3, 0]

    def on_spine(self, along_mm: float) -> Array:
        """Point (3,) of the spine's axis."""
        return self.on_axis(along_mm) + BEHIND_MM * self.away

    @property
    def foot(self) -> Array:
        """Corners (4, 2) [mm] of the foot."""
        before, after = -FOOT_BEFORE_MM, FOOT_MM[0] - FOOT_BEFORE_MM
        level, side = self.away[:2], np.array([-self.away[1], self.away[0]])
        at, half = self.spine[0][:2], FOOT_MM[1] / 2
        return np.array([at + x * level + y * side for x in (before, after) for y in (-half, half)])

    @property
    def merit(self) -> float:
        """What jigs are compared by [mm]."""
        apart = self.along_mm[1] - self.along_mm[0]
        return min(self.clearance_mm, PLENTY_MM) + APART_WORTH * apart

    @property
    def spine(self) -> tuple[Array, Array]:
        """Both ends of the spine, the lower one first."""
        places = (*self.along_mm, self.stop_mm)
        ends = self.on_spine(min(places)), self.on_spine(max(places))
        return (ends[0], ends[1]) if ends[0][2] <= ends[1][2] else (ends[1], ends[0])


def find_place(
    scene: PoseScene, tool: CylinderTool, floor_mm: float, half_width_mm: float
) -> JigPlace | float:
    """The best jig, or the largest clearance [mm] that any has where that is too little.

    Feet stay within `half_width_mm` to both sides of the stand's middle.
    """
    best: JigPlace | None = None
    for place in _places(scene, tool, floor_mm):
        if np.abs(place.foot[:, 1]).max() > half_width_mm:
            continue
        if best is None or place.merit > best.merit:
            best = place
    if best is None:
        return -np.inf
    return best if best.clearance_mm >= CLEAR_MM else best.clearance_mm


def _places(scene: PoseScene, tool: CylinderTool, floor_mm: float) -> Iterator[JigPlace]:
    axis = scene.T_stand_tool[:3, 0]
    along = np.arange(tool.back_mm + END_MM, tool.tip_mm - END_MM + 1e-9, ALONG_STEP_MM)
    for away in _directions(axis):
        room = {s: _arm_room(scene, away, s, tool.radius_mm + ARM_MORE_MM) for s in along}
        free = [s for s in along if room[s] >= CLEAR_MM]
        stops = [
            (end, _arm_room(scene, away, end, STOP_MM))
            for end, outward in ((tool.back_mm - STOP_MM, -axis), (tool.tip_mm + STOP_MM, axis))
            if outward @ away >= -1e-9
        ]
        pairs = [(float(a), float(b)) for a, b in combinations(free, 2) if b - a >= APART_MM]
        for stop, stop_room in stops:
            if stop_room < CLEAR_MM:
                continue
            beams: dict[float, float] = {}
            for a, b in pairs:
                place = JigPlace(scene.pose, away, (a, b), stop, scene.T_stand_tool, 0.0)
                far = max(a, b, key=lambda s, stop=stop: abs(s - stop))
                if far not in beams:  # the spine runs from the stop to the farther arm
                    beams[far] = _frame_room(scene, place, floor_mm)
                yield replace(place, clearance_mm=min(room[a], room[b], stop_room, beams[far]))


def _directions(axis: Array) -> Iterator[Array]:
    """Level directions across the tool that do not lead to the stand's wall."""
    for angle in np.linspace(-np.pi, np.pi, DIRECTIONS, endpoint=False):
        away = np.array([np.cos(angle), np.sin(angle), 0.0])
        if abs(away @ axis) <= ACROSS and away[0] > -0.2:
            yield away


def _arm_room(scene: PoseScene, away: Array, along: float, radius: float) -> float:
    at = scene.T_stand_tool[:3, 3] + along * scene.T_stand_tool[:3, 0]
    return _room(scene.obstacles, at + radius * away, at + BEHIND_MM * away, radius, away)


def _frame_room(scene: PoseScene, place: JigPlace, floor_mm: float) -> float:
    """Clearance of spine and column."""
    low, high = place.spine
    foot = np.array([low[0], low[1], floor_mm])
    if low[0] < WALL_MM or low[2] - COLUMN_MM < floor_mm:
        return -np.inf
    spine = _room(scene.obstacles, low, high, SPINE_MM, place.away)
    return min(spine, _room(scene.obstacles, low, foot, COLUMN_MM, place.away))


def _room(hand: Capsules, start: Array, end: Array, radius: float, away: Array) -> float:
    """Least distance of a capsule to the hand while it is drawn away."""
    steps = np.arange(0.0, AWAY_MM + 1e-9, AWAY_STEP_MM)[:, None, None] * away
    a, b = start + steps, end + steps  # (T, 1, 3)
    shape = (len(steps), len(hand.radii), 3)
    a, b = (np.broadcast_to(points, shape).reshape(-1, 3) for points in (a, b))
    c, d = (np.broadcast_to(points, shape).reshape(-1, 3) for points in (hand.starts, hand.ends))
    apart = np.asarray(segment_distance(a, b, c, d)).reshape(shape[:2])
    return float((apart - hand.radii).min()) - radius
