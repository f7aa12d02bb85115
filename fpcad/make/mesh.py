"""From solids to meshes that a printer and a simulator can trust."""

from __future__ import annotations

from collections.abc import Iterable

import manifold3d
import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.exchange.stl import export_stl

from fpcad.errors import MakeError
from fpcad.make.parts.solids import Solid
from fpcad.spec.hardware import Print
from fpcad.units import M_PER_MM, RAD_PER_DEG

MERGE_DIGITS = 6
"""Decimals [mm] to which a kernel's copies of one vertex agree."""
INTERFERENCE_MM3 = 1e-3
"""Common volume from which two parts count as interfering; meshes that only touch stay below it."""


def mesh_of(name: str, solid: Solid, settings: Print) -> trimesh.Trimesh:
    """Watertight mesh [mm] of a part; raises :class:`MakeError` with the part's name otherwise."""
    if not solid.isValid() or len(solid.Solids()) != 1:
        bodies = len(solid.Solids())
        raise MakeError(f"part {name}: a valid solid of one body is needed, not {bodies} bodies")
    tolerance, angle = settings.mesh_tolerance_mm, settings.mesh_angle_deg * RAD_PER_DEG
    vertices, faces = solid.tessellate(tolerance, angle)
    mesh = trimesh.Trimesh([v.toTuple() for v in vertices], faces, process=False)
    mesh.merge_vertices(digits_vertex=MERGE_DIGITS)
    mesh.update_faces(mesh.nondegenerate_faces())
    mesh.update_faces(~_folded(mesh))
    mesh.remove_unreferenced_vertices()
    _check(name, mesh)
    return mesh


def _folded(mesh: trimesh.Trimesh) -> NDArray[np.bool_]:
    """Triangles (n,) that lie back to back on another one.

    The kernel's mesher leaves such flaps, which enclose nothing, along seams of thin slivers.
    """
    _, which, counts = np.unique(
        np.sort(mesh.faces, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    return counts[which.ravel()] == 2


def in_metres(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh [mm] scaled to metres."""
    scaled = mesh.copy()
    scaled.apply_scale(M_PER_MM)
    return scaled


def stl_bytes(mesh: trimesh.Trimesh) -> bytes:
    """Binary STL; equal meshes give equal bytes."""
    return bytes(export_stl(mesh))


def common_volume_mm3(a: trimesh.Trimesh, b: trimesh.Trimesh) -> float:
    """Volume [mm^3] that two meshes [mm] share."""
    if np.any(a.bounds[0] > b.bounds[1]) or np.any(b.bounds[0] > a.bounds[1]):
        return 0.0
    return float((_manifold(a) ^ _manifold(b)).volume())


def check_apart(pairs: Iterable[tuple[str, trimesh.Trimesh, str, trimesh.Trimesh]]) -> None:
    """Raise :class:`MakeError` naming the first pair of meshes [mm] that interfere."""
    for name_a, a, name_b, b in pairs:
        volume = common_volume_mm3(a, b)
        if volume > INTERFERENCE_MM3:
            raise MakeError(
                f"parts {name_a} and {name_b} interfere: they share {volume:.3g} mm^3, "
                f"at most {INTERFERENCE_MM3:g} mm^3 is allowed"
            )


def _manifold(mesh: trimesh.Trimesh) -> manifold3d.Manifold:
    body = manifold3d.Manifold(
        manifold3d.Mesh64(
            vert_properties=np.array(mesh.vertices, dtype=np.float64),
            tri_verts=np.array(mesh.faces, dtype=np.uint64),
        )
    )
    if body.status() != manifold3d.Error.NoError:
        raise MakeError(f"a mesh is not a manifold: {body.status().name}")
    return body


def _check(name: str, mesh: trimesh.Trimesh) -> None:
    faults = []
    if not mesh.is_watertight:
        faults.append("is not watertight")
    elif mesh.volume <= 0:
        faults.append(f"has a volume of {mesh.volume:g} mm^3")
    bodies = mesh.body_count
    if bodies != 1:
        faults.append(f"has {bodies} bodies")
    if faults:
        raise MakeError(f"part {name}: its mesh {' and '.join(faults)}")
