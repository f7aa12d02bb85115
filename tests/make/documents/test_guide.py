"""The guide tells what there is; what helps to build is printable too; one finger can be made alone."""

from __future__ import annotations

import csv
import math
from itertools import pairwise

import pytest
import trimesh

from fpcad.errors import SpecError
from fpcad.make.documents.extras import COUPON_STEPS_MM, extra_parts
from fpcad.make.documents.guide import guide_text, strand_travel
from fpcad.make.documents.one_finger import write_finger
from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.views import cut_open, finger_pieces, hand_pieces
from fpcad.make.gates.all_gates import check_part
from fpcad.make.gates.finding import errors
from fpcad.make.gates.postures import rest_joints
from fpcad.make.parts.assembly import Assembly
from fpcad.make.power import power
from fpcad.spec.catalogue import motor_types
from tests.make.hands import CENTRE, CLAY, geometry_of, parts_of

STAMP = Stamp("clay", 24, "0123456789abcdef" * 4)
GEOMETRY = geometry_of(CENTRE)
ASSEMBLY = Assembly(tuple(parts_of(CENTRE)), ())
FINGER_PIECES = sum(len(part.places) for part in ASSEMBLY.parts if part.link != "palm")


def test_the_guide_names_every_part_and_its_hand():
    text = guide_text(CLAY, ASSEMBLY, STAMP)
    assert STAMP.text in text
    assert all(f"| {part.name} | {part.count} |" in text for part in ASSEMBLY.parts)
    assert text.count(", every finger |") == 3 and "1. Print `fit_coupon`" in text


def test_a_guide_without_pictures_says_why():
    text = guide_text(CLAY, ASSEMBLY, STAMP, missing="no screen")
    assert "No pictures were drawn: no screen" in text and "![" not in text


def test_strands_travel_as_the_transmission_says():
    """m3 turns with flexion (110 deg) on the idlers and with the IP joint (110 deg) on its pulley."""
    routing = CLAY.motors.transmission
    turns, travel = strand_travel(CLAY)[2]
    wound = routing.idler_radius_mm * 110 + routing.ip_pulley_radius_mm * 110
    assert turns == pytest.approx(wound / routing.spool_radius_mm)
    assert travel == pytest.approx(math.radians(wound))


def test_extras_pass_the_gates_of_parts():
    assert [f for part in extra_parts(CLAY) for f in errors(check_part(CLAY, part))] == []


def test_the_coupon_has_its_holes_and_its_notch():
    coupon = next(part for part in extra_parts(CLAY) if part.name == "fit_coupon")
    radii = [(2.0 + CLAY.print.clearance_mm + step) / 2 for step in COUPON_STEPS_MM]
    holes = sum(math.pi * radius**2 for radius in radii)
    assert coupon.solid.Volume() == pytest.approx(6 * (48 * 10 - holes - 2), rel=1e-6)


def test_a_finger_taken_apart_has_no_two_pieces_over_one_another():
    pieces = [mesh for mesh, _ in finger_pieces(ASSEMBLY, GEOMETRY, apart=True)]
    gaps = [b.bounds[0, 0] - a.bounds[1, 0] for a, b in pairwise(pieces)]
    assert len(pieces) == FINGER_PIECES and min(gaps) > 0


def test_pieces_are_cut_at_the_middle_plane():
    whole = finger_pieces(ASSEMBLY, GEOMETRY, apart=False)
    whole = [piece for piece in whole if piece[0].bounds[0, 1] < 0 < piece[0].bounds[1, 1]]
    for (mesh, _), (half, _) in zip(whole, cut_open(whole), strict=True):
        assert half.bounds[0, 1] == pytest.approx(0, abs=1e-9)
        assert half.volume == pytest.approx(mesh.volume / 2, rel=2e-2)  # bones have a flat


def test_the_whole_hand_has_a_palm_and_four_fingers():
    pieces = hand_pieces(ASSEMBLY, GEOMETRY, rest_joints(CLAY.hand, GEOMETRY))
    still = sum(len(part.places) for part in ASSEMBLY.parts if part.link == "palm")
    assert len(pieces) == still + 4 * FINGER_PIECES


@pytest.mark.parametrize("finger", GEOMETRY.fingers)
def test_one_finger_has_its_parts_and_a_mount(finger, tmp_path):
    write_finger(CLAY, ASSEMBLY, GEOMETRY, finger, tmp_path, STAMP)
    rows = {r["item"]: r for r in csv.DictReader((tmp_path / "bom.csv").open(encoding="utf-8"))}
    assert rows["distal_bone"]["count"] == "1" and rows["motor"]["count"] == "3"
    mount = trimesh.load_mesh(tmp_path / "print" / "finger_mount.stl")
    assert mount.is_watertight and mount.body_count == 1


def test_an_unknown_finger_is_told(tmp_path):
    with pytest.raises(SpecError, match='no finger "pinky"; allowed: thumb, index'):
        write_finger(CLAY, ASSEMBLY, GEOMETRY, "pinky", tmp_path, STAMP)


@pytest.mark.parametrize("motor_type", motor_types())
def test_every_motor_has_a_supply_a_fuse_above_it_and_leads_for_the_fuse(motor_type):
    need = power(motor_type, 12)
    assert need.fuse_a >= need.supply_a - 1 and need.wire_mm2 * 10 >= need.fuse_a
