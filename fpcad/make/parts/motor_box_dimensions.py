"""Where everything of the motor box sits. docs/parts.md, "Motor box".

Frame B [mm]: origin in the middle of the box's front face, which the hand is bolted to; z into the box,
x along the rows of motors, y across the two rows. Row +1 lies at y > 0; row -1 is row +1 turned
by half a turn about z.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fpcad.make.parts.catalogue import MotorBody, Nut, lookup
from fpcad.make.parts.part import Array
from fpcad.make.parts.spool import Spool, spool_dimensions
from fpcad.make.parts.tension_carriage import (
    BRIDGE_MM,
    SEAT_MM,
    TRAVEL_MM,
    Carriage,
    carriage_dimensions,
)
from fpcad.spec.schema import Spec

Point = tuple[float, float, float]

MOTORS_PER_FINGER = 3
FLANGE_DISC_MM = 63.0
"""ISO 9409-1-50-4-M6: diameter of the flange."""
FLANGE_CIRCLE_MM = 50.0
"""The same: diameter of the circle of its four screws, which lie at 45 deg to x and y."""
PILOT_MM = 31.5
"""The same: diameter of its locating recess."""
PILOT_DEPTH_MM = 6.2
"""Depth of that recess."""
FLANGE_SCREW = "M6"
PLATE_MM = 8.0
"""Thickness of the front plate."""
NUT_WEB_MM = 4.0
"""What the flange's screws clamp: front plate below the nuts."""
SEAT_DEPTH_MM = 6.0
"""How deep the flexors' tubes sit in the front plate."""
TOWER_MM = 1.6
"""Walls of the carriages' rooms."""
WEB_MM = 2.0
"""Wall between neighbouring motors."""
LANE_MM = 12.0
"""Between the backs of the two rows: plugs and cables lie there."""
SLOT_MM = 0.5
"""What the slot that the horn passes is wider than the horn, on each side."""
LIP_MM = 2.4
"""Thickness of the lips that hold the motors along their shafts."""
END_WALL_MM = 2.4
"""Beyond the last motor's wall."""
BOSS_MM = 8.2
"""Width of the columns that hold the back plate's screws."""
FREE_MM = 0.5
"""Between what turns and what stands."""
PORT_MARGIN_MM = 1.0
"""Tubes keep that far from the flange's disc."""
EASY_MM = 0.3
"""Printed holes for nuts and heads are wider than these by this, in diameter."""
BACK_MM = 5.0
"""Thickness of the back plate."""
BACK_DISC_MM = 6.0
"""What the back plate is thicker where the robot's flange lies."""


@dataclass(frozen=True)
class MotorSlot:
    """One motor's place in the box."""

    row: int
    """+1 or -1: the side of y that its horn looks to."""
    shaft: Point
    """The shaft's axis, on the horn's face, in B."""
    flexor_port: Point
    """Where the flexor's tube ends in the front plate, in B; it leaves along -z."""
    extensor_port: Point
    """Where the extensor's tube ends in its carriage, in B, in the middle of the carriage's travel."""
    flexor_straight_mm: float
    """Length of strand from the tube's end to where it meets the spool."""
    extensor_straight_mm: float
    """The same of the extensor, in the middle of the carriage's travel."""

    @property
    def T_box_motor(self) -> Array:
        """Pose (4, 4) [mm] of motor and spool: z out of the horn, y to the motor's far end."""
        pose = np.eye(4)
        pose[:3, :3] = np.array([[-self.row, 0, 0], [0, 0, self.row], [0, 1, 0]])
        pose[:3, 3] = self.shaft
        return pose


@dataclass(frozen=True)
class MotorBox:
    """Lengths [mm] of a motor box and the places in it."""

    motor_type: str
    slots: tuple[MotorSlot, ...]
    """Row +1 with rising x, then row -1 with rising x."""
    per_row: int
    """Places in a row; row -1 may have one motor less."""
    pitch: float
    """Between shafts of one row."""
    body_inner: float
    """|y| of the motors' backs."""
    front_room: float
    """z up to which ports and carriages may reach."""
    motor_front: float
    """z of the motors' front ends."""
    spool: Spool
    carriage: Carriage

    @property
    def body(self) -> MotorBody:
        """The motor's row in the catalogue."""
        return lookup("motor_bodies", MotorBody, self.motor_type)

    @property
    def body_outer(self) -> float:
        """|y| of the motors' faces that the horns stand out of."""
        return self.horn_face - self.body.horn_height_mm

    @property
    def horn_face(self) -> float:
        """|y| of the horns' faces, where the spools begin."""
        return self.body_inner + self.body.depth_mm

    @property
    def extensor_y(self) -> float:
        """|y| of the extensors' tubes."""
        return self.horn_face + self.spool.extensor_z

    @property
    def plate_half_y(self) -> float:
        """Half of the front plate in y."""
        return self.extensor_y + self.carriage.high + self.carriage.clearance + TOWER_MM

    @property
    def wall_x(self) -> float:
        """Outer |x| of the end walls."""
        return self.per_row * self.pitch / 2 + END_WALL_MM

    @property
    def back_inner(self) -> float:
        """Z of the back plate's inner face."""
        return self.motor_front + self.body.height_mm + self.body.gap_mm

    @property
    def size(self) -> Point:
        """Extents along x, y and z, from the front face to the one that the robot's flange meets."""
        z = self.back_inner + BACK_MM + BACK_DISC_MM
        return 2 * (self.wall_x + BOSS_MM), 2 * self.plate_half_y, z

    @property
    def flange_circle_mm(self) -> float:
        """Diameter of the circle of the four M6 screws, at 45 deg."""
        return FLANGE_CIRCLE_MM

    @property
    def flange_holes(self) -> tuple[tuple[float, float], ...]:
        """x, y of the four M6 screws of either flange."""
        at = FLANGE_CIRCLE_MM / 2 * math.sqrt(0.5)
        return (at, at), (-at, at), (-at, -at), (at, -at)

    @property
    def flange_screw_z(self) -> tuple[float, float]:
        """Z that the tips of the hand's M6 screws must reach, to fill the nuts, and may reach."""
        nut_end = NUT_WEB_MM + lookup("nuts", Nut, FLANGE_SCREW).height_mm
        return nut_end, self.motor_front - FREE_MM

    @property
    def pilot_mm(self) -> tuple[float, float]:
        """Diameter and depth of the recess in the front face; a boss must be smaller than both."""
        return PILOT_MM, PILOT_DEPTH_MM


def motor_box_dimensions(spec: Spec, fingers: int) -> MotorBox:
    """The box for the motors of so many fingers; :class:`fpcad.errors.MakeError` where it has no room."""
    body = lookup("motor_bodies", MotorBody, spec.motors.type)
    spool, carriage = spool_dimensions(spec), carriage_dimensions(spec.print)
    motors = MOTORS_PER_FINGER * fingers
    per_row = -(-motors // 2)
    room = max(carriage.room_end, PLATE_MM)
    shaft_z = room + FREE_MM + spool.flange
    pitch = _pitch(body, spool, carriage)
    inner = max(LANE_MM / 2, _clear_of_flange(per_row, pitch, body, spool, carriage))
    horn_face = inner + body.depth_mm
    row = [(n - (per_row - 1) / 2) * pitch for n in range(per_row)]
    slots = tuple(
        _slot(side, (x, side * horn_face, shaft_z), spool)
        for side, count in ((1, per_row), (-1, motors - per_row))
        for x in row[:count]
    )
    front = shaft_z - body.shaft_from_end_mm
    return MotorBox(spec.motors.type, slots, per_row, pitch, inner, room, front, spool, carriage)


def _pitch(body: MotorBody, spool: Spool, carriage: Carriage) -> float:
    """Between neighbouring shafts: bodies with their gaps and wall, spools, and ports side by side."""
    port = carriage.tube + carriage.insert_wall
    tower = carriage.half_width + carriage.clearance + TOWER_MM
    return max(
        body.width_mm + 2 * body.gap_mm + WEB_MM,
        2 * spool.flange + FREE_MM,
        2 * spool.pitch + tower + port,
    )


def _clear_of_flange(
    per_row: int, pitch: float, body: MotorBody, spool: Spool, carriage: Carriage
) -> float:
    """|y| from which the motors must begin so that no tube meets the flange's disc."""
    radius = FLANGE_DISC_MM / 2 + PORT_MARGIN_MM + carriage.tube_pass
    shafts = [(n - (per_row - 1) / 2) * pitch for n in range(per_row)]
    ports = (-spool.pitch, spool.flexor_z), (spool.pitch, spool.extensor_z)
    needs = [
        math.sqrt(max(radius**2 - (shaft + beside) ** 2, 0.0)) - body.depth_mm - along
        for shaft in shafts
        for beside, along in ports
    ]
    return max(needs)


def _slot(row: int, shaft: Point, spool: Spool) -> MotorSlot:
    x, y, z = shaft
    flexor_z, extensor_z = SEAT_DEPTH_MM, BRIDGE_MM + TRAVEL_MM / 2 + SEAT_MM
    return MotorSlot(
        row,
        shaft,
        flexor_port=(x - row * spool.pitch, y + row * spool.flexor_z, flexor_z),
        extensor_port=(x + row * spool.pitch, y + row * spool.extensor_z, extensor_z),
        flexor_straight_mm=z - flexor_z,
        extensor_straight_mm=z - extensor_z,
    )
