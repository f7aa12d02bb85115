"""Two bodies over many postures: the closest approach, or the first posture at which they overlap."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.make.gates.bodies import Body
from fpcad.make.gates.bounds import least_distance
from fpcad.make.gates.meeting import Overlap, meet, nearby

Array = NDArray[np.float64]


class Approach(NamedTuple):
    """How near two bodies come."""

    gap_mm: float
    """The least distance, or what was asked for where they keep more than that."""
    overlap: Overlap | None
    posture: int
    """The one at which they overlap; -1 where they do not."""


def closest_approach(a: Body, T_a: Array, b: Body, T_b: Array, within_mm: float) -> Approach:
    """The least distance up to `within_mm` at poses (N, 4, 4), or the first overlap that is found.

    Postures whose lower bound is no less than the least distance so far are passed over.
    """
    gap = within_mm
    bound = least_distance(a, T_a, b, T_b)
    near = np.flatnonzero(bound < gap)
    close = nearby(a, b, T_b[near], gap)
    for k in near:
        if bound[k] >= gap:
            continue
        gap, overlap = meet(close, T_a[k], b, T_b[k], gap)
        if overlap is not None:
            return Approach(0.0, overlap, int(k))
    return Approach(gap, None, -1)
