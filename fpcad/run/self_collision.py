"""Whether a motion brings parts of the hand together: capsules of its URDF, at many instants."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.urdf_chain import Capsule, Chain

Array = NDArray[np.float64]

_SAME_POINT_M = 1e-3
_TINY = 1e-15
_THIRDS = 40


@dataclass(frozen=True)
class Meeting:
    """Two solids at their nearest."""

    first: str
    second: str
    gap_m: float
    """Negative where they overlap."""
    row: int
    """Of the postures that were looked at."""


def nearest_meeting(chain: Chain, names: tuple[str, ...], position_rad: Array) -> Meeting | None:
    """The smallest gap among solids that may meet, over postures (M, n); None without such solids.

    Neighbours in a chain touch by design, and so does the solid around a finger's root.
    """
    frames = chain.frames(names, position_rad)
    ends = {
        id(c): tuple(_moved(frames[c.link], p) for p in (c.start_m, c.end_m))
        for c in chain.capsules
    }
    least: Meeting | None = None
    for i, one in enumerate(chain.capsules):
        for other in chain.capsules[i + 1 :]:
            if not _may_meet(chain, one, other):
                continue
            distance = segment_distance(*ends[id(one)], *ends[id(other)])
            gap = distance - one.radius_m - other.radius_m
            row = int(gap.argmin())
            if least is None or gap[row] < least.gap_m:
                least = Meeting(one.link, other.link, float(gap[row]), row)
    for block in chain.blocks:
        for one in chain.capsules:
            if one.link == block.link or _neighbours(chain, one.link, block.link):
                continue
            own: Array = np.linalg.inv(frames[block.link] @ block.T_link).astype(float)
            start, end = (_into(own, p) for p in ends[id(one)])
            gap = box_distance(start, end, block.half_m) - one.radius_m
            row = int(gap.argmin())
            if least is None or gap[row] < least.gap_m:
                least = Meeting(block.link, one.link, float(gap[row]), row)
    return least


def box_distance(start: Array, end: Array, half: Array) -> Array:
    """Distances (M,) between segments, ends (M, 3), and a box of half extents (3,) about the origin.

    The distance to a convex body is convex along a segment: the least is enclosed by thirds.
    """
    low, high = np.zeros(len(start)), np.ones(len(start))

    def at(share: Array) -> Array:
        point = start + share[:, None] * (end - start)
        return np.linalg.norm(np.maximum(np.abs(point) - half, 0.0), axis=1)

    for _ in range(_THIRDS):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        left = at(a) <= at(b)
        low, high = np.where(left, low, a), np.where(left, b, high)
    return at((low + high) / 2)


def _into(T: Array, points: Array) -> Array:
    """Points (M, 3) by poses (M, 4, 4)."""
    return np.einsum("mij,mj->mi", T[:, :3, :3], points) + T[:, :3, 3]


def segment_distance(p1: Array, q1: Array, p2: Array, q2: Array) -> Array:
    """Distances (M,) between segments p1-q1 and p2-q2, ends (M, 3) each.

    Ericson, Real-Time Collision Detection (2005), 5.1.9.
    """
    d1, d2, r = q1 - p1, q2 - p2, p1 - p2
    a, e = _dot(d1, d1) + _TINY, _dot(d2, d2) + _TINY
    b, c, f = _dot(d1, d2), _dot(d1, r), _dot(d2, r)
    across = a * e - b * b
    s = np.where(across > 1e-9 * a * e, (b * f - c * e) / np.maximum(across, _TINY), 0.0)
    s = np.clip(s, 0.0, 1.0)
    t = np.clip((b * s + f) / e, 0.0, 1.0)
    s = np.clip((b * t - c) / a, 0.0, 1.0)
    return np.linalg.norm(r + s[:, None] * d1 - t[:, None] * d2, axis=1)


def _may_meet(chain: Chain, one: Capsule, other: Capsule) -> bool:
    if one.link == other.link or _neighbours(chain, one.link, other.link):
        return False
    for base, tip in ((one, other), (other, one)):
        path = chain.above(tip.link)
        if path and base.link == chain.root:
            root = path[0].T_parent[:3, 3]  # where the finger begins, in the root link
            if np.linalg.norm((base.start_m + base.end_m) / 2 - root) < _SAME_POINT_M:
                return False
    return True


def _neighbours(chain: Chain, one: str, other: str) -> bool:
    """Whether no link with a solid lies between two links of one chain."""
    solid = {capsule.link for capsule in chain.capsules}
    for base, tip in ((one, other), (other, one)):
        above = [joint.parent for joint in reversed(chain.above(tip)) if joint.parent in solid]
        if above and above[0] == base:
            return True
    return False


def _moved(frames: Array, point: Array) -> Array:
    return frames[:, :3, :3] @ point + frames[:, :3, 3]


def _dot(x: Array, y: Array) -> Array:
    return np.einsum("ij,ij->i", x, y)
