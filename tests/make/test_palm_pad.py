"""The palm's pad: within the palm's primitives, held by plugs, and let into the palm with its clearance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.make.gates.finding import Severity
from fpcad.make.gates.pad import bar_plan, check_pad, skin_share
from fpcad.make.gates.wall import check_walls
from fpcad.make.mesh import manifold_of
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.mounting import flange_and_box
from fpcad.make.parts.palm_pad import HEAD_MM, NAME, PLUG_MM, pad_place
from tests.make.hands import CENTRE, CLAY, CORNERS, geometry_of

GEOMETRY = geometry_of(CENTRE)
TOLERANCE_MM = 1e-4


@pytest.fixture(scope="module")
def pad(clay_parts):
    return clay_parts[NAME]


def place_in(geometry, flanged):
    """The pad's place in a hand, with the flange of another where that hand has no bar for one."""
    flange, _ = flange_and_box(CLAY, flanged, finger_dimensions(CLAY, flanged))
    return pad_place(geometry, flange)


def place_of(values):
    geometry = geometry_of(values)
    place = place_in(geometry, geometry)
    assert place is not None
    return place


def test_the_pad_lies_within_the_primitive_that_it_covers(pad):
    bar = place_of(CENTRE).bar
    along = bar.end_mm - bar.start_mm
    t = np.clip((pad.mesh.vertices - bar.start_mm) @ along / (along @ along), 0, 1)
    out = np.linalg.norm(pad.mesh.vertices - bar.start_mm - np.outer(t, along), axis=1)
    assert out.max() == pytest.approx(bar.radius_mm, abs=TOLERANCE_MM)


def test_the_pad_keeps_its_clearance_to_the_palm(pad, clay_parts):
    gap = manifold_of(pad.mesh).min_gap(manifold_of(clay_parts["palm"].mesh), 1.0)
    assert CLAY.print.clearance_mm * 0.75 < gap <= CLAY.print.clearance_mm + TOLERANCE_MM


def test_plugs_hold_the_pad(pad, clay_parts):
    """Pulled palmarly by more than its clearances, the pad meets the palm: its heads are too thick."""
    assert PLUG_MM + CLAY.print.clearance_mm < HEAD_MM
    palm, skin = manifold_of(clay_parts["palm"].mesh), manifold_of(pad.mesh)
    for push in ((0, 0, -1.5), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)):
        assert (palm ^ skin.translate(push)).volume() > 0.1


@pytest.mark.parametrize("values", [CENTRE, *CORNERS])
def test_plugs_and_inserts_keep_apart(values):
    place = place_of(values)
    for plug in place.plugs:
        for insert in place.inserts:
            assert np.linalg.norm((plug - insert)[:2]) > HEAD_MM + place.insert_mm + 0.8
    assert np.linalg.norm(place.plugs[0] - place.plugs[1]) > 10


def test_a_palm_without_room_has_no_pad():
    short = replace(GEOMETRY, palm=tuple(s for s in GEOMETRY.palm if s.finger))
    assert place_in(short, GEOMETRY) is None


def test_the_share_that_skin_covers_is_told(clay_parts):
    parts = list(clay_parts.values())
    (told,) = check_pad(parts, GEOMETRY)
    assert 0.6 < told.value < 1.0 and told.severity is Severity.FIGURE
    (bare,) = check_pad([p for p in parts if p.name != NAME], GEOMETRY)
    assert bare.value == 0.0 and bare.severity is Severity.WARNING and "no room" in bare.text


def test_the_bars_plan_leaves_the_roots_out():
    points = bar_plan(GEOMETRY)
    for shape in GEOMETRY.palm:
        if shape.finger:
            assert np.linalg.norm(points - shape.start_mm[:2], axis=1).min() >= shape.radius_mm
    spine = place_of(CENTRE).bar
    free = np.linalg.norm(spine.end_mm - spine.start_mm) - 2 * 15
    assert len(points) * 0.25 > 2 * spine.radius_mm * free
    assert skin_share([], points) == 0.0


def test_the_pad_is_as_thick_as_a_skin(pad):
    (told,) = check_walls(NAME, pad.mesh, CLAY.print.skin_wall_mm)
    assert told.value == pytest.approx(CLAY.print.skin_thickness_mm, abs=0.02)
