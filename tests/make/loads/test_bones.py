"""Bones as beams: the arms, prongs and shaft carry together what acts on the bone; closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from shapely.geometry import box

from fpcad.make.documents.inventory import read_inventory
from fpcad.make.loads.bones import Beam, Bones, Pushes, beams
from fpcad.make.loads.finger import Touched, finger_forces
from fpcad.make.loads.sections import section_of
from fpcad.make.loads.strands import tensions
from fpcad.make.parts.dimensions import Dimensions, finger_dimensions
from fpcad.model.geometry import HandGeometry
from fpcad.pipeline.finished import finished_hand
from tests.make.loads.test_finger import D, forces_of, touched

PUSHES = {beam.where: push for beam, push in beams(D)}


def about(pushes: Pushes, x: float) -> np.ndarray:
    """Force and moment (K, 6) at a point of the link's axis of all that acts beyond it."""
    square = section_of(x, [box(-1, -1, 1, 1)])
    return np.hstack(pushes.about(square))


@pytest.mark.parametrize("link", ["distal", "proximal"])
def test_both_arms_carry_what_acts_on_the_rest_of_the_proximal_bone(link: str):
    held, motors = touched("index", link, abduction=1e-9)
    found = forces_of("index", held, motors)
    arms = [
        about(PUSHES[where](D, found, held.joints_rad), 7.0)
        for where in ("output pulley's arm", "dorsal arm")
    ]
    beyond = about(PUSHES["neck of the proximal bone"](D, found, held.joints_rad), 7.0)
    np.testing.assert_allclose(arms[0] + arms[1], beyond, atol=1e-3 * np.abs(beyond).max())


def test_both_prongs_carry_the_pin():
    held, motors = touched("index", "distal", D.widest_abduction)
    found = forces_of("index", held, motors)
    x = D.proximal_length - 3.0
    low, high = (about(PUSHES[f"prong at {s}y"](D, found, held.joints_rad), x) for s in "-+")
    both = low + high
    pin = about(PUSHES["shaft of the proximal bone"](D, found, held.joints_rad), x)
    np.testing.assert_allclose(both[:, [0, 1, 2, 3, 5]], pin[:, [0, 1, 2, 3, 5]], atol=1e-6)
    assert np.abs(found.unbalanced[:, 0]).max() < 1e-3  # nothing about the pin itself


@pytest.fixture(scope="module")
def built(built_clay: Path) -> tuple[Dimensions, HandGeometry, dict[str, trimesh.Trimesh]]:
    """Dimensions and bone meshes of a finished hand, from its files."""
    spec, geometry = finished_hand(built_clay)
    parts = read_inventory(built_clay / "parts").parts
    meshes = {part.name: part.mesh for part in parts}
    return finger_dimensions(spec, geometry), geometry, meshes


def modulus_of_a_flattened_bar(radius: float, flat: float) -> float:
    """Section modulus [mm3] of a disc that ends at y = -flat, bent towards +y: strips of its segment."""
    y = np.linspace(flat, radius, 200_001)
    width = 2 * np.sqrt(np.maximum(radius**2 - y**2, 0.0))
    area = math.pi * radius**2 - np.trapezoid(width, y)
    middle = np.trapezoid(width * y, y) / area
    second = math.pi * radius**4 / 4 - np.trapezoid(width * y**2, y) - area * middle**2
    return float(second / max(radius - middle, flat + middle))


def test_a_straight_distal_bone_bends_as_a_round_bar_with_its_flat(built):
    d, geometry, meshes = built
    push, lever = 8.0, d.distal_axis_length - 1.0
    root = geometry.T_palm_root["index"]
    point = root[:3, 3] + root[:3, 0] * (d.proximal_length + lever)
    held = Touched(np.zeros((1, 3)), point[None], push * root[:3, 1][None], on_distal=True)
    slack = tensions(
        np.zeros((1, 3)), 1.0, pretension_n=0.0
    )  # its strands pull at the knot's section
    forces = finger_forces(d, root, held, slack)
    x = 0.75 * lever
    beam = Beam("distal bone", "distal_bone", x, x + 0.3)
    section = beam.sections(meshes["distal_bone"])[0]
    (_, push_on), *_ = beams(d)
    stress = section.stress_mpa(*push_on(d, forces, held.joints_rad).about(section))[0]
    expected = push * (lever - section.x) / modulus_of_a_flattened_bar(d.bone, d.flat)
    assert stress == pytest.approx(expected, rel=0.01)
    whole = Bones(d, meshes).stresses(forces, held.joints_rad)
    assert whole["distal bone"][0] > stress  # it grows towards the joint


def test_every_beam_is_cut_all_along(built):
    d, _, meshes = built
    for beam, _ in beams(d):
        cut = beam.sections(meshes[beam.part])
        assert len(cut) >= 2 and cut[0].x < cut[-1].x, beam.where
        assert all(section.area_mm2 > 1.0 for section in cut), beam.where
