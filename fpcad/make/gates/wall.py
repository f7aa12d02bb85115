"""Gate: no wall is thinner than the printer can make it."""

from __future__ import annotations

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import KDTree
from trimesh.sample import sample_surface

from fpcad.make.gates.finding import Finding, Severity, point

Array = NDArray[np.float64]

GATE = "wall"
SAMPLES_PER_MM2 = 2.0
MOST_SAMPLES = 20_000
SEED = 1
OPPOSED = -0.9
"""Product of normals beyond which two faces are the two sides of a wall, not an edge's: 26 deg."""
THIN_AREA_MM2 = 1.0
"""A patch that is thin over less than this, such as the lip of a hole, is no wall."""
PATCH_MM = 1.5
"""Thin samples nearer to each other than this belong to one patch."""
START_MM = 1e-3
"""Rays start this far below the surface, or they would meet the face that they come from."""


def check_walls(part: str, mesh: trimesh.Trimesh, least_mm: float) -> list[Finding]:
    """The thinnest wall of a mesh [mm] against the least that its material allows.

    Rays go from points spread over the surface straight inwards to the opposite face. A single ray
    may slip along an edge, so a wall counts as thin where a patch of a given area is.
    """
    points, thickness, area_each = wall_thickness(mesh)
    if not len(points):
        return [Finding(GATE, Severity.FIGURE, part, np.inf, least_mm, "mm", "no walls")]
    thin = np.flatnonzero(thickness < least_mm)
    patch = _largest_patch(points[thin])
    if len(patch) * area_each > THIN_AREA_MM2:
        own = thin[patch]
        worst = own[np.argmin(thickness[own])]
        value = float(np.median(thickness[own]))
        text = (
            f"a wall of {value:.2f} mm over {len(patch) * area_each:.1f} mm^2, "
            f"at least {least_mm:g} mm is needed"
        )
        where = point(points[worst])
        return [Finding(GATE, Severity.ERROR, part, value, least_mm, "mm", text, where)]
    share = THIN_AREA_MM2 / (area_each * len(points))
    least = float(np.quantile(thickness, min(share, 1.0)))
    where = point(points[np.argmin(np.abs(thickness - least))])
    text = f"walls from {least:.2f} mm on"
    return [Finding(GATE, Severity.FIGURE, part, least, least_mm, "mm", text, where)]


def wall_thickness(mesh: trimesh.Trimesh) -> tuple[Array, Array, float]:
    """Points (n, 3) on walls, the wall's thickness (n,) there [mm], and the area of each [mm^2]."""
    count = int(np.clip(mesh.area * SAMPLES_PER_MM2, 200, MOST_SAMPLES))
    points, faces = sample_surface(mesh, count, seed=SEED)[:2]
    normals = mesh.face_normals[faces]
    rays = points - START_MM * normals
    hits, ray, hit_faces = mesh.ray.intersects_location(rays, -normals, multiple_hits=False)
    opposed = np.einsum("ij,ij->i", mesh.face_normals[hit_faces], normals[ray]) < OPPOSED
    hits, ray = hits[opposed], ray[opposed]
    thickness = np.linalg.norm(hits - points[ray], axis=1)
    return np.asarray(points[ray]), thickness, mesh.area / count


def _largest_patch(points: Array) -> NDArray[np.int64]:
    """Numbers of the points (n, 3) of the largest cluster."""
    if not len(points):
        return np.empty(0, dtype=np.int64)
    pairs = KDTree(points).query_pairs(PATCH_MM, output_type="ndarray")
    groups = trimesh.graph.connected_component_labels(pairs, node_count=len(points))
    return np.flatnonzero(groups == np.bincount(groups).argmax())
