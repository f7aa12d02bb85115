"""Each gate of a part lets sound parts pass and refuses bad ones, with place and number."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from fpcad.errors import MakeError
from fpcad.make.gates.all_gates import check_part
from fpcad.make.gates.finding import Finding, Severity, errors, refuse_errors
from fpcad.make.gates.orientation import best_orientation
from fpcad.make.gates.table import COLUMNS, findings_csv
from fpcad.make.gates.wall import check_walls, wall_thickness
from tests.make.gates.bad_parts import (
    block,
    of_two_bodies,
    part,
    two_solids,
    with_open_mesh,
    with_thin_wall,
)
from tests.make.hands import CLAY, with_print


def only_error(findings: list[Finding]) -> Finding:
    found = errors(findings)
    assert len(found) == 1, [str(f) for f in findings]
    return found[0]


def test_a_sound_block_passes():
    findings = check_part(CLAY, part("block", block()))
    assert errors(findings) == []
    assert {f.gate for f in findings} == {"wall", "bed", "overhang"}


def test_an_open_mesh_is_refused_where_it_is_open():
    fault = only_error(check_part(CLAY, part("open", with_open_mesh())))
    assert (fault.gate, fault.value) == ("mesh", 3)
    assert max(map(abs, fault.at_mm or ())) == 10


def test_two_bodies_are_refused_at_the_smaller_one():
    fault = only_error(check_part(CLAY, part("two", of_two_bodies())))
    assert (fault.gate, fault.value, fault.limit) == ("mesh", 2, 1)
    assert fault.at_mm == pytest.approx((30, 0, 0))


def test_a_mesh_inside_out_is_refused():
    mesh = block()
    mesh.invert()
    assert only_error(check_part(CLAY, part("inverted", mesh))).value == pytest.approx(-4000)


def test_two_solids_are_refused():
    fault = only_error(check_part(CLAY, part("two", block(), two_solids())))
    assert (fault.gate, fault.value) == ("solid", 2)


@pytest.mark.parametrize("wall", [0.3, 0.5, 0.7])
def test_a_thin_wall_is_refused_where_it_is_thin(wall):
    fault = only_error(check_part(CLAY, part("thin", with_thin_wall(wall))))
    assert fault.gate == "wall"
    assert fault.value == pytest.approx(wall, abs=0.01)
    assert fault.at_mm is not None
    x, y, z = fault.at_mm
    assert max(abs(x), abs(y)) <= 7 and 5 - wall - 0.01 <= z <= 5.01


@pytest.mark.parametrize("wall", [0.85, 2.0])
def test_a_thick_wall_passes(wall):
    assert errors(check_part(CLAY, part("thick", with_thin_wall(wall)))) == []


def test_skins_have_their_own_least_wall():
    mesh = with_thin_wall(1.0)
    assert errors(check_walls("sleeve", mesh, 1.2)) and not errors(check_walls("sleeve", mesh, 0.8))


def test_a_pipes_wall_is_measured_everywhere():
    pipe = trimesh.creation.annulus(r_min=5, r_max=6.5, height=30, sections=256)
    _, thickness, area = wall_thickness(pipe)
    around = thickness[thickness < 20]
    assert np.quantile(around, [0.01, 0.99]) == pytest.approx(1.5, abs=0.01)
    assert area * len(around) == pytest.approx(2 * np.pi * (5 + 6.5) * 30, rel=0.05)


def test_a_part_larger_than_the_bed_is_refused():
    spec = with_print(bed_mm=(15.0, 30.0, 30.0))
    fault = only_error(check_part(spec, part("large", block())))
    assert fault.gate == "bed" and "does not fit the bed of 15 x 30 x 30 mm" in fault.text


def test_a_long_part_may_be_turned_on_the_bed():
    long = trimesh.creation.box((20, 200, 10))
    assert errors(check_part(with_print(bed_mm=(210.0, 50.0, 50.0)), part("long", long))) == []


def test_a_table_is_printed_upside_down():
    top, leg = trimesh.creation.box((40, 40, 4)), trimesh.creation.box((6, 6, 20))
    top.apply_translation((0, 0, 10))
    table = trimesh.boolean.union([top, leg], engine="manifold")
    laid = best_orientation(table, 45.0)
    assert laid.T_bed_part[2, 2] == pytest.approx(-1)
    assert laid.overhang_mm2 == 0 and laid.base_mm2 == pytest.approx(1600)
    assert (table.vertices @ laid.T_bed_part[2, :3] + laid.T_bed_part[2, 3]).min() == pytest.approx(
        0
    )


def test_what_has_no_flat_side_lies_low():
    rod = trimesh.creation.capsule(height=40, radius=5)
    assert best_orientation(rod, 45.0).height_mm == pytest.approx(10, abs=0.1)


def test_the_first_error_is_the_reason_and_the_others_are_counted():
    faults = check_part(CLAY, part("thin", with_thin_wall(0.5))) * 2
    with pytest.raises(MakeError, match=r"thin: a wall of 0\.50 mm .*\(and 1 more faults"):
        refuse_errors(faults)


def test_findings_are_a_table():
    lines = findings_csv(check_part(CLAY, part("block", block()))).splitlines()
    assert lines[0] == ",".join(COLUMNS) and len(lines) == 4
    assert Severity.FIGURE.value in lines[1]
