"""Every row of the catalogue is complete, has a source, and makes a solid."""

from __future__ import annotations

import pytest

from fpcad.errors import FpcadError
from fpcad.make.parts.catalogue import (
    TABLES,
    Bearing,
    Flange,
    Insert,
    Metal,
    MotorBody,
    Nut,
    Pin,
    Screw,
    Tendon,
    Tube,
    lookup,
    table,
)
from fpcad.make.parts.knuckle import finger_needed, knuckle
from fpcad.make.parts.solids import Solid, box, rod
from fpcad.spec.catalogue import motor_types

ROWS = [(name, size) for name in TABLES for size in table(name)]


def along_z(length: float, outer: float, inner: float = 0.0) -> Solid:
    solid = rod((0, 0, 0), (0, 0, length), outer / 2)
    return solid.cut(rod((0, 0, -1), (0, 0, length + 1), inner / 2)) if inner else solid


def solid_of(row: object) -> Solid:
    match row:
        case Bearing() | Insert():
            bore = row.bore_mm if isinstance(row, Bearing) else row.thread_mm
            width = row.width_mm if isinstance(row, Bearing) else row.length_mm
            return along_z(width, row.outer_mm, bore)
        case Pin():
            return along_z(max(row.lengths_mm), row.diameter_mm)
        case Screw():
            head = rod((0, 0, -row.head_height_mm), (0, 0, 0.1), row.head_diameter_mm / 2)
            return along_z(max(row.lengths_mm), row.thread_mm).fuse(head)
        case Nut():
            return along_z(row.height_mm, row.across_flats_mm, row.thread_mm)
        case Tube():
            return along_z(100.0, row.outer_mm, row.inner_mm)
        case Tendon():
            return along_z(100.0, row.diameter_mm)
        case Flange():
            disc = along_z(row.disc_mm, row.outer_mm)
            return disc.fuse(
                rod((0, 0, 0), (0, 0, row.disc_mm + row.boss_height_mm), row.boss_mm / 2)
            )
        case Metal():
            return box((0, 0, 0), (10, 10, 10))
        case MotorBody():
            return box((0, 0, 0), (row.width_mm, row.height_mm, row.depth_mm))
    raise AssertionError(f"no solid for {row}")


@pytest.mark.parametrize(("name", "size"), ROWS)
def test_every_row_makes_a_solid_and_names_its_source(name, size):
    row = table(name)[size]
    solid = solid_of(row)
    assert solid.isValid() and solid.Volume() > 0 and len(solid.Solids()) == 1
    assert len(row.model_dump()["source"]) > 20


def test_every_motor_has_a_body():
    assert tuple(table("motor_bodies")) == motor_types()


def test_screws_fit_through_their_holes_and_not_through_their_heads():
    for size in table("screws"):
        row = lookup("screws", Screw, size)
        assert row.thread_mm < row.clearance_hole_mm < row.head_diameter_mm


def test_an_unknown_row_is_told_with_its_neighbour():
    with pytest.raises(FpcadError, match=r'bearings: no "MR62".*did you mean "MR63"'):
        lookup("bearings", Bearing, "MR62")


@pytest.mark.parametrize(
    ("size", "needs"), [("MR52", 13.2), ("MR63", 13.9), ("MR74", 14.7), ("623", 19.6)]
)
def test_bearings_need_fingers_as_decided(size, needs):
    assert finger_needed(lookup("bearings", Bearing, size), 0.2, 1.5) == pytest.approx(
        needs, abs=0.05
    )


def test_the_largest_bearing_that_fits_is_taken():
    taken = []
    for diameter in (12.0, 13.5, 14.0, 15.0, 19.8):
        found = knuckle(diameter / 2 - 1.7, 0.2)
        assert found is not None
        taken.append(found.bearing.size)
    assert taken == ["BUSH-2", "MR52", "MR63", "MR74", "623"]
    assert knuckle(3.0, 0.2) is None


def test_pins_come_in_lengths():
    pin = lookup("pins", Pin, "D2")
    assert (pin.shortest(7.0), pin.longest(7.0)) == (8.0, 6.0)
    with pytest.raises(FpcadError, match=r"D2: none is sold of 99\.0 mm or longer"):
        pin.shortest(99.0)
