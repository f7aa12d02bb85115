"""Parts are printable solids of the right size."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh

from fpcad.errors import FpcadError
from fpcad.make.mesh import mesh_of
from fpcad.make.parts.dimensions import FLAT_MM, finger_dimensions
from fpcad.make.parts.interlock import LUG_MM, WIDTH_SHARE, Link, lug_range
from fpcad.make.parts.skin import distal_skin, open_share
from fpcad.make.parts.solids import ball, capsule, finger_core
from tests.make.hands import CENTRE, CLAY, CORNERS, geometry_of, parts_of, with_print

DIMENSIONS = finger_dimensions(CLAY, geometry_of(CENTRE))


def test_each_part_on_disk_is_one_watertight_body(clay_hand):
    for file in sorted((clay_hand / "parts").glob("*/*.stl")):
        mesh = trimesh.load_mesh(file)
        assert mesh.is_watertight and mesh.volume > 0 and mesh.body_count == 1, file.name


def test_meshes_lose_little_volume(clay_parts):
    for part in clay_parts.values():
        assert part.mesh.volume == pytest.approx(part.solid.Volume(), rel=6e-3)


def test_fingers_share_their_parts(clay_parts):
    assert {name: part.count for name, part in clay_parts.items()} == {
        "palm": 1,
        "palm_pad": 1,
        "mcp_cross": 4,
        "input_pulley": 8,
        "idler_pulley": 4,
        "ip_drum": 4,
        "proximal_bone": 4,
        "proximal_skin": 4,
        "distal_bone": 4,
        "distal_skin": 4,
        "flange": 1,
        "motor_box": 1,
        "box_back": 1,
        "spool": 12,
        "tension_carriage": 12,
    }


def bent_ring_volume(outer: float, inner: float, length: float, bend: float) -> float:
    """Volume of a tube whose one end is cut square on the one half and by a bend plane on the other."""
    return math.pi * (outer**2 - inner**2) * length - math.tan(bend) * bend_moment(outer, inner)


def bend_moment(outer: float, inner: float) -> float:
    """Integral of |z| over the half ring z < 0."""
    return 2 / 3 * (outer**3 - inner**3)


def lugs_volume(link: Link) -> float:
    """Volume of both lugs of a skin: from a flat inside the bone out to the bore, or to its flat."""
    d, (low, high) = DIMENSIONS, lug_range(DIMENSIONS, link)
    half, bore = WIDTH_SHARE * d.bone / 2, d.skin_inner
    segment = half * math.sqrt(bore**2 - half**2) + bore**2 * math.asin(half / bore)
    inner = 2 * half * (d.bone - LUG_MM)
    return (high - low) * (segment - inner + 2 * half * (bore - FLAT_MM) - inner)


def flat_volume(length: float) -> float:
    """What a flat makes a bent tube of the skin thicker: a segment of its bore, cut by the bend plane."""
    r, h = DIMENSIONS.skin_inner, DIMENSIONS.skin_inner - FLAT_MM
    segment = r**2 * math.acos(h / r) - h * math.sqrt(r**2 - h**2)
    moment = (r**3 / 3) - (r**2 * h / 2 - h**3 / 6)  # of |z| over its half with z < 0
    return segment * length - math.tan(DIMENSIONS.ip_flex[1] / 2) * moment


def test_proximal_skin_has_its_closed_form_volume(clay_parts):
    d = DIMENSIONS
    length = d.proximal_length - d.clearance - d.shaft_start
    sleeve = bent_ring_volume(d.skin_outer, d.skin_inner, length, d.ip_flex[1] / 2)
    expected = sleeve + lugs_volume("proximal") + flat_volume(length)
    assert clay_parts["proximal_skin"].solid.Volume() == pytest.approx(expected, rel=1e-6)


def test_distal_skin_has_its_closed_form_volume(clay_parts):
    d = DIMENSIONS
    length = d.distal_axis_length - d.clearance
    tube = bent_ring_volume(d.skin_outer, d.skin_inner, length, d.ip_flex[1] / 2)
    cap = 2 / 3 * math.pi * (d.skin_outer**3 - d.skin_inner**3)
    cap += math.pi / 6 * FLAT_MM**2 * (3 * d.skin_inner - FLAT_MM)
    expected = tube + cap + lugs_volume("distal") + flat_volume(length)
    assert clay_parts["distal_skin"].solid.Volume() == pytest.approx(expected, rel=1e-6)


def test_capsules_have_their_closed_form_volume_and_area():
    whole, half = capsule((0, 0, 0), (20, 0, 0), 5.0), finger_core(20.0, 5.0)
    volume, side = math.pi * 25 * 20 + 4 / 3 * math.pi * 125, 2 * math.pi * 5 * 20
    assert whole.Volume() == pytest.approx(volume, rel=1e-9)
    assert whole.Area() == pytest.approx(side + 4 * math.pi * 25, rel=1e-9)
    assert half.Volume() == pytest.approx(volume - 2 / 3 * math.pi * 125, rel=1e-9)
    assert half.Area() == pytest.approx(side + 3 * math.pi * 25, rel=1e-9)


def contact_points(link: str, edge_mm: float) -> np.ndarray:
    """Points of the contact capsule where a tool may touch, (n, 3) [mm] in the link's frame."""
    geometry = geometry_of(CENTRE)
    r, bend = geometry.radius_mm, math.tan(DIMENSIONS.ip_flex[1] / 2)
    length = geometry.distal_length_mm - r if link == "distal" else geometry.proximal_length_mm
    last = length + 0.9 * math.pi / 2 * r if link == "distal" else length
    points = []
    for phi in np.linspace(-math.pi, math.pi, 49):
        margin = r * max(math.cos(phi), 0.0) * bend + edge_mm
        first, end = (margin, last) if link == "distal" else (DIMENSIONS.shaft_start, last - margin)
        for s in np.linspace(first, end, 25):
            t = max(s - length, 0.0) / r
            ring = r * math.cos(t)
            x = min(s, length) + r * math.sin(t)
            points.append((x, ring * math.sin(phi), -ring * math.cos(phi)))
    return np.array(points)


@pytest.mark.parametrize("link", ["proximal", "distal"])
def test_skin_is_the_contact_capsule(clay_parts, link):
    points = contact_points(link, edge_mm=1.0)
    _, distance, _ = trimesh.proximity.closest_point(clay_parts[f"{link}_skin"].mesh, points)
    assert distance.max() <= 0.05


@pytest.mark.parametrize("link", ["proximal", "distal"])
def test_no_skin_stands_out_of_the_capsule_or_back_from_it(clay_parts, link):
    vertices, d = np.asarray(clay_parts[f"{link}_skin"].mesh.vertices), DIMENSIONS
    end = d.distal_axis_length if link == "distal" else d.proximal_length
    foot = np.clip(vertices[:, 0], 0.0, end)
    radius = np.linalg.norm(vertices - np.outer(foot, (1.0, 0.0, 0.0)), axis=1)
    outside = radius > (d.skin_inner + d.skin_outer) / 2
    assert np.abs(radius[outside] - d.skin_outer).max() <= 0.05


@pytest.mark.parametrize("values", [CENTRE, *CORNERS], ids=str)
def test_a_quarter_of_a_finger_at_most_is_bare(values):
    assert open_share(finger_dimensions(CLAY, geometry_of(values))) <= 0.25


def test_oversize_lifts_the_skin():
    d = finger_dimensions(with_print(skin_oversize_mm=0.4), geometry_of(CENTRE))
    tip = distal_skin(d).BoundingBox().xmax
    assert tip == pytest.approx(geometry_of(CENTRE).distal_length_mm + 0.4, abs=1e-6)


def palm_excess(values: tuple[float, ...], vertices: np.ndarray) -> float:
    """How far [mm] a point of a palm's mesh lies outside of all palm primitives."""
    excess = np.full(len(vertices), np.inf)
    for shape in geometry_of(values).palm:
        axis = shape.end_mm - shape.start_mm
        share = (vertices - shape.start_mm) @ axis / max(axis @ axis, 1e-12)
        nearest = shape.start_mm + np.clip(share, 0, 1)[:, None] * axis
        distance = np.linalg.norm(vertices - nearest, axis=1) - shape.radius_mm
        excess = np.minimum(excess, distance)
    return float(excess.max())


def test_palm_fits_in_its_primitives(clay_parts):
    assert palm_excess(CENTRE, clay_parts["palm"].mesh.vertices) <= 0


@pytest.mark.parametrize("values", CORNERS, ids=str)
def test_corners_of_the_design_space_can_be_made(values):
    parts = {part.name: part for part in parts_of(values)}
    assert palm_excess(values, parts["palm"].mesh.vertices) <= 0
    assert all(part.solid.isValid() and part.mesh.is_watertight for part in parts.values())


def test_thick_skin_leaves_no_room_for_the_bone():
    with pytest.raises(FpcadError, match=r"bearing BUSH-2 needs 20\.1 mm, finger is 16\.0 mm"):
        finger_dimensions(with_print(skin_thickness_mm=6.0), geometry_of(CENTRE))


def test_a_finger_without_root_sphere_is_named():
    hand = CLAY.hand.model_copy(
        update={"palm": tuple(p for p in CLAY.hand.palm if p.name != "ring_mcp")}
    )
    spec = CLAY.model_copy(update={"hand": hand})
    with pytest.raises(FpcadError, match=r"hand\.palm: ring has no sphere"):
        finger_dimensions(spec, geometry_of(CENTRE, spec))


def test_two_bodies_are_no_part():
    apart = ball((0, 0, 0), 1.0).fuse(ball((9, 0, 0), 1.0))
    with pytest.raises(FpcadError, match=r"part pair: .* 2 bodies"):
        mesh_of("pair", apart, CLAY.print)
