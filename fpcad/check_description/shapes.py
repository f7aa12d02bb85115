"""Shapes of links as meshes in the link's frame [m]."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Shape:
    """A mesh or a primitive."""

    kind: str
    """`mesh`, `box`, `cylinder`, `capsule` or `sphere`."""
    pose: Array  # (4, 4) in the link [m]
    size: tuple[float, ...]
    """Scale of a mesh, edges of a box, radius and length, or radius [m]."""
    file: Path | None = None

    @cached_property
    def mesh(self) -> trimesh.Trimesh:
        """The surface in the link's frame; of a missing or unknown file, ValueError says so."""
        return self._own().apply_transform(self.pose)

    def contains(self, points: Array, slack: float) -> NDArray[np.bool_]:
        """Which points (n, 3) lie inside, or at most `slack` [m] outside."""
        local = (points - self.pose[:3, 3]) @ self.pose[:3, :3]
        if self.kind == "sphere":
            return np.linalg.norm(local, axis=1) <= self.size[0] + slack
        if self.kind == "box":
            return np.all(np.abs(local) <= np.array(self.size) / 2 + slack, axis=1)
        if self.kind == "mesh":
            return outside_hull(self.mesh.convex_hull, points) <= slack
        radius, length = self.size
        beyond = np.abs(local[:, 2]) - length / 2
        if self.kind == "cylinder":
            return (np.linalg.norm(local[:, :2], axis=1) <= radius + slack) & (beyond <= slack)
        across = np.column_stack([local[:, :2], np.maximum(beyond, 0.0)])
        return np.linalg.norm(across, axis=1) <= radius + slack

    def _own(self) -> trimesh.Trimesh:
        if self.kind == "box":
            return trimesh.creation.box(self.size)
        if self.kind == "sphere":
            return trimesh.creation.icosphere(3, self.size[0])
        if self.kind == "cylinder":
            return trimesh.creation.cylinder(self.size[0], self.size[1])
        if self.kind == "capsule":
            centred = trimesh.creation.capsule(self.size[1], self.size[0])
            return centred.apply_translation(-centred.bounds.mean(axis=0))
        return _load(self.file).apply_scale(self.size)


def hull_of(shapes: Iterable[Shape]) -> trimesh.Trimesh:
    """Convex hull of several shapes."""
    points = np.vstack([shape.mesh.vertices for shape in shapes])
    return trimesh.convex.convex_hull(points)


def outside_hull(hull: trimesh.Trimesh, points: Array) -> Array:
    """How far (n,) [m] points (n, 3) lie beyond the farthest of a hull's faces; negative inside."""
    origins, normals = hull.triangles_center, hull.face_normals
    heights = np.einsum("pfi,fi->pf", points[:, None] - origins[None], normals)
    return np.asarray(heights.max(axis=1))


def _load(file: Path | None) -> trimesh.Trimesh:
    if file is None or not file.is_file():
        raise ValueError(f"there is no mesh {file}")
    try:
        loaded: Any = trimesh.load(file, force="mesh")
    except Exception as error:  # each format's reader has errors of its own; all are told
        raise ValueError(f"{file.name} cannot be read: {error}") from error
    return loaded
