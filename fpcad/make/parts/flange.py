"""The flange: a saddle foot on the palm's back, a stem, and the disc that a robot or the motors' box takes."""

from __future__ import annotations

import math

import numpy as np

from fpcad.make.parts.bought import BoughtItem
from fpcad.make.parts.catalogue import Insert, Screw
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.fasteners import insert_mesh, screw_mesh
from fpcad.make.parts.flange_dimensions import KEY_MM, PAD_MM, STEM_MM, FlangeDimensions
from fpcad.make.parts.part import FIXED_LINK, Array
from fpcad.make.parts.solids import Solid, box, palm_primitive, placed, rod
from fpcad.make.toolchain import cadquery
from fpcad.model.geometry import HandGeometry


def flange_solid(f: FlangeDimensions, geometry: HandGeometry, d: Dimensions) -> Solid:
    """The flange in H; its boss is slimmer than its recess by the print's clearance, in diameter."""
    foot = placed(_foot(f), f.T_palm_foot)
    foot = foot.cut(*[palm_primitive(shape, 0.0) for shape in geometry.palm])
    above = placed(_tongue(f).fuse(_stem(f), _disc(f, d.clearance)), f.T_palm_foot)
    holes = [placed(hole, f.T_palm_foot) for hole in (*_foot_holes(f), *_disc_holes(f))]
    return foot.fuse(above).cut(*holes).clean()


def palm_seat(f: FlangeDimensions, clearance: float) -> list[Solid]:
    """What the palm must leave free for the foot, in H: all above the seat, and the inserts' holes."""
    x, y = f.half_length + clearance, f.half_width + clearance
    room = box((-x, -y, 0.0), (x, y, f.stem))
    radius = f.insert.hole_mm / 2
    holes = [rod((s, 0, -f.insert_depth), (s, 0, 1.0), radius) for s in _both(f.screw_at)]
    return [placed(cut, f.T_palm_foot) for cut in (room, *holes)]


def flange_items(f: FlangeDimensions) -> tuple[BoughtItem, ...]:
    """Inserts and screws of the foot, and the screws of the disc with their heads towards the hand."""
    down = np.diag([1.0, -1.0, -1.0, 1.0])
    seat = tuple(_place(f, s, 0.0, 0.0) @ down for s in _both(f.screw_at))
    pad = tuple(_place(f, s, 0.0, PAD_MM) @ down for s in _both(f.screw_at))
    under = f.stem - f.flange.disc_mm
    disc = tuple(_place(f, x, y, under) for x, y in f.screw_places)
    return (
        _insert("flange_foot_insert", f.insert, seat),
        _screw("flange_foot_screw", f.screw, f.screw_length, pad),
        _screw("flange_screw", f.flange_screw, f.flange_screw_length, disc),
    )


def _screw(name: str, row: Screw, length: float, places: tuple[Array, ...]) -> BoughtItem:
    mesh, mass, count = screw_mesh(row, length), row.mass_g(length), len(places)
    return BoughtItem(name, "screws", row.size, FIXED_LINK, places, count, mass, mesh, length)


def _insert(name: str, row: Insert, places: tuple[Array, ...]) -> BoughtItem:
    mesh, count = insert_mesh(row), len(places)
    return BoughtItem(name, "inserts", row.size, FIXED_LINK, places, count, row.mass_g, mesh)


def _both(x: float) -> tuple[float, float]:
    return -x, x


def _place(f: FlangeDimensions, x: float, y: float, z: float) -> Array:
    shift = np.eye(4)
    shift[:3, 3] = x, y, z
    return f.T_palm_foot @ shift


def _foot(f: FlangeDimensions) -> Solid:
    return box((-f.half_length, -f.half_width, -f.skirt), (f.half_length, f.half_width, PAD_MM))


def _tongue(f: FlangeDimensions) -> Solid:
    """What stands on the seat."""
    return box((-f.half_length, -f.seat_half, 0.0), (f.half_length, f.seat_half, PAD_MM))


def _stem(f: FlangeDimensions) -> Solid:
    return rod((0, 0, PAD_MM / 2), (0, 0, f.stem), STEM_MM)


def _disc(f: FlangeDimensions, clearance: float) -> Solid:
    """The cone below the disc, the disc and the boss."""
    cq, flange = cadquery(), f.flange
    radius, under = flange.outer_mm / 2, f.stem - flange.disc_mm
    cone = cq.Solid.makeCone(
        STEM_MM, radius, under - f.cone_start, cq.Vector(0, 0, f.cone_start), cq.Vector(0, 0, 1)
    )
    disc = rod((0, 0, under), (0, 0, f.stem), radius)
    boss_radius = (flange.boss_mm - clearance) / 2
    boss = rod((0, 0, under), (0, 0, f.stem + flange.boss_height_mm), boss_radius)
    return cone.fuse(disc, boss)


def _foot_holes(f: FlangeDimensions) -> list[Solid]:
    radius = f.screw.clearance_hole_mm / 2
    return [rod((s, 0, -f.insert_depth), (s, 0, PAD_MM + 1), radius) for s in _both(f.screw_at)]


def _disc_holes(f: FlangeDimensions) -> list[Solid]:
    """Holes of the screws, and slots in the cone through which their heads and a key pass from the side."""
    screw, under = f.flange_screw, f.stem - f.flange.disc_mm
    half, found = screw.head_diameter_mm / 2 + KEY_MM, []
    for x, y in f.screw_places:
        found.append(rod((x, y, under - 1), (x, y, f.stem + 1), screw.clearance_hole_mm / 2))
        found.append(rod((x, y, 0.0 + PAD_MM), (x, y, under), half))
        slot = box((math.hypot(x, y), -half, PAD_MM), (f.flange.outer_mm, half, under))
        found.append(slot.rotate((0, 0, 0), (0, 0, 1), math.degrees(math.atan2(y, x))))
    return found
