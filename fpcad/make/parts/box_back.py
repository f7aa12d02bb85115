"""The motor box's back plate: it closes the box, and a robot's flange fits on it. docs/parts.md, "Motor box"."""

from __future__ import annotations

from fpcad.make.parts.catalogue import Insert, Screw, lookup
from fpcad.make.parts.motor_box_dimensions import (
    BACK_DISC_MM,
    BACK_MM,
    BOSS_MM,
    EASY_MM,
    FLANGE_DISC_MM,
    FLANGE_SCREW,
    LIP_MM,
    PILOT_MM,
    MotorBox,
)
from fpcad.make.parts.motor_walls import TONGUE_MM, in_row, inner_walls, tongues, web_half
from fpcad.make.parts.solids import Solid, box, rod
from fpcad.spec.hardware import Print

BOSS_PLACE = 0.6
"""|y| of the back plate's screws, as a share of that of the motors' outer faces."""
BACK_SCREW = "M3"
PILOT_BOSS_MM = 5.8
"""Height of the back plate's boss."""
COUNTERBORE_MM = 6.3
"""Depth of the counterbores of the robot's M6 screws."""


def back_solid(b: MotorBox, settings: Print) -> Solid:
    """The back plate: slots for the walls' tongues inside, the robot's flange outside."""
    z, gap = b.back_inner, settings.clearance_mm
    half_y = b.body_outer + gap + LIP_MM
    x = b.wall_x + BOSS_MM
    body = box((-x, -half_y, z), (x, half_y, z + BACK_MM))
    face = z + BACK_MM + BACK_DISC_MM
    body = body.fuse(rod((0, 0, z + 1), (0, 0, face), FLANGE_DISC_MM / 2))
    boss = (PILOT_MM - settings.slip_mm) / 2
    body = body.fuse(rod((0, 0, z + 1), (0, 0, face + PILOT_BOSS_MM), boss))
    cuts = []
    for wall_x in inner_walls(b):
        half = web_half(b) + gap
        for low, high in tongues(b):
            slot = box((-half, low - gap, z - 1), (half, high + gap, z + TONGUE_MM + gap))
            cuts += [in_row(slot.translate((wall_x, 0, 0)), row) for row in (1, -1)]
    m6, m3 = (lookup("screws", Screw, size) for size in (FLANGE_SCREW, BACK_SCREW))
    head = (m6.head_diameter_mm + EASY_MM) / 2
    for x, y in b.flange_holes:
        cuts.append(rod((x, y, z - 1), (x, y, face + 1), m6.clearance_hole_mm / 2))
        cuts.append(rod((x, y, z - 1), (x, y, z + COUNTERBORE_MM), head))
    for x, y in boss_places(b):
        cuts.append(rod((x, y, z - 1), (x, y, z + BACK_MM + 1), m3.clearance_hole_mm / 2))
    return body.cut(*cuts).clean()


def boss_places(b: MotorBox) -> list[tuple[float, float]]:
    """x, y of the screws that hold the back plate."""
    x, y = b.wall_x + BOSS_MM / 2, BOSS_PLACE * b.body_outer
    return [(sx * x, sy * y) for sx in (-1, 1) for sy in (-1, 1)]


def back_screw_length() -> float:
    """Length [mm] of the back plate's screws."""
    insert = lookup("inserts", Insert, BACK_SCREW)
    return lookup("screws", Screw, BACK_SCREW).shortest(BACK_MM + insert.length_mm)
