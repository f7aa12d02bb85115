"""Distances that two bodies surely keep, for many postures at once: most pairs need no more."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.make.gates.bodies import SPREAD_MM, Body
from fpcad.make.grip import segment_distance

Array = NDArray[np.float64]

AXIS_SPACING_MM = 2.0
TOLD_BOUND_MM = 2.5
"""Bounds beyond this are told as this."""


def least_distance(a: Body, T_a: Array, b: Body, T_b: Array) -> Array:
    """Lower bound (N,) [mm] of the distance of two bodies at poses (N, 4, 4); may be negative."""
    ends_a, ends_b = _moved(a.axis, T_a), _moved(b.axis, T_b)
    apart = segment_distance(ends_a[:, 0], ends_a[:, 1], ends_b[:, 0], ends_b[:, 1])
    bound = apart - a.radius - b.radius
    near = np.flatnonzero(bound <= 0)
    if a.still and len(near):
        bound[near] = np.maximum(bound[near], surface_distance(a, b, T_b[near]))
    return bound


def swept_box(body: Body, T: Array) -> Array:
    """(2, 3) box [mm] in H that holds a body at all of the poses (N, 4, 4)."""
    if body.still:
        return body.box
    ends = _moved(body.axis, T).reshape(-1, 3)
    return np.stack([ends.min(axis=0) - body.radius, ends.max(axis=0) + body.radius])


def box_gap(a: Array, b: Array) -> float:
    """Lower bound [mm] of the distance of what two boxes (2, 3) hold; negative where they overlap."""
    return float(np.max([b[0] - a[1], a[0] - b[1]]))


def surface_distance(still: Body, b: Body, T_b: Array) -> Array:
    """Lower bound (N,) [mm] of the distance to a body that stands still at the origin.

    A body deep inside of it counts as apart; it has met the surface before.
    """
    length = float(np.linalg.norm(b.axis[1] - b.axis[0]))
    along = np.linspace(b.axis[0], b.axis[1], 2 + int(length / AXIS_SPACING_MM))
    reach = b.radius + SPREAD_MM + length / (len(along) - 1) / 2
    nearest, _ = still.surface.query(
        _moved(along, T_b).reshape(-1, 3), distance_upper_bound=reach + TOLD_BOUND_MM
    )
    gap = nearest.reshape(len(T_b), -1).min(axis=1)
    return np.minimum(gap, reach + TOLD_BOUND_MM) - reach


def _moved(points: Array, poses: Array) -> Array:
    """Points (n, 3) at each of the poses (N, 4, 4): (N, n, 3)."""
    return np.einsum("nij,kj->nki", poses[:, :3, :3], points) + poses[:, None, :3, 3]
