"""How a part lies on the printer's bed, and how much of it then hangs over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.parts.part import Part
from fpcad.spec.hardware import Print

Array = NDArray[np.float64]

LAYER_MM = 0.3
"""What begins this low needs no support."""
FLAT = 0.999
HULL_FACES = 12
"""Of the convex hull's flat sides, so many of the largest are tried as bases."""
TIPPING_BASE_MM2 = 10.0
TIPPING_COST = 20.0
"""What stands on less than that tips: then a millimetre of height costs so many mm^2 of overhang."""
SMALL_BASE_COST = 5.0
"""What a square millimetre that the base lacks costs, in square millimetres of overhang."""


@dataclass(frozen=True)
class Orientation:
    """A way to lay a part on the bed."""

    T_bed_part: Array
    """(4, 4) pose [mm]: the part stands on z = 0, its middle above the origin."""
    overhang_mm2: float
    """Area of the faces that need support."""
    base_mm2: float
    """Area that lies on the bed."""
    height_mm: float
    overhang_at_mm: Array
    """(3,) centre of the largest face that needs support, in the part's frame."""


def part_orientation(part: Part, settings: Print) -> Orientation:
    """The orientation that a part proposes, or the best one where it proposes none."""
    R = part.T_bed_part[:3, :3]
    if np.allclose(R, np.eye(3)):
        return best_orientation(part.mesh, settings.overhang_deg)
    return _orientation(part.mesh, R[2], settings.overhang_deg)


def best_orientation(mesh: trimesh.Trimesh, overhang_deg: float) -> Orientation:
    """The orientation of a part [mm] with the least overhang and a base to stand on.

    Args:
        overhang_deg: largest angle from the vertical at which a face needs no support.
    """
    want = min(100.0, 0.05 * mesh.area)
    tried = [_orientation(mesh, up, overhang_deg) for up in _ups(mesh)]

    def cost(o: Orientation) -> tuple[float, float]:
        lacking = max(want - o.base_mm2, 0.0)
        tipping = TIPPING_COST * o.height_mm if o.base_mm2 < TIPPING_BASE_MM2 else 0.0
        sum_mm2 = o.overhang_mm2 + SMALL_BASE_COST * lacking + tipping
        return round(sum_mm2, 3), round(o.height_mm, 3)

    return min(tried, key=cost)


def _ups(mesh: trimesh.Trimesh) -> list[Array]:
    """Unit vectors that may point up: the axes, and what stands on the hull's largest sides."""
    axes = [sign * np.eye(3)[i] for i in (2, 0, 1) for sign in (1.0, -1.0)]
    hull = mesh.convex_hull
    areas, normals = np.asarray(hull.facets_area), np.asarray(hull.facets_normal)
    largest = np.argsort(-areas, kind="stable")[:HULL_FACES] if len(areas) else []
    return axes + [-normals[i] for i in largest]


def _orientation(mesh: trimesh.Trimesh, up: Array, overhang_deg: float) -> Orientation:
    steepness = mesh.face_normals @ up
    height = mesh.vertices @ up
    bottom = float(height.min())
    face_low = height[mesh.faces].min(axis=1) - bottom
    steep = -np.sin(np.deg2rad(overhang_deg))
    hanging = (steepness < steep - 1e-6) & (face_low > LAYER_MM)
    base = (steepness < -FLAT) & (height[mesh.faces].max(axis=1) - bottom < LAYER_MM)
    areas = mesh.area_faces
    worst = int(np.argmax(np.where(hanging, areas, 0.0)))
    return Orientation(
        T_bed_part=_standing(mesh, up),
        overhang_mm2=float(areas[hanging].sum()),
        base_mm2=float(areas[base].sum()),
        height_mm=float(height.max() - bottom),
        overhang_at_mm=np.asarray(mesh.triangles_center[worst]),
    )


def _standing(mesh: trimesh.Trimesh, up: Array) -> Array:
    pose = np.eye(4)
    helper = np.eye(3)[int(np.argmin(np.abs(up)))]
    x_axis = np.cross(helper, up)
    x_axis /= np.linalg.norm(x_axis)
    pose[:3, :3] = np.array([x_axis, np.cross(up, x_axis), up])
    turned = mesh.vertices @ pose[:3, :3].T
    low, high = turned.min(axis=0), turned.max(axis=0)
    pose[:3, 3] = [-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, -low[2]]
    return pose
