"""What a finished build ships, against itself: skins and URDF, solids and meshes and inertias."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import cadquery as cq
import numpy as np
import pytest
import trimesh
import yourdfpy
from numpy.typing import NDArray

from fpcad.make.documents.inventory import read_inventory
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.catalogue import Metal, lookup
from fpcad.make.parts.dimensions import Dimensions, finger_dimensions
from fpcad.pipeline.finished import finished_hand

Array = NDArray[np.float64]
Mass = tuple[float, Array, Array]
"""Mass [g], centre (3,) [mm], tensor (3, 3) about the centre [g mm^2]."""

TOLERANCE_MM = 0.05
LINKS = ("palm", "mcp", "proximal", "distal")


@pytest.fixture(scope="module")
def urdf(built_clay: Path) -> dict[str, yourdfpy.Link]:
    """Links of the build's URDF by name, as a strange reader reads them."""
    file = built_clay / "hand" / "urdf" / "clay.urdf"
    robot = yourdfpy.URDF.load(file, load_meshes=False, build_scene_graph=False).robot
    return {link.name: link for link in robot.links}


@pytest.fixture(scope="module")
def dimensions(built_clay: Path) -> Dimensions:
    return finger_dimensions(*finished_hand(built_clay))


def capsule(link: yourdfpy.Link) -> tuple[Array, Array, float]:
    """Both centres (3,) and the radius [mm] of the capsule that a link's collision shapes make up."""
    centres, radii, rods = [], set(), []
    for shape in link.collisions:
        assert shape.origin is not None
        centre = 1e3 * shape.origin[:3, 3]
        if shape.geometry.sphere is not None:
            centres.append(centre)
            radii.add(1e3 * shape.geometry.sphere.radius)
        if shape.geometry.cylinder is not None:
            rods.append((centre, 1e3 * shape.geometry.cylinder.length))
            radii.add(1e3 * shape.geometry.cylinder.radius)
    (radius,) = radii
    start, end = sorted(centres, key=lambda p: p[0])
    ((middle, length),) = rods
    assert length == pytest.approx(np.linalg.norm(end - start))
    assert middle == pytest.approx((start + end) / 2, abs=1e-9)
    return start, end, radius


def capsule_points(d: Dimensions, link: str, ends: tuple[Array, Array], radius: float) -> Array:
    """Points (n, 3) [mm] of the capsule where there is skin: up to 1 mm from its cut edges."""
    (start, end), slope = ends, np.tan(d.ip_flex[1] / 2)
    points = []
    for phi in np.linspace(-np.pi, np.pi, 73):  # 0 is palmar
        margin = radius * max(np.cos(phi), 0.0) * slope + 1.0
        round_axis = np.array([0.0, np.sin(phi), -np.cos(phi)])
        last = end[0] - margin if link == "proximal" else end[0]
        first = start[0] + margin if link == "distal" else d.shaft_start
        points += [np.array([x, 0, 0]) + radius * round_axis for x in np.linspace(first, last, 60)]
        if link == "distal":
            cap = np.linspace(0.0, np.pi / 2, 30)
            points += [
                end + radius * np.array([np.sin(t), *(np.cos(t) * round_axis[1:])]) for t in cap
            ]
    return np.array(points)


@pytest.mark.parametrize("link", ["proximal", "distal"])
def test_skin_and_urdf_capsule_are_one_surface(built_clay: Path, urdf, dimensions, link: str):
    """Hausdorff distance, both ways, over the skinned region: STL in mm, URDF in m."""
    d = dimensions
    start, end, radius = capsule(urdf[f"index_{link}"])
    skin = trimesh.load_mesh(built_clay / "parts" / "skin" / f"{link}_skin.stl")
    wanted = capsule_points(d, link, (start, end), radius)
    _, from_capsule, _ = trimesh.proximity.closest_point(skin, wanted)
    inside, _ = trimesh.sample.sample_surface_even(skin, 6000, seed=1)
    points = np.vstack([skin.vertices, inside])
    along = np.clip((points - start) @ (end - start) / ((end - start) @ (end - start)), 0.0, 1.0)
    away = np.linalg.norm(points - start - along[:, None] * (end - start), axis=1)
    outer = away > (d.skin_inner + radius) / 2
    rim = _at_a_cut(d, link, points)
    to_capsule = np.abs(away - radius)[outer & ~rim]
    assert outer.sum() > 1000 and len(to_capsule) > 1000
    assert from_capsule.max() <= TOLERANCE_MM
    assert to_capsule.max() <= TOLERANCE_MM


def _at_a_cut(d: Dimensions, link: str, points: Array) -> NDArray[np.bool_]:
    """Which points (n, 3) lie on a face where the skin was cut: at the root, or to the bend plane."""
    sign, x0 = (1.0, 0.0) if link == "distal" else (-1.0, d.proximal_length)
    behind = sign * (points[:, 0] - x0) - np.maximum(-points[:, 2], 0) * np.tan(d.ip_flex[1] / 2)
    cut = np.abs(behind - d.clearance) < 1e-3
    return cut | (np.abs(points[:, 0] - d.shaft_start) < 1e-3) if link == "proximal" else cut


def together(bodies: Iterable[Mass]) -> Mass:
    """One rigid body of many, by Steiner."""
    bodies = list(bodies)
    mass = sum(m for m, _, _ in bodies)
    centre = np.sum([m * c for m, c, _ in bodies], axis=0) / mass
    tensor = np.zeros((3, 3))
    for m, c, own in bodies:
        r = c - centre
        tensor += own + m * (r @ r * np.eye(3) - np.outer(r, r))
    return mass, centre, tensor


def placed(body: Mass, T: Array) -> Mass:
    m, c, tensor = body
    return m, T[:3, :3] @ c + T[:3, 3], T[:3, :3] @ tensor @ T[:3, :3].T


def of_mesh(mesh: trimesh.Trimesh, g_mm3: float) -> Mass:
    told = mesh.mass_properties
    return told.mass * g_mm3, np.array(told.center_mass), np.array(told.inertia) * g_mm3


def of_solid(solid: cq.Shape, g_mm3: float) -> Mass:
    """By the CAD kernel's own integrals over the exact faces."""
    tensor = np.array(cq.Shape.matrixOfInertia(solid))
    return solid.Volume() * g_mm3, np.array(solid.Center().toTuple()), tensor * g_mm3


@pytest.fixture(scope="module")
def links(built_clay: Path) -> dict[str, tuple[Mass, Mass]]:
    """Each link from the shipped STL files, and from the shipped solids (bought items: envelopes)."""
    spec, _ = finished_hand(built_clay)
    shipped: Assembly = read_inventory(built_clay / "parts")
    grams = {"endoskeleton": spec.print.bone_density_g_cm3, "skin": spec.print.skin_density_g_cm3}
    grams["metal"] = lookup("metals", Metal, spec.print.cross_material).density_g_cm3
    found = {}
    for link in LINKS:
        meshes, solids = [], []
        for part in (part for part in shipped.parts if part.link == link):
            density = grams[part.material] * 1e-3
            meshes += [placed(of_mesh(part.mesh, density), T) for T in part.places]
            solids += [placed(of_solid(part.solid, density), T) for T in part.places]
        for item in (item for item in shipped.bought if item.link == link):
            bought = of_mesh(item.mesh, item.mass_g / item.mesh.volume)
            meshes += [placed(bought, T) for T in item.places]
            solids += [placed(bought, T) for T in item.places]
        found[link] = together(meshes), together(solids)
    return found


@pytest.mark.parametrize("link", LINKS)
def test_solids_and_meshes_have_one_inertia(links, link: str):
    (mass, centre, tensor), (exact, middle, exact_tensor) = links[link]
    size = np.sqrt(np.trace(exact_tensor) / exact)
    assert mass == pytest.approx(exact, rel=0.005)
    assert np.linalg.norm(centre - middle) <= 0.005 * size
    principal, exact_principal = np.linalg.eigvalsh(tensor), np.linalg.eigvalsh(exact_tensor)
    assert principal == pytest.approx(exact_principal, rel=0.005)
    assert np.linalg.norm(tensor - exact_tensor) <= 0.005 * np.linalg.norm(exact_tensor)


@pytest.mark.parametrize("link", LINKS)
def test_the_urdf_tells_the_inertia_of_the_shipped_meshes(links, urdf, link: str):
    mass, centre, tensor = links[link][0]
    told = urdf[link if link == "palm" else f"ring_{link}"].inertial
    assert 1e3 * told.mass == pytest.approx(mass, rel=1e-5)
    assert 1e3 * told.origin[:3, 3] == pytest.approx(centre, abs=1e-4)
    assert np.linalg.norm(1e9 * told.inertia - tensor) <= 1e-5 * np.linalg.norm(tensor)
