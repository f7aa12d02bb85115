"""The chosen hand's meshes, as its URDF names them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
import yourdfpy
from numpy.typing import NDArray

from fpcad.errors import StoreError
from fpcad.units import M_PER_MM

MERGE_DIGITS_MM = 3


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
    return [_mesh(urdf, file, tuple(links[file]), looks[file]) for file in links]


def _mesh(
    urdf: Path, file: str, links: tuple[str, ...], colour: tuple[float, float, float]
) -> LinkMesh:
    mesh = trimesh.load_mesh(urdf.parent / file)
    vertices = mesh.vertices / M_PER_MM
    merged = trimesh.Trimesh(vertices, mesh.faces, process=False)
    merged.merge_vertices(digits_vertex=MERGE_DIGITS_MM)
    return LinkMesh(Path(file).stem, links, merged.vertices, merged.faces, colour)
