"""The transmission matrix is what the modelled routing does; links weigh what they are made of."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import trimesh
from ruamel.yaml import YAML
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from fpcad.make.hand import link_bodies
from fpcad.make.mesh import mesh_of
from fpcad.make.parts.bone import proximal_bone
from fpcad.make.parts.catalogue import Metal, lookup
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.feasible import why_not
from fpcad.make.parts.routing import Strand, free_tangents, strands
from fpcad.make.parts.tendon_paths import FingerTendons, motor_turns
from fpcad.make.transmission_file import transmission_yaml
from fpcad.model.transmission import finger_transmission
from tests.make.hands import CENTRE, CLAY, CORNERS, TEMPLATE, assembly_of, design, geometry_of

ROUTING = CLAY.motors.transmission
LOW, HIGH = np.radians([CLAY.hand.joint_limits_deg[j] for j in TEMPLATE.names.joints]).T
POSTURES = [LOW, HIGH, *np.random.default_rng(3).uniform(LOW, HIGH, (6, 3))]


@pytest.mark.parametrize("values", [CENTRE, *CORNERS], ids=str)
@pytest.mark.parametrize("finger", ["thumb", "index"])
def test_motors_turn_by_the_matrix(values, finger):
    geometry = geometry_of(values)
    d, A = finger_dimensions(CLAY, geometry), finger_transmission(ROUTING)
    for joints in POSTURES:
        turns = motor_turns(d, geometry.T_palm_root[finger], ROUTING.spool_radius_mm, joints)
        assert turns == pytest.approx(A @ joints, abs=2e-3)


def test_both_strands_of_a_loop_move_alike():
    geometry = geometry_of(CENTRE)
    tendons = FingerTendons(finger_dimensions(CLAY, geometry), geometry.T_palm_root["ring"])
    rest = tendons.motor_strands(np.zeros(3))
    for joints in POSTURES:
        now = tendons.motor_strands(joints)
        for motor in ("m1", "m2", "m3"):
            pulled, let_out = (
                now[f"{motor}_{s}"] - rest[f"{motor}_{s}"] for s in ("flexor", "extensor")
            )
            assert pulled == pytest.approx(-let_out, abs=1e-9)


@pytest.mark.parametrize("values", [CENTRE, *CORNERS], ids=str)
def test_ip_strands_pass_the_turning_cross(values):
    geometry = geometry_of(values)
    d = finger_dimensions(CLAY, geometry)
    for finger in geometry.fingers:
        for strand in strands(d, geometry.T_palm_root[finger])[4:]:
            low, high = free_tangents(d.mcp, d.mcp_flex, strand.sense)
            middle = (low + high) / 2
            off = math.remainder(strand.tangent_angle - middle, 2 * math.pi)
            assert abs(off) <= (high - low) / 2 + 1e-9


@pytest.mark.parametrize("values", [CENTRE, *CORNERS], ids=str)
def test_no_strand_meets_the_swinging_bone(values):
    """Distances of points on the strands to points on the bone: 0.1 mm apart on both.

    Where a finger is flexed and abducted far, both at once, it touches them. docs/parts.md tells.
    """
    geometry = geometry_of(values)
    d = finger_dimensions(CLAY, geometry)
    bone = mesh_of("proximal_bone", proximal_bone(d), CLAY.print)
    points, _ = trimesh.sample.sample_surface_even(bone, 40_000, seed=1)
    near = KDTree(points[np.linalg.norm(points, axis=1) < 2 * d.root])
    finger = geometry.fingers[0]
    ways = np.concatenate([along(strand) for strand in strands(d, geometry.T_palm_root[finger])])
    for flexion in np.linspace(*d.mcp_flex, 12):
        for abduction in np.linspace(*d.mcp_abd, 5):
            if flexion > np.radians(72) and abs(abduction) > np.radians(10):
                continue
            back = Rotation.from_euler("YZ", [flexion, abduction]).inv()
            apart, _ = near.query(back.apply(ways))
            assert apart.min() - d.mcp.strand > 0.03, (flexion, abduction)


def along(strand: Strand) -> np.ndarray:
    """Points every tenth of a millimetre on a strand outside its pulley, (n, 3) [mm]."""
    corners = strand.outside()
    legs = [
        a + (b - a) * np.linspace(0, 1, 1 + int(10 * np.linalg.norm(b - a)))[:, None]
        for a, b in itertools.pairwise(corners)
    ]
    return np.concatenate(legs)


def test_file_tells_tendons_and_travel():
    document = YAML(typ="safe").load(transmission_yaml(CLAY, geometry_of(CENTRE)))
    assert len(document["tendons"]) == 24
    for tendon in document["tendons"]:
        assert 0 < tendon["shortest_mm"] <= tendon["length_mm"] <= tendon["longest_mm"]
    spans = HIGH - LOW
    expected = np.degrees(np.abs(finger_transmission(ROUTING)) @ spans)
    assert document["motor_travel_deg"]["thumb_m1"] == pytest.approx(expected[0], abs=1e-3)


def test_links_weigh_their_prints_and_what_is_bought():
    assembly = assembly_of(CENTRE)
    bodies = link_bodies(CLAY, assembly)
    for link in ("mcp", "proximal", "distal"):
        density = {
            "skin": CLAY.print.skin_density_g_cm3,
            "endoskeleton": CLAY.print.bone_density_g_cm3,
            "metal": lookup("metals", Metal, CLAY.print.cross_material).density_g_cm3,
        }
        printed = sum(
            p.mesh.volume * len(p.places) * density[p.material]
            for p in assembly.parts
            if p.link == link
        )
        bought = sum(b.mass_g * len(b.places) for b in assembly.bought if b.link == link)
        assert bought > 0
        assert bodies[link].inertia.mass_kg == pytest.approx(printed * 1e-6 + bought * 1e-3)


@pytest.mark.parametrize("name", ["proximal_bone", "distal_bone", "input_pulley"])
def test_inertia_of_the_mesh_is_that_of_the_solid(name):
    part = next(p for p in assembly_of(CENTRE).parts if p.name == name)
    exact = np.array(part.solid.matrixOfInertia(part.solid))
    # the kernel's tensor is about the centre of mass, as the mesh's is
    assert part.mesh.moment_inertia == pytest.approx(exact, abs=5e-3 * np.abs(exact).max())


def test_bearings_sit_in_their_seats():
    assembly = assembly_of(CENTRE)
    bone = next(p for p in assembly.parts if p.name == "distal_bone").mesh
    bearing = next(b for b in assembly.bought if b.name == "ip_bearing")
    for place in bearing.places:
        ring = bearing.mesh.copy().apply_transform(place)
        gaps = trimesh.proximity.signed_distance(bone, ring.vertices)
        assert gaps.max() <= 1e-3  # nowhere inside the bone


def test_reasons_name_size_and_need():
    thin = why_not(CLAY, TEMPLATE, design((42.5, 85.0, 30.0, 11.0, 75.0, 0.0)))
    assert "bearing BUSH-2 needs 11.1 mm, finger is 11.0 mm" in thin
    close = why_not(CLAY, TEMPLATE, design((42.5, 85.0, 18.0, 16.0, 75.0, 0.0)))
    assert any("between roots, they are 18.0 mm apart" in reason for reason in close)
    assert why_not(CLAY, TEMPLATE, design(CENTRE)) == []
