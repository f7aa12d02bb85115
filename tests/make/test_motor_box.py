"""The motor box: every motor's builds, holds together without interference, and leads its strands straight."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import manifold3d
import numpy as np
import pytest
import trimesh

from fpcad.errors import MakeError
from fpcad.make.gates.all_gates import check_part
from fpcad.make.gates.finding import errors
from fpcad.make.mesh import INTERFERENCE_MM3, manifold_of
from fpcad.make.parts.bought import BoughtItem
from fpcad.make.parts.catalogue import Insert, MotorBody, Screw, lookup
from fpcad.make.parts.fasteners import screw_mesh
from fpcad.make.parts.motor_box import box_parts, carriage_places
from fpcad.make.parts.motor_box_dimensions import (
    BACK_DISC_MM,
    FLANGE_DISC_MM,
    MotorBox,
    motor_box_dimensions,
)
from fpcad.make.parts.motor_box_items import box_items
from fpcad.make.parts.part import Array, Part
from fpcad.make.parts.spool import LEAST_WRAP_RAD, TURN_RAD, spool_dimensions, spool_solid
from fpcad.make.parts.tension_carriage import BRIDGE_MM, LENGTH_MM, SCREW, TRAVEL_MM, carriage_solid
from fpcad.spec.catalogue import motor_types
from fpcad.spec.schema import Spec
from tests.make.hands import CLAY

FINGERS = 4
THREADED = 0.35
"""What of an insert may lie in the plastic that it is melted into."""


@dataclass(frozen=True)
class Built:
    """A box with everything in it, in its own frame."""

    spec: Spec
    box: MotorBox
    parts: dict[str, Part]
    items: dict[str, BoughtItem]


def with_motor(kind: str, **routing: float) -> Spec:
    transmission = CLAY.motors.transmission.model_copy(update=routing)
    motors = CLAY.motors.model_copy(update={"type": kind, "transmission": transmission})
    return CLAY.model_copy(update={"motors": motors})


def body_of(kind: str) -> str:
    """What distinguishes a motor's body, as text."""
    return lookup("motor_bodies", MotorBody, kind).model_dump_json(exclude={"type", "source"})


BODIES = list({body_of(kind): kind for kind in motor_types()}.values())
"""One motor type for each body."""


def build(kind: str) -> Built:
    spec, here = with_motor(kind), np.eye(4)
    parts = {part.name: part for part in box_parts(spec, FINGERS, here)}
    items = {item.name: item for item in box_items(spec, FINGERS, here)}
    return Built(spec, motor_box_dimensions(spec, FINGERS), parts, items)


@pytest.fixture(scope="module", params=BODIES)
def built(request: pytest.FixtureRequest) -> Built:
    return build(request.param)


def solid_at(mesh: trimesh.Trimesh, place: Array) -> manifold3d.Manifold:
    return manifold_of(mesh).transform(place[:3])


def copies(item: Part | BoughtItem) -> list[manifold3d.Manifold]:
    return [solid_at(item.mesh, place) for place in item.places]


def meeting(
    ones: Sequence[manifold3d.Manifold], others: Sequence[manifold3d.Manifold]
) -> Iterator[tuple[int, int, float]]:
    """Which of the ones meet which of the others, and the volume that they share [mm^3]."""
    boxes = [
        np.array([s.bounding_box() for s in some]).reshape(-1, 2, 3) for some in (ones, others)
    ]
    for i, a in enumerate(ones):
        low, high = boxes[0][i]
        near = ((boxes[1][:, 0] <= high) & (boxes[1][:, 1] >= low)).all(axis=1)
        for j in map(int, np.flatnonzero(near)):
            if (volume := (a ^ others[j]).volume()) > INTERFERENCE_MM3:
                yield i, j, volume


@pytest.mark.parametrize("kind", motor_types())
def test_every_motors_box_passes_the_gates_of_parts(kind):
    built = build(kind)
    findings = [f for part in built.parts.values() for f in check_part(built.spec, part)]
    assert errors(findings) == []
    assert {f.gate for f in findings} == {"wall", "bed", "overhang"}
    overhang = {f.part: f.value for f in findings if f.gate == "overhang"}
    assert overhang["motor_box"] < 50  # slots and opening for cables in an end wall


def test_parts_and_items_are_counted(built):
    motors = 3 * FINGERS
    assert {name: part.count for name, part in built.parts.items()} == {
        "motor_box": 1, "box_back": 1, "spool": motors, "tension_carriage": motors,
    }  # fmt: skip
    assert {name: item.count for name, item in built.items.items()} == {
        "motor": motors, "horn_screw": 4 * motors, "spool_screw": motors,
        "tension_screw": motors, "tension_insert": motors,
        "back_screw": 4, "back_insert": 4, "robot_screw": 4, "flange_nut": 4,
    }  # fmt: skip
    assert all(len(item.places) == item.count for item in built.items.values())


def test_nothing_in_the_box_shares_room(built):
    things = [*built.parts.values(), *built.items.values()]
    solids = {thing.name: copies(thing) for thing in things}
    for a in things:
        own = ((i, j) for i, j, _ in meeting(solids[a.name], solids[a.name]) if i != j)
        assert list(own) == [], a.name
    for a, b in combinations(things, 2):
        if isinstance(a, BoughtItem):  # so is b: threads in threads, screws in motors
            continue
        allowed = 0.0
        if isinstance(b, BoughtItem) and b.kind == "inserts":
            allowed = THREADED * solids[b.name][0].volume()
        shared = [v for *_, v in meeting(solids[a.name], solids[b.name]) if v > allowed]
        assert shared == [], f"{a.name} and {b.name}"


def test_strands_leave_their_spool_straight_through_their_ports(built):
    box, pitch = built.box, built.box.spool.pitch
    for slot in box.slots:
        ports = (
            (slot.flexor_port, slot.flexor_straight_mm),
            (slot.extensor_port, slot.extensor_straight_mm),
        )
        sides = []
        for port, straight in ports:
            in_motor = np.linalg.inv(slot.T_box_motor) @ [*port, 1.0]
            sides.append(in_motor[0])
            assert abs(in_motor[0]) == pytest.approx(
                pitch
            )  # a tangent, parallel to the front's normal
            assert in_motor[1] == pytest.approx(-straight)
        assert np.sign(sides).tolist() == [1, -1]
        heights = [abs(port[1]) - box.horn_face for port, _ in ports]
        assert heights == pytest.approx([box.spool.flexor_z, box.spool.extensor_z])


def test_strands_are_free_from_tube_to_spool(built):
    radius = 0.9 * built.box.spool.strand  # a wound strand touches its drum
    rods = []
    for slot in built.box.slots:
        for port in (slot.flexor_port, slot.extensor_port):
            ends = np.array([port, (port[0], port[1], slot.shaft[2])])
            rods.append(manifold_of(trimesh.creation.cylinder(radius, segment=ends, sections=16)))
    for thing in (*built.parts.values(), *built.items.values()):
        assert list(meeting(rods, copies(thing))) == [], thing.name


def test_tubes_leave_beside_the_flange(built):
    for slot in built.box.slots:
        for x, y, _ in (slot.flexor_port, slot.extensor_port):
            assert math.hypot(x, y) > FLANGE_DISC_MM / 2 + 1.0


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_carriages_are_clear_at_both_ends_of_their_travel(built, share):
    mesh, c = built.parts["tension_carriage"].mesh, built.box.carriage
    moved = [solid_at(mesh, place) for place in carriage_places(built.box, share)]
    assert [pair for pair in meeting(moved, moved) if pair[0] != pair[1]] == []
    for name in (
        "motor_box",
        "box_back",
        "spool",
        "motor",
        "horn_screw",
        "spool_screw",
        "tension_screw",
    ):
        thing = built.parts.get(name) or built.items[name]
        assert list(meeting(moved, copies(thing))) == [], name
    front = BRIDGE_MM + share * TRAVEL_MM
    insert = lookup("inserts", Insert, SCREW).length_mm
    assert c.screw_length >= front + LENGTH_MM  # the screw goes all through its insert
    assert front + LENGTH_MM - insert > BRIDGE_MM
    assert TRAVEL_MM >= 6.0


def test_motors_go_in_from_the_back_with_their_spools_on(built):
    frame, box = copies(built.parts["motor_box"]), built.box
    for z in np.arange(0.0, box.back_inner, 6.0):
        for name in ("motor", "spool", "spool_screw"):
            thing = built.parts.get(name) or built.items[name]
            lifted = [solid.translate((0, 0, float(z))) for solid in copies(thing)]
            assert list(meeting(lifted, frame)) == [], f"{name} at {z:g} mm"


def test_nuts_go_in_from_the_back(built):
    frame = copies(built.parts["motor_box"])
    for z in np.arange(0.0, built.box.back_inner, 4.0):
        lifted = [solid.translate((0, 0, float(z))) for solid in copies(built.items["flange_nut"])]
        assert list(meeting(lifted, frame)) == []


def test_the_hands_screws_find_the_nuts_and_not_the_motors(built):
    box, screw = built.box, lookup("screws", Screw, "M6")
    least, most = box.flange_screw_z
    flange = 8.0
    length = screw.shortest(flange + least)
    assert length - flange <= most
    bolts = []
    for x, y in box.flange_holes:
        assert math.hypot(x, y) == pytest.approx(25.0)
        bolts.append(manifold_of(screw_mesh(screw, length)).translate((x, y, -flange)))
    for name in ("motor_box", "spool", "motor", "tension_screw"):
        thing = built.parts.get(name) or built.items[name]
        assert list(meeting(bolts, copies(thing))) == [], name


def test_the_back_is_a_flange_for_the_robot(built):
    back, box = built.parts["box_back"].mesh, built.box
    face = box.size[2]
    section = back.section(plane_origin=(0, 0, face - BACK_DISC_MM / 2), plane_normal=(0, 0, 1))
    assert np.ptp(section.bounds[:, :2], axis=0) == pytest.approx([63.0, 63.0], abs=0.1)
    boss = back.vertices[back.vertices[:, 2] > face + 1.0]
    assert 31.3 < 2 * np.linalg.norm(boss[:, :2], axis=1).max() <= 31.5
    assert back.bounds[1, 2] - face < box.pilot_mm[1]


def area(radius):
    return math.pi * radius**2


def test_the_spool_has_its_closed_form_volume(built):
    s = built.box.spool
    drum = area(s.root) * (s.height - s.flange_height) + area(s.flange) * s.flange_height
    lips = 2 * s.lip * (area(s.rim) - area(s.root))
    knots = area(1.4) * (2 * s.height - s.flexor_z - s.extensor_z + 0.8)
    cut = area(s.bore) * s.height + 4 * area(s.head) * s.head_depth + knots
    assert spool_solid(s).Volume() == pytest.approx(drum + lips - cut, abs=2.0)  # two thin holes


def test_the_carriage_has_its_closed_form_volume():
    c = motor_box_dimensions(CLAY, FINGERS).carriage
    block = 2 * c.half_width * (c.high - c.low) * LENGTH_MM
    tube = c.tube**2 * 5.0 + c.strand_way**2 * (LENGTH_MM - 5.0)
    screw = c.insert**2 * c.insert_depth + c.screw**2 * (LENGTH_MM - c.insert_depth)
    assert carriage_solid(c).Volume() == pytest.approx(block - math.pi * (tube + screw))


@pytest.mark.parametrize("ip_pulley", [2.0, 4.0, 8.0, 12.0, 20.0, 40.0])
def test_strands_stay_wound_and_their_knots_apart(ip_pulley):
    s = spool_dimensions(with_motor("STS3215-12V", ip_pulley_radius_mm=ip_pulley))
    assert s.wrap - s.travel / 2 >= LEAST_WRAP_RAD - 1e-9
    turns = (s.groove - CLAY.print.clearance_mm) / (2 * s.strand)
    assert s.wrap + s.travel / 2 <= TURN_RAD * round(turns)
    between = abs((s.flexor_knot - s.extensor_knot + math.pi) % (2 * math.pi) - math.pi)
    assert 2 * s.knot_radius * math.sin(between / 2) >= 2 * 1.4 + CLAY.print.bone_wall_mm
    assert s.bore + CLAY.print.bone_wall_mm <= s.knot_radius - 1.4
    assert s.knot_radius + 1.4 + CLAY.print.bone_wall_mm <= s.root


def test_a_spool_that_is_too_small_is_refused_in_figures():
    with pytest.raises(
        MakeError, match=r"spool_radius_mm is 5 mm, the centre screw M3 .* need 6\.40 mm"
    ):
        motor_box_dimensions(with_motor("STS3215-12V", spool_radius_mm=5.0), FINGERS)


def test_a_wide_spool_widens_the_rows():
    narrow = motor_box_dimensions(with_motor("XL330-M288"), FINGERS)
    wide = motor_box_dimensions(with_motor("XL330-M288", spool_radius_mm=12.0), FINGERS)
    assert wide.pitch > narrow.pitch == pytest.approx(24.0)
    x = sorted(slot.shaft[0] for slot in wide.slots if slot.row == 1)
    assert np.diff(x) == pytest.approx([wide.pitch] * 5)


def test_an_odd_number_of_motors_leaves_one_place_free():
    box = motor_box_dimensions(CLAY, 3)
    assert (len(box.slots), box.per_row) == (9, 5)
    assert [slot.row for slot in box.slots] == [1] * 5 + [-1] * 4


def test_a_box_is_made_once_and_placed_where_the_hand_is():
    T = np.diag([1.0, -1.0, -1.0, 1.0])
    T[:3, 3] = 5.0, 0.0, 80.0
    here, there = (box_parts(CLAY, FINGERS, pose) for pose in (np.eye(4), T))
    for a, b in zip(here, there, strict=True):
        assert a.mesh is b.mesh and b.link == "palm"
        assert np.allclose(b.places, T @ np.array(a.places))
    for a, b in zip(box_items(CLAY, FINGERS, np.eye(4)), box_items(CLAY, FINGERS, T), strict=True):
        assert np.allclose(b.places, T @ np.array(a.places))
