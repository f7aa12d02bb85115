"""Two supports that share a force and a moment, in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

X, Y, Z = 0, 1, 2


def on_axis(force: Array, moment: Array, axis: int, places: tuple[float, float]) -> Array:
    """Forces (K, 2, 3) of two supports on an axis that together give force and moment (K, 3).

    The supports sit at `places` [mm] along the axis through the moments' point; they push across it
    alone. The moment about the axis and the force along it are not theirs.
    """
    a, b = (axis + 1) % 3, (axis + 2) % 3
    low, high = places
    found = np.zeros((len(force), 2, 3))
    # A force F at p along the axis turns by p F_a about b and by -p F_b about a.
    for across, turned in ((a, moment[:, b]), (b, -moment[:, a])):
        found[:, 1, across] = (turned - low * force[:, across]) / (high - low)
        found[:, 0, across] = force[:, across] - found[:, 1, across]
    return found


def beam_moment(places: Array, forces: Array) -> Array:
    """Largest bending moment (K,) of a straight beam with forces (K, n, 3) across it at places (n,).

    Supports are among the forces, so that all are in balance.
    """
    order = np.argsort(places, kind="stable")
    at, across = places[order], forces[:, order]
    shear = np.cumsum(across, axis=1)[:, :-1]
    moments = np.cumsum(shear * np.diff(at)[None, :, None], axis=1)
    return np.linalg.norm(moments, axis=2).max(axis=1)
