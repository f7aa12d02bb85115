"""The chosen hand's meshes, as its URDF names them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import manifold3d
import numpy as np
import trimesh
import yourdfpy
from numpy.typing import NDArray

from fpcad.errors import StoreError
from fpcad.units import M_PER_MM

MERGE_DIGITS_MM = 3
SHOWN_WITHIN_MM = 0.1
"""How far a surface on the page may lie from the part's; a pixel shows half a millimetre."""
COARSEST_MM = 1.6
MAX_TRIANGLES = 60_000
"""Of all meshes together, each counted once; about 10 bytes of the page each."""


@dataclass(frozen=True)
class LinkMesh:
    """A mesh that a link is drawn with."""

    file: str
    links: tuple[str, ...]
    """Links that show it."""
    vertices_mm: NDArray[np.float64]  # (n, 3) in the link's frame
    faces: NDArray[np.int64]  # (m, 3)
    colour: tuple[float, float, float]


def chosen_meshes(urdf: Path) -> list[LinkMesh]:
    """Each mesh once, with all links that it stands for."""
    robot = yourdfpy.URDF.load(str(urdf), load_meshes=False, build_scene_graph=False).robot
    colours = {
        material.name: material.color.rgba[:3] for material in robot.materials if material.color
    }
    links: dict[str, list[str]] = {}
    looks: dict[str, tuple[float, float, float]] = {}
    for link in robot.links:
        for visual in link.visuals:
            if visual.geometry is None or visual.geometry.mesh is None or visual.material is None:
                raise StoreError(f"{urdf}: link {link.name} has a visual without mesh or material")
            file = visual.geometry.mesh.filename
            links.setdefault(file, []).append(link.name)
            looks[file] = tuple(colours[visual.material.name])
    return simplified([_mesh(urdf, file, tuple(links[file]), looks[file]) for file in links])


def simplified(meshes: list[LinkMesh]) -> list[LinkMesh]:
    """The meshes with fewer triangles: coarser where they are too many for a page.

    Surfaces stay within SHOWN_WITHIN_MM, or within twice that, and so on up to COARSEST_MM, until there
    are MAX_TRIANGLES at most. A mesh that encloses no volume stays as it is.
    """
    within = SHOWN_WITHIN_MM
    while True:
        fewer = [_simplified(mesh, within) for mesh in meshes]
        if sum(len(mesh.faces) for mesh in fewer) <= MAX_TRIANGLES or within >= COARSEST_MM:
            return fewer
        within *= 2


def _simplified(mesh: LinkMesh, within_mm: float) -> LinkMesh:
    body = manifold3d.Manifold(
        manifold3d.Mesh(np.asarray(mesh.vertices_mm, np.float32), np.asarray(mesh.faces, np.uint32))
    )
    if body.status() != manifold3d.Error.NoError:
        return mesh
    fewer = body.simplify(within_mm).to_mesh()
    return replace(
        mesh,
        vertices_mm=np.asarray(fewer.vert_properties[:, :3], np.float64),
        faces=np.asarray(fewer.tri_verts, np.int64),
    )


def _mesh(
    urdf: Path, file: str, links: tuple[str, ...], colour: tuple[float, float, float]
) -> LinkMesh:
    mesh = trimesh.load_mesh(urdf.parent / file)
    vertices = mesh.vertices / M_PER_MM
    merged = trimesh.Trimesh(vertices, mesh.faces, process=False)
    merged.merge_vertices(digits_vertex=MERGE_DIGITS_MM)
    return LinkMesh(Path(file).stem, links, merged.vertices, merged.faces, colour)
