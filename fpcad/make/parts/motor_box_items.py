"""What is bought for the motor box, each piece where it sits. docs/parts.md, "Motor box"."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import trimesh

from fpcad.make.parts.bought import BoughtItem
from fpcad.make.parts.box_back import BACK_SCREW, COUNTERBORE_MM, back_screw_length, boss_places
from fpcad.make.parts.catalogue import Insert, MotorBody, Nut, Screw, lookup
from fpcad.make.parts.fasteners import insert_mesh, nut_mesh, screw_mesh
from fpcad.make.parts.motor_box import carriage_places
from fpcad.make.parts.motor_box_dimensions import (
    BACK_DISC_MM,
    BACK_MM,
    FLANGE_SCREW,
    NUT_WEB_MM,
    MotorBox,
    motor_box_dimensions,
)
from fpcad.make.parts.part import FIXED_LINK, Array
from fpcad.make.parts.spool import centre_screw_length, horn_screw_length
from fpcad.make.parts.tension_carriage import LENGTH_MM, SCREW
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec

SECTIONS = 48
ROBOT_THREAD_MM = 6.0
"""How far the back's M6 screws reach at least into the robot's flange."""
DOWN = np.diag([1.0, -1.0, -1.0, 1.0])
"""A half turn about x: what looked along z looks along -z."""


def box_items(spec: Spec, fingers: int, T_palm_box: Array) -> tuple[BoughtItem, ...]:
    """The box's bought items, fixed to the palm at a pose (4, 4) [mm].

    The four M6 screws between the hand's flange and the box are not among them: their length is the
    flange's matter (see :attr:`MotorBox.flange_screw_z`).
    """
    b = motor_box_dimensions(spec, fingers)
    items = _motors(b), *_spool_screws(b), *_tensioners(b), *_back(b), *_flange(b)
    return tuple(
        BoughtItem(**{**vars(item), "places": tuple(T_palm_box @ place for place in item.places)})
        for item in items
    )


def motor_mesh(body: MotorBody) -> trimesh.Trimesh:
    """A motor's envelope in its own frame: the origin on the horn's face, z out of it, y to the far end."""
    end, half = body.shaft_from_end_mm, body.width_mm / 2
    low = np.array([-half, -end, -body.depth_mm])
    high = np.array([half, body.height_mm - end, -body.horn_height_mm])
    case = trimesh.creation.box(bounds=np.array([low, high]))
    horn = trimesh.creation.cylinder(
        body.horn_diameter_mm / 2, 2 * body.horn_height_mm, sections=SECTIONS
    )
    horn.apply_translation((0, 0, -body.horn_height_mm))
    return trimesh.boolean.union([case, horn], engine="manifold")


def _motors(b: MotorBox) -> BoughtItem:
    places = tuple(slot.T_box_motor for slot in b.slots)
    mass, mesh = motor(b.motor_type).mass_g, motor_mesh(b.body)
    return BoughtItem("motor", "motors", b.motor_type, FIXED_LINK, places, len(places), mass, mesh)


def _spool_screws(b: MotorBox) -> list[BoughtItem]:
    """The horns' screws, whose heads drive the spools, and the screws along the shafts."""
    spool, body = b.spool, b.body
    on_horn = [_at((x, y, spool.head_proud), DOWN) for x, y in spool.head_places]
    centre = _at((0, 0, spool.height), DOWN)
    poses = [slot.T_box_motor for slot in b.slots]
    return [
        _screw("horn_screw", body.horn_screw, horn_screw_length(body),
               [T @ place for T in poses for place in on_horn]),
        _screw("spool_screw", body.centre_screw, centre_screw_length(body, spool),
               [T @ centre for T in poses]),
    ]  # fmt: skip


def _tensioners(b: MotorBox) -> list[BoughtItem]:
    """A screw from the front and an insert in each carriage, at mid travel."""
    c = b.carriage
    at_insert = _at((0, c.screw_y, LENGTH_MM - c.insert_depth), np.eye(4))
    screws = []
    for place in carriage_places(b):
        place = place @ _at((0, c.screw_y, 0), np.eye(4))
        place[2, 3] = 0.0  # the head stays on the front face
        screws.append(place)
    inserts = [place @ at_insert for place in carriage_places(b)]
    return [
        _screw("tension_screw", SCREW, c.screw_length, screws),
        _insert("tension_insert", SCREW, inserts),
    ]


def _back(b: MotorBox) -> list[BoughtItem]:
    """What holds the back plate, and what bolts it to a robot."""
    outside, insert = b.back_inner + BACK_MM, lookup("inserts", Insert, BACK_SCREW)
    m6 = lookup("screws", Screw, FLANGE_SCREW)
    head, web = b.back_inner + COUNTERBORE_MM, BACK_MM + BACK_DISC_MM - COUNTERBORE_MM
    length = m6.shortest(web + ROBOT_THREAD_MM)
    return [
        _screw("back_screw", BACK_SCREW, back_screw_length(),
               [_at((x, y, outside), DOWN) for x, y in boss_places(b)]),
        _insert("back_insert", BACK_SCREW,
                [_at((x, y, b.back_inner - insert.length_mm), np.eye(4)) for x, y in boss_places(b)]),
        _screw("robot_screw", FLANGE_SCREW, length,
               [_at((x, y, head), np.eye(4)) for x, y in b.flange_holes]),
    ]  # fmt: skip


def _flange(b: MotorBox) -> list[BoughtItem]:
    """The nuts that the hand's flange is bolted to."""
    nut = lookup("nuts", Nut, FLANGE_SCREW)
    places = tuple(_at((x, y, NUT_WEB_MM), np.eye(4)) for x, y in b.flange_holes)
    mesh, count = nut_mesh(nut), len(places)
    return [BoughtItem("flange_nut", "nuts", nut.size, FIXED_LINK, places, count, nut.mass_g, mesh)]


def _screw(name: str, size: str, length: float, places: Iterable[Array]) -> BoughtItem:
    row, where = lookup("screws", Screw, size), tuple(places)
    mesh, mass = screw_mesh(row, length), row.mass_g(length)
    return BoughtItem(name, "screws", size, FIXED_LINK, where, len(where), mass, mesh, length)


def _insert(name: str, size: str, places: Iterable[Array]) -> BoughtItem:
    row, where = lookup("inserts", Insert, size), tuple(places)
    mesh = insert_mesh(row)
    return BoughtItem(name, "inserts", size, FIXED_LINK, where, len(where), row.mass_g, mesh)


def _at(point: tuple[float, float, float], turn: Array) -> Array:
    pose = turn.copy()
    pose[:3, 3] = point
    return pose
