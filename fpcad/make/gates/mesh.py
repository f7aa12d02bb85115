"""Gate: the mesh is a closed 2-manifold of one body that encloses a volume."""

from __future__ import annotations

import numpy as np
import trimesh

from fpcad.make.gates.finding import Finding, Severity, point

GATE = "mesh"


def check_mesh(part: str, mesh: trimesh.Trimesh) -> list[Finding]:
    """Findings about a mesh [mm]; the location is an edge or a body that should not be there."""
    open_edges = _edges_without_two_faces(mesh)
    if len(open_edges):
        where = point(mesh.vertices[open_edges[0]].mean(axis=0))
        text = f"its mesh is not closed: {len(open_edges)} edges without exactly two faces"
        count = float(len(open_edges))
        return [Finding(GATE, Severity.ERROR, part, count, 0, "edges", text, where)]
    if not mesh.is_winding_consistent or mesh.volume <= 0:
        text = f"its mesh's faces do not look outwards: a volume of {mesh.volume:.3g} mm^3"
        where = point(mesh.bounds.mean(axis=0))
        return [Finding(GATE, Severity.ERROR, part, float(mesh.volume), 0, "mm^3", text, where)]
    bodies = mesh.split(only_watertight=False)
    if len(bodies) != 1:
        smallest = min(bodies, key=lambda body: abs(body.volume))
        where, text = point(smallest.centroid), f"its mesh has {len(bodies)} bodies instead of one"
        return [Finding(GATE, Severity.ERROR, part, len(bodies), 1, "bodies", text, where)]
    return []


def _edges_without_two_faces(mesh: trimesh.Trimesh) -> np.ndarray:
    """Edges (n, 2), as vertex numbers, that belong to fewer or more than two triangles."""
    edges, counts = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
    return edges[counts != 2]
