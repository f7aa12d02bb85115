"""The motor box's solids in its frame B, and its printed parts. docs/parts.md, "Motor box"."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
import trimesh

from fpcad.make.mesh import mesh_of
from fpcad.make.parts.box_back import BACK_SCREW, back_screw_length, back_solid, boss_places
from fpcad.make.parts.catalogue import Insert, Nut, Screw, lookup
from fpcad.make.parts.motor_box_dimensions import (
    BACK_MM,
    BOSS_MM,
    EASY_MM,
    FLANGE_SCREW,
    LIP_MM,
    NUT_WEB_MM,
    PILOT_DEPTH_MM,
    PILOT_MM,
    PLATE_MM,
    SEAT_DEPTH_MM,
    TOWER_MM,
    MotorBox,
    MotorSlot,
    motor_box_dimensions,
)
from fpcad.make.parts.motor_walls import in_row, separators, web_half
from fpcad.make.parts.part import FIXED_LINK, Array, Part
from fpcad.make.parts.solids import FAR_MM, Solid, box, extruded, placed, rod, union
from fpcad.make.parts.spool import spool_solid
from fpcad.make.parts.tension_carriage import (
    BRIDGE_MM,
    TRAVEL_MM,
    carriage_room,
    carriage_solid,
)
from fpcad.make.toolchain import cadquery
from fpcad.spec.hardware import Print
from fpcad.spec.schema import Spec

CONE_SLOPE = 1.25
"""Height by radius of the cone above the front recess: steep enough to be printed without support."""
CABLE_MM = (6.0, 16.0)
"""Width and height of the cables' opening."""
TIE_MM = (1.6, 4.5)
"""Width and height of the two slots for a cable tie."""
TIE_APART_MM = 2.8


def box_solid(b: MotorBox, settings: Print) -> Solid:
    """Front plate, end walls and walls between the motors; open at the back and at both rows' horns."""
    plate = box((-b.wall_x, -b.plate_half_y, 0), (b.wall_x, b.plate_half_y, PLATE_MM))
    gap = settings.clearance_mm
    pieces = [plate, *_end_walls(b, gap)]
    for row in (1, -1):
        pieces += [in_row(piece, row) for piece in separators(b, gap)]
    pieces += [_tower(b, slot) for slot in b.slots]
    cuts = [cut for slot in b.slots for cut in _ports(b, slot, settings)]
    cuts += [*_front_flange(b, settings), *_boss_holes(b), *_cable_way(b)]
    return union(pieces).cut(*cuts).clean()


def carriage_places(b: MotorBox, share: float = 0.5) -> list[Array]:
    """T_box_carriage (4, 4) of each slot; `share` of the travel: 0 tightest, 1 slackest."""
    return [_carriage_place(slot, BRIDGE_MM + share * TRAVEL_MM) for slot in b.slots]


def box_parts(spec: Spec, fingers: int, T_palm_box: Array) -> list[Part]:
    """The box's printed parts, fixed to the palm at a pose (4, 4) [mm]; carriages at mid travel."""
    b = motor_box_dimensions(spec, fingers)
    places = {
        "motor_box": [np.eye(4)],
        "box_back": [np.eye(4)],
        "spool": [slot.T_box_motor for slot in b.slots],
        "tension_carriage": carriage_places(b),
    }
    made = _made(b, spec.print.model_dump_json())
    return [
        Part(
            name,
            FIXED_LINK,
            "endoskeleton",
            len(where),
            *made[name],
            tuple(T_palm_box @ T for T in where),
            _printed(name),
        )
        for name, where in places.items()
    ]


def _printed(name: str) -> Array:
    """Turn to the proposed print orientation: box and back plate stand as in B, the others as is best.

    A half turn about the vertical, because a part that is not turned at all is laid by its own.
    """
    upright = name in ("motor_box", "box_back")
    return np.diag([-1.0, -1.0, 1.0, 1.0]) if upright else np.eye(4)


@cache
def _made(b: MotorBox, print_json: str) -> dict[str, tuple[Solid, trimesh.Trimesh]]:
    """Solid and mesh of each part; they depend on no design, so hands of one spec share them."""
    settings = Print.model_validate_json(print_json)
    solids = {
        "motor_box": box_solid(b, settings),
        "box_back": back_solid(b, settings),
        "spool": spool_solid(b.spool),
        "tension_carriage": carriage_solid(b.carriage),
    }
    return {name: (solid, mesh_of(name, solid, settings)) for name, solid in solids.items()}


def _end_walls(b: MotorBox, gap: float) -> list[Solid]:
    """Closed walls at both ends, with the columns that hold the back plate's screws."""
    half_y, inner = b.body_outer + gap + LIP_MM, b.per_row * b.pitch / 2 - web_half(b)
    walls = [
        box((min(side * inner, side * b.wall_x), -half_y, 0),
            (max(side * inner, side * b.wall_x), half_y, b.back_inner))
        for side in (-1, 1)
    ]  # fmt: skip
    half = BOSS_MM / 2
    for x, y in boss_places(b):
        near = math.copysign(abs(x) - half - 1.0, x)
        far = math.copysign(abs(x) + half, x)
        walls.append(box((min(near, far), y - half, 0), (max(near, far), y + half, b.back_inner)))
    return walls


def _boss_holes(b: MotorBox) -> list[Solid]:
    """Holes for the inserts of the back plate's screws, and beyond them for the screws' ends."""
    insert, screw = lookup("inserts", Insert, BACK_SCREW), lookup("screws", Screw, BACK_SCREW)
    deep = back_screw_length() - BACK_MM + 1.0
    cuts = []
    for x, y in boss_places(b):
        top = b.back_inner
        cuts.append(rod((x, y, top - insert.length_mm), (x, y, top + 1), insert.hole_mm / 2))
        cuts.append(rod((x, y, top - deep), (x, y, top), screw.clearance_hole_mm / 2))
    return cuts


def _front_flange(b: MotorBox, settings: Print) -> list[Solid]:
    """The recess, and four holes with pockets that nuts are put into from behind."""
    radius = (PILOT_MM + settings.slip_mm) / 2
    cuts: list[Solid] = [rod((0, 0, -1), (0, 0, PILOT_DEPTH_MM), radius), _cone(radius)]
    screw, nut = lookup("screws", Screw, FLANGE_SCREW), lookup("nuts", Nut, FLANGE_SCREW)
    half = (nut.across_flats_mm + EASY_MM) / 2
    for x, y in b.flange_holes:
        cuts.append(rod((x, y, -1), (x, y, NUT_WEB_MM + 1), screw.clearance_hole_mm / 2))
        cuts.append(_hexagon(x, y, half, NUT_WEB_MM, b.back_inner + 1))
    return cuts


def _cone(radius: float) -> Solid:
    """What the walls over the recess leave free, so that they are printed without support."""
    cq = cadquery()
    at, up = cq.Vector(0, 0, PILOT_DEPTH_MM), cq.Vector(0, 0, 1)
    return cq.Solid.makeCone(radius, 0.0, CONE_SLOPE * radius, at, up)


def _hexagon(x: float, y: float, half: float, low: float, high: float) -> Solid:
    """A hexagonal prism along z, two of its flats facing x at `half` [mm]."""
    corner = half / math.cos(math.pi / 6)
    around = [math.pi / 6 + n * math.pi / 3 for n in range(6)]
    points = [(x + corner * math.cos(a), y + corner * math.sin(a)) for a in around]
    return extruded(points, low, high)


def _cable_way(b: MotorBox) -> list[Solid]:
    """In the end wall at +x: an opening from the back, and two slots for a tie that takes the cables' pull."""
    (width, height), (slot, high) = CABLE_MM, TIE_MM
    low, inside = b.back_inner - height, b.wall_x - 12.0
    cuts = [box((inside, -width / 2, low), (FAR_MM, width / 2, b.back_inner + 1))]
    for side in (-1, 1):
        near, far = side * TIE_APART_MM / 2, side * (TIE_APART_MM / 2 + slot)
        cuts.append(
            box((inside, min(near, far), low - 4.0 - high), (FAR_MM, max(near, far), low - 4.0))
        )
    return cuts


def _carriage_place(slot: MotorSlot, z: float) -> Array:
    pose = np.diag([slot.row, slot.row, 1.0, 1.0])
    pose[:3, 3] = (*slot.extensor_port[:2], z)
    return pose


def _tower(b: MotorBox, slot: MotorSlot) -> Solid:
    """Walls about a carriage's room, as high as it slides."""
    c = b.carriage
    half, beside = c.half_width + c.clearance + TOWER_MM, c.clearance + TOWER_MM
    tower = box((-half, c.low - beside, 0), (half, c.high + beside, b.front_room))
    return placed(tower, _carriage_place(slot, 0.0))


def _ports(b: MotorBox, slot: MotorSlot, settings: Print) -> Sequence[Solid]:
    """A carriage's room and the other strand's tube seat."""
    c, pose = b.carriage, _carriage_place(slot, 0.0)
    x, y, _ = slot.flexor_port
    return [
        *(placed(room, pose) for room in carriage_room(c, BRIDGE_MM, b.front_room + 1)),
        rod((x, y, -1), (x, y, SEAT_DEPTH_MM), c.tube),
        rod((x, y, 0), (x, y, PLATE_MM + 1), c.strand_way),
    ]
