"""Sections across a printed part, and the stress in them: straight beams, Euler and Bernoulli."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon
from shapely.ops import unary_union
from trimesh.path import Path2D
from trimesh.path.exchange.misc import lines_to_path

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Section:
    """A plane figure across the x axis of a part, perhaps in several pieces that stay one plane."""

    x: float
    area_mm2: float
    centroid: Array
    """(3,) [mm]."""
    second_mm4: Array
    """(2, 2) integrals of y y, y z, z z about the centroid."""
    corners: Array
    """(n, 2) y, z of its outline from the centroid."""

    def stress_mpa(self, force: Array, moment: Array) -> Array:
        """Largest magnitude (K,) of the normal stress for a force and a moment (K, 3) about the centroid.

        They are what the part beyond (greater x) pulls with. Unsymmetrical bending; shear and torsion
        are left out.
        """
        bending = np.stack([-moment[:, 2], moment[:, 1]], axis=1)  # integrals of stress times y, z
        slope = np.linalg.solve(self.second_mm4, bending.T)  # (2, K)
        return np.abs(force[:, 0] / self.area_mm2 + self.corners @ slope).max(axis=0)


def sections(
    mesh: trimesh.Trimesh, places: Iterable[float], low: Array, high: Array
) -> list[Section]:
    """The figures that planes at x = `places` cut out of a mesh, within a box of y and z.

    `low` and `high` (2,) bound y and z; pieces whose middle lies outside are another beam's.
    Planes that cut nothing there give no section.
    """
    found = []
    for x in places:
        pieces = [
            piece
            for piece in _pieces(mesh, x)
            if np.all(low <= (middle := np.array(piece.centroid.coords[0])))
            and np.all(middle <= high)
        ]
        if pieces:
            found.append(section_of(x, pieces))
    return found


def section_of(x: float, pieces: list[Polygon]) -> Section:
    """One section of all pieces together."""
    area = sum(piece.area for piece in pieces)
    middles = np.array([piece.centroid.coords[0] for piece in pieces])
    middle = np.average(middles, axis=0, weights=[piece.area for piece in pieces])
    moments = sum((_second_moments(piece) for piece in pieces), np.zeros((2, 2)))
    corners = np.vstack([np.array(piece.exterior.coords) for piece in pieces]) - middle
    second = moments - area * np.outer(middle, middle)
    return Section(x, area, np.array([x, *middle]), second, corners)


def _pieces(mesh: trimesh.Trimesh, x: float) -> list[Polygon]:
    """Polygons of y and z, holes taken out."""
    lines = trimesh.intersections.mesh_plane(mesh, (1.0, 0.0, 0.0), (x, 0.0, 0.0))
    if not len(lines):
        return []
    path = Path2D(**lines_to_path(np.asarray(lines)[:, :, 1:]))
    whole = unary_union([polygon.buffer(0) for polygon in path.polygons_full])
    parts = whole.geoms if isinstance(whole, MultiPolygon) else [whole]
    return [part for part in parts if isinstance(part, Polygon) and not part.is_empty]


def _second_moments(piece: Polygon) -> Array:
    """(2, 2) second moments of a polygon about the origin, its holes taken out."""
    whole = _ring(np.array(piece.exterior.coords))
    return whole - sum((_ring(np.array(hole.coords)) for hole in piece.interiors), np.zeros((2, 2)))


def _ring(points: Array) -> Array:
    """The same of a closed ring, whichever way round: Green's theorem, triangle by triangle."""
    a, b = points[:-1], points[1:]
    cross = a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]
    both = a + b
    parts = np.einsum("n,ni,nj->ij", cross, a, a) + np.einsum("n,ni,nj->ij", cross, b, b)
    parts += np.einsum("n,ni,nj->ij", cross, both, both)
    return np.sign(cross.sum()) * parts / 24
