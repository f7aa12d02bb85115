"""Smooth curves that tubes follow: cubic Hermite curves, how sharply they bend, and a tube swept along one."""

from __future__ import annotations

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.parts.part import Array

SAMPLES = 49
"""Points that stand for a curve; on a quarter turn of 30 mm the polyline is 0.02 mm off."""
SIDES = 10


def hermite(start: Array, end: Array, rate_start: Array, rate_end: Array) -> tuple[Array, Array]:
    """Points and curvatures of cubic Hermite curves at SAMPLES equal steps of their parameter.

    Args:
        start: (..., 3) where they begin [mm]; `end` where they end.
        rate_start: (..., 3) derivative there by the parameter, which runs from 0 to 1 [mm].

    Returns:
        (..., SAMPLES, 3) [mm] and (..., SAMPLES) [1/mm].
    """
    s = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    p0, p1, v0, v1 = (np.asarray(a)[..., None, :] for a in (start, end, rate_start, rate_end))
    c2, c3 = 3 * (p1 - p0) - 2 * v0 - v1, v0 + v1 - 2 * (p1 - p0)
    points = p0 + v0 * s + c2 * s**2 + c3 * s**3
    rate, bend = v0 + 2 * c2 * s + 3 * c3 * s**2, 2 * c2 + 6 * c3 * s
    speed = np.linalg.norm(rate, axis=-1)
    return points, np.linalg.norm(np.cross(rate, bend), axis=-1) / speed**3


def length_of(points: Array) -> Array:
    """Lengths (...) [mm] of polylines (..., n, 3)."""
    return np.linalg.norm(np.diff(points, axis=-2), axis=-1).sum(axis=-1)


def swept(points: Array, radius: float) -> trimesh.Trimesh:
    """A closed rod of a radius [mm] along a polyline (n, 3) [mm] without sharp corners."""
    ahead = np.gradient(points, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    across = np.empty_like(points)
    across[0] = np.cross(ahead[0], np.eye(3)[int(np.argmin(np.abs(ahead[0])))])
    for i in range(1, len(points)):  # carried along without twist
        across[i] = across[i - 1] - (across[i - 1] @ ahead[i]) * ahead[i]
        across[i] /= np.linalg.norm(across[i])
    across[0] /= np.linalg.norm(across[0])
    turns = 2 * np.pi * np.arange(SIDES) / SIDES
    ring = (
        np.cos(turns)[:, None] * across[:, None]
        + np.sin(turns)[:, None] * np.cross(ahead, across)[:, None]
    )
    vertices = np.vstack([(points[:, None] + radius * ring).reshape(-1, 3), points[[0, -1]]])
    return trimesh.Trimesh(vertices, _faces(len(points)), process=False)


def _faces(rings: int) -> NDArray[np.int_]:
    """Triangles of a rod of so many rings, with a fan at each end."""
    side = np.arange(SIDES)
    ahead = np.roll(side, -1)
    first, last = rings * SIDES, (rings - 1) * SIDES
    faces = [np.stack([np.full(SIDES, first), ahead, side], axis=1)]
    for base in range(0, last, SIDES):
        a, b, c, d = base + side, base + ahead, base + SIDES + side, base + SIDES + ahead
        faces += [np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)]
    faces.append(np.stack([np.full(SIDES, first + 1), last + side, last + ahead], axis=1))
    return np.vstack(faces)
