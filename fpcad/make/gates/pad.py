"""Figure: how much of the palm's bars a skin covers, seen from where the tool is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fpcad.make.gates.finding import Finding, Severity
from fpcad.make.parts.part import FIXED_LINK, Part
from fpcad.model.geometry import HandGeometry

Array = NDArray[np.float64]

GATE = "pad"
USUAL_SHARE = 0.5
"""Below this a person is told with a warning."""
SPACING_MM = 0.5


def check_pad(parts: Sequence[Part], geometry: HandGeometry) -> list[Finding]:
    """Share of the bars' palmar face that is skin, outside of the fingers' primitives."""
    points = bar_plan(geometry)
    if not len(points):
        return []
    share = skin_share(parts, points)
    severity = Severity.FIGURE if share >= USUAL_SHARE else Severity.WARNING
    text = f"skin covers {100 * share:.0f} % of the palmar face of the palm's bars"
    if share == 0.0:
        text += "; between the fingers' roots and the flange's inserts there is no room for a pad"
    return [Finding(GATE, severity, FIXED_LINK, share, USUAL_SHARE, "-", text)]


def bar_plan(geometry: HandGeometry) -> Array:
    """Points (n, 2) [mm] of H's plane within the bars and outside of the fingers' primitives."""
    bars = [shape for shape in geometry.palm if shape.finger is None]
    if not bars:
        return np.empty((0, 2))
    ends = np.array([(s.start_mm[:2], s.end_mm[:2]) for s in bars])
    low, high = ends.min(axis=(0, 1)), ends.max(axis=(0, 1))
    steps = [
        np.arange(a, b + SPACING_MM, SPACING_MM) for a, b in zip(low - 30, high + 30, strict=True)
    ]
    grid = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 2)
    inside = np.zeros(len(grid), dtype=bool)
    for shape in sorted(geometry.palm, key=lambda shape: shape.finger is not None):
        near = _plan_distance(grid, shape.start_mm[:2], shape.end_mm[:2]) < shape.radius_mm
        inside = inside | near if shape.finger is None else inside & ~near
    return grid[inside]


def skin_share(parts: Sequence[Part], points: Array) -> float:
    """Of the points (n, 2), the share above which something palmar lies and the first of it is skin."""
    skin, rigid = (np.full(len(points), np.inf) for _ in range(2))
    for part in parts:
        if part.link != FIXED_LINK:
            continue
        mesh = part.on_link
        low = float(mesh.bounds[0, 2]) - 1.0
        starts = np.column_stack([points, np.full(len(points), low)])
        up = np.tile([0.0, 0.0, 1.0], (len(points), 1))
        hits, ray, _ = mesh.ray.intersects_location(starts, up, multiple_hits=False)
        height = skin if part.material == "skin" else rigid
        height[ray] = np.minimum(height[ray], hits[:, 2])
    seen = np.isfinite(skin) | np.isfinite(rigid)
    return float((skin < rigid)[seen].mean()) if seen.any() else 0.0


def _plan_distance(points: Array, start: Array, end: Array) -> Array:
    along = end - start
    square = float(along @ along)
    t = np.clip((points - start) @ along / square, 0, 1) if square else np.zeros(len(points))
    return np.linalg.norm(points - start - np.outer(t, along), axis=1)
