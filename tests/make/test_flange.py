"""The flange has its standard's sizes and stands where the palm has room; where it has none, that is told."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fpcad.errors import MakeError
from fpcad.make.gates.bodies import body_of
from fpcad.make.gates.early import check_early
from fpcad.make.gates.meeting import meet
from fpcad.make.parts.dimensions import finger_dimensions, roof_height
from fpcad.make.parts.feasible import why_not
from fpcad.make.parts.flange_dimensions import FLOOR_MM
from fpcad.make.parts.mounting import flange_and_box
from fpcad.spec.catalogue import flange_sizes
from tests.make.hands import CENTRE, CLAY, CORNERS, TEMPLATE, design, geometry_of

SHORT_AND_STEEP = (38.0, 46.0, 30.0, 16.0, 118.0, -60.0)


def with_mount(**settings):
    """Clay's spec with other settings of the mount."""
    return CLAY.model_copy(update={"mount": CLAY.mount.model_copy(update=settings)})


def flange(values, spec=CLAY):
    geometry = geometry_of(values, spec)
    return flange_and_box(spec, geometry, finger_dimensions(spec, geometry))[0]


def test_the_flange_is_iso_9409_1_50_4_m6(clay_parts):
    f, mesh = flange(CENTRE), clay_parts["flange"].mesh
    face = f.T_palm_flange[2, 3]
    assert mesh.bounds[1, 2] == pytest.approx(face + f.flange.boss_height_mm, abs=1e-6)
    rim = mesh.vertices[np.abs(mesh.vertices[:, 2] - face) < 1e-6]
    across = np.hypot(*(rim[:, :2] - f.T_palm_flange[:2, 3]).T)
    assert across.max() == pytest.approx(63 / 2, abs=0.02)
    assert across.min() == pytest.approx((31.5 - CLAY.print.clearance_mm) / 2, abs=0.02)
    for x, y in f.screw_places:
        assert math.hypot(x, y) == pytest.approx(25) and abs(x) == pytest.approx(abs(y))
        inside = mesh.contains(
            [f.T_palm_flange[:3, 3] + (x, y, z) for z in (-1.0, -8.0, -12.0, -30.0)]
        )
        assert not inside.any()  # the hole, its head's room, and the way of a key
    assert mesh.contains([f.T_palm_flange[:3, 3] - (0, 0, 5.0)])[0]


def test_the_foot_stands_on_the_palm_and_takes_none_of_its_room(clay_parts):
    palm, foot = (body_of(name, "palm", clay_parts[name].mesh) for name in ("palm", "flange"))
    gap, shared = meet(palm, np.eye(4), foot, np.eye(4), 1.0)
    assert gap == pytest.approx(0, abs=1e-6) and shared is None
    under = meet(palm, np.eye(4), foot, np.diag([1, 1, 1, 1.0]) + _down(0.05), 1.0)[1]
    assert under is not None and under.volume_mm3 > 0.05 * 31 * 7 * 0.8  # the whole seat bears it


def _down(z: float) -> np.ndarray:
    shift = np.zeros((4, 4))
    shift[2, 3] = -z
    return shift


@pytest.mark.parametrize("values", [CENTRE, *CORNERS], ids=str)
def test_the_foot_lies_in_the_middle_and_its_inserts_above_the_fingers(values):
    f, geometry = flange(values), geometry_of(values)
    roots = np.mean([geometry.T_palm_root[n][:3, 3] for n in ("thumb", "middle")], axis=0)
    assert f.T_palm_foot[:2, 3] == pytest.approx(roots[:2], abs=3.0)
    assert f.T_palm_foot[2, 3] - f.insert_depth - roof_height(geometry) >= FLOOR_MM
    assert f.insert_depth >= f.insert.length_mm


@pytest.mark.parametrize("size", flange_sizes())
def test_every_flange_has_room_for_its_screws(size):
    f = flange(CENTRE, with_mount(flange=size, box=False))
    assert f.flange.circle_mm + f.flange_screw.head_diameter_mm <= f.flange.outer_mm
    assert f.flange.circle_mm - f.flange_screw.head_diameter_mm > f.flange.boss_mm
    assert f.flange.disc_mm < f.flange_screw_length and f.cone_start > 10


def test_a_palm_too_short_for_the_foot_is_told_before_it_is_modelled():
    told = r"palm: the flange's foot needs 31\.0 mm of spine, \d+\.\d mm are free"
    (reason,) = why_not(CLAY, TEMPLATE, design(SHORT_AND_STEEP))
    with pytest.raises(MakeError, match=told) as refused:
        check_early(CLAY, geometry_of(SHORT_AND_STEEP))
    assert reason == str(refused.value)


def test_a_palm_without_a_bar_is_told():
    spheres = tuple(shape for shape in CLAY.hand.palm if shape.kind == "sphere")
    spec = CLAY.model_copy(update={"hand": CLAY.hand.model_copy(update={"palm": spheres})})
    with pytest.raises(MakeError, match="a flange needs a level capsule to stand on"):
        flange(CENTRE, spec)


def test_the_box_takes_one_flange_only():
    with pytest.raises(MakeError, match=r"the motors' box takes a circle of 50 mm, .* has 40 mm"):
        flange(CENTRE, with_mount(flange="ISO9409-1-40-4-M6"))
