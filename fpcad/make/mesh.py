"""From solids to meshes that a printer and a simulator can trust."""

from __future__ import annotations

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
STEADY_DIGITS = 9
"""Decimals [mm] that are the same whenever a part is made."""
VOLUME_LOSS = 2.5e-3
"""Share of a part's volume that its mesh may lose; its inertia then is right within half a percent."""
MOST_HALVINGS = 6
INTERFERENCE_MM3 = 1e-3
"""Common volume from which two parts count as interfering; meshes that only touch stay below it."""


def mesh_of(name: str, solid: Solid, settings: Print) -> trimesh.Trimesh:
    """Watertight mesh [mm] of a part; raises :class:`MakeError` with the part's name otherwise.

    Where the spec's tolerance loses more than VOLUME_LOSS, as on large spheres, it is halved.
    """
    bodies = len(solid.Solids())
    if bodies != 1:
        raise MakeError(f"part {name}: a solid of one body is needed, not of {bodies} bodies")
    if not solid.isValid():
        raise MakeError(f"part {name}: the CAD kernel calls its solid not valid")
    tolerance, angle = settings.mesh_tolerance_mm, settings.mesh_angle_deg * RAD_PER_DEG
    volume = solid.Volume()
    for _ in range(MOST_HALVINGS):
        mesh = _tessellated(name, solid, tolerance, angle)
        if abs(mesh.volume - volume) <= VOLUME_LOSS * volume:
            return mesh
        tolerance, angle = tolerance / 2, angle / 2
    raise MakeError(f"part {name}: its mesh has {mesh.volume:g} mm^3, its solid {volume:g} mm^3")


def _tessellated(name: str, solid: Solid, tolerance: float, angle: float) -> trimesh.Trimesh:
    vertices, faces = solid.tessellate(tolerance, angle)
    mesh = trimesh.Trimesh([v.toTuple() for v in vertices], faces, process=False)
    mesh.merge_vertices(digits_vertex=MERGE_DIGITS)
    # The kernel's last bits differ from run to run.
    mesh.vertices = np.round(mesh.vertices, STEADY_DIGITS) + 0.0
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


def manifold_of(mesh: trimesh.Trimesh) -> manifold3d.Manifold:
    """A mesh [mm] for exact booleans; :class:`MakeError` where it is not closed."""
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
